"""What a rhythm is where its rows do not say so."""

from __future__ import annotations

from collections.abc import Sequence

from .rows import RhythmSpec
from .sections import CourseSpec

PERIOD, SHARPNESS_DEG, HEADING_DEG = 2.5, 20.0, 0.0
"""A swing [s], its greatest lean and its heading [degrees] if no row has one."""
LEAST_SWINGS = 4.0
"""A rhythm whose duration is not told lasts at least so many swings."""


def rhythm_keys(rows: Sequence[RhythmSpec], name: str, usual: float) -> tuple[list[float], list[float]]:
    """Return the times [s] at which the rows set `name`, and the values they set; one usual value if none does."""
    keys = [(row.time, float(getattr(row, name))) for row in rows if not isinstance(getattr(row, name), str)]
    if not keys:
        return [0.0], [usual]
    return [time for time, _ in keys], [value for _, value in keys]


def rhythm_duration(course: CourseSpec, rows: Sequence[RhythmSpec]) -> float:
    """Return how long a rhythm goes on [s]: as told, or a swing past its last row."""
    if not isinstance(course.rhythm_duration, str):
        return course.rhythm_duration
    _, periods = rhythm_keys(rows, "period", PERIOD)
    last = max((row.time for row in rows), default=0.0)
    return max(last + periods[-1], LEAST_SWINGS * periods[0])
