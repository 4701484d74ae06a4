"""Gate courses for tests: a row of poles as a course setter would set it, and changes of one gate."""

from __future__ import annotations

from typing import Any

import numpy as np

from ski_addon.course.fair_line import Poles
from ski_addon.spec import RunSpec

EVEN = [(15.0, 1.0), (25.0, -1.0), (35.0, 1.0), (45.0, -1.0), (55.0, 1.0), (65.0, -1.0)]
"""A slalom: right, left, right, ..."""


def listed(places: list[tuple] = EVEN, changes: dict[int, dict[str, Any]] | None = None, **course: Any) -> RunSpec:
    """A run past gates at `places`, with some keys of single gates (by index) changed."""
    rows = [{"x": x, "y": y, **(changes or {}).get(k, {})} for k, (x, y) in enumerate(places)]
    content = {"slope": {"angle_deg": 15}, "gate": rows}
    return RunSpec.from_dict({**content, "course": {"kind": "gates", "gate_setting": "list", **course}})


def generated(**course: Any) -> RunSpec:
    """A run past gates that are set by the course's keys."""
    return RunSpec.from_dict({"slope": {"angle_deg": 15}, "course": {"kind": "gates", **course}})


def even_poles(count: int = 8, spacing: float = 10.0, offset: float = 2.0, radius: float = np.nan) -> Poles:
    """Poles of an even course: first turn left."""
    side = (-1.0) ** np.arange(count)
    down = spacing * (1.5 + np.arange(count))
    return Poles(down, -0.5 * offset * side, side, np.full(count, 0.5), np.full(count, radius))


def pole_gaps(down: np.ndarray, left: np.ndarray, poles: Poles) -> np.ndarray:
    """Smallest distance [m] from each pole to a finely sampled line."""
    return np.array([np.min(np.hypot(down - x, left - y)) for x, y in zip(poles.down, poles.left, strict=True)])
