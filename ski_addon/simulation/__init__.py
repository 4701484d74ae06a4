"""Simulation: stepping, fall detection, recording and its summary."""

from .diagnostics import summarise
from .falls import Fall
from .pushes import check_pushes
from .recording import Recording
from .simulation import Progress, Simulation, simulate

__all__ = ["Fall", "Progress", "Recording", "Simulation", "check_pushes", "simulate", "summarise"]
