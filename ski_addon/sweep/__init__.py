"""Sweeps: one run simulated for every combination of some values."""

from .combinations import Combination, combine, read_variations
from .running import run_sweep
from .summary import sweep_lines

__all__ = ["Combination", "combine", "read_variations", "run_sweep", "sweep_lines"]
