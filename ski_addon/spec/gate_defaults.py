"""What `auto` stands for in gate courses: numbers a course setter would use (FIS rules, junior to adult)."""

from __future__ import annotations

from .records import record
from .sections import CourseSpec

SLALOM_SPACING_MAX = 15.0
"""Gates nearer than this [m] are passed as closely as slalom gates."""

MARGIN = 1.5
"""A line bends to its first gate, and away from its last, over this many times the distance from gate to gate."""


@record(frozen=True)
class GateDefaults:
    """Usual spacing down the slope, offset sideways and clearance of the middle between the skis [m]."""

    spacing: float
    offset: float
    distance: float


SLALOM = GateDefaults(10.0, 2.0, 0.5)
GIANT_SLALOM = GateDefaults(24.0, 4.5, 1.0)


def usual_run_in(first: float, spacing: float) -> float:
    """Return the usual distance [m] from the start to the first gate or turn, which is `first` [m] down the slope.

    The run starts at the slope's origin if the first gate stands far enough down for it.
    """
    usual = MARGIN * spacing
    return first if usual <= first <= 3.0 * usual else usual


def gate_defaults(course: CourseSpec) -> GateDefaults:
    """Return spacing, offset and clearance of a set of gates, given ones before usual ones."""
    usual = GIANT_SLALOM if course.gate_setting == "giant_slalom" else SLALOM
    return GateDefaults(
        usual.spacing if isinstance(course.gate_spacing, str) else course.gate_spacing,
        usual.offset if isinstance(course.gate_offset, str) else course.gate_offset,
        usual.distance if isinstance(course.gate_distance, str) else course.gate_distance,
    )
