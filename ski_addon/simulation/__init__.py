"""Simulation: stepping, fall detection, recording and its summary."""

from .diagnostics import summarise
from .falls import Fall
from .recording import Recording
from .simulation import Progress, Simulation, simulate

__all__ = ["Fall", "Progress", "Recording", "Simulation", "simulate", "summarise"]
