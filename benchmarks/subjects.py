"""The subjects that are measured, and measuring them one after the other.

A subject is a module with `measurements(how: How) -> list[Measurement]`, which raises `NotMeasuredError` where
something that it needs is missing.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Iterable

from benchmarks.measuring import How, Measurement, NotMeasuredError

SUBJECTS = {
    "step": "benchmarks.step_rounds",
    "plan": "benchmarks.plan",
    "preview": "benchmarks.preview",
    "drag": "benchmarks.drag",
    "path": "benchmarks.path_search",
    "resample": "benchmarks.resample",
    "bake": "benchmarks.blender",
    "files": "benchmarks.files",
    "crowd": "benchmarks.crowd",
}
"""Name on the command line, and module."""


def chosen(names: str | None) -> list[str]:
    """Return the subjects in a text of names between commas, or all; raises `ValueError` for an unknown one."""
    if not names:
        return list(SUBJECTS)
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    for name in wanted:
        if name not in SUBJECTS:
            raise ValueError(f"there is no subject {name!r}; there are {', '.join(SUBJECTS)}")
    return [name for name in SUBJECTS if name in wanted]


def measure(names: Iterable[str], how: How) -> list[Measurement]:
    """Return the rows of the subjects; those that cannot be measured here leave a note."""
    rows: list[Measurement] = []
    for name in names:
        print(f"measuring: {name}", file=sys.stderr, flush=True)
        try:
            rows += subject(name, how)
        except NotMeasuredError as problem:
            how.notes.append(f"{name} was not measured: {problem}")
    return rows


def subject(name: str, how: How) -> list[Measurement]:
    """Return the rows of one subject; raises `NotMeasuredError`."""
    return importlib.import_module(SUBJECTS[name]).measurements(how)
