"""Ski Addon: ski animation from physics.

An animator describes a run (`RunSpec`), the library plans it, simulates a skier of 37 degrees of freedom on carving
skis, and bakes the motion to keyframes in Blender. Nothing here imports Blender, MuJoCo or SciPy before it is used.
"""

from __future__ import annotations

import importlib
from typing import Any

__version__ = "0.1.0"

_PUBLIC = {
    "load_run": "api",
    "simulate": "api",
    "summarise": "api",
    "bake": "api",
    "run_sweep": "api",
    "run_crowd": "api",
    "RunSpec": "spec",
    "SpecError": "errors",
    "SkiAddonError": "errors",
    "PlanInfeasible": "errors",
    "SkierFell": "errors",
    "make_plan": "pipeline",
    "run_simulation": "pipeline",
    "Recording": "simulation",
}

__all__ = ["__version__", *_PUBLIC]  # noqa: PLE0604 - names are strings of a table


def __getattr__(name: str) -> Any:
    if name not in _PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(importlib.import_module(f".{_PUBLIC[name]}", __name__), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *_PUBLIC])
