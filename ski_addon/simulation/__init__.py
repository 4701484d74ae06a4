"""Simulation: stepping, fall detection, recording and its summary."""

from .checkpoint import Checkpoints
from .clearance import GatePassing, gate_summary, recorded_gates
from .diagnostics import summarise
from .falls import Fall
from .pushes import check_pushes
from .recording import Recording
from .resuming import resume
from .simulation import Progress, Simulation, simulate

__all__ = [
    "Checkpoints",
    "Fall",
    "GatePassing",
    "Progress",
    "Recording",
    "Simulation",
    "check_pushes",
    "gate_summary",
    "recorded_gates",
    "resume",
    "simulate",
    "summarise",
]
