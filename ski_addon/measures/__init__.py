"""Motion measures: numbers that say how a skier moved."""

from .measures import measure_motion

__all__ = ["measure_motion"]
