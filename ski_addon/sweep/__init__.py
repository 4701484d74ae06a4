"""Sweeps: one run simulated for every combination of some values."""

from .combinations import Combination, read_variations
from .running import run_sweep
from .summary import sweep_lines

__all__ = ["Combination", "read_variations", "run_sweep", "sweep_lines"]
