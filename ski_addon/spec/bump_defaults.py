"""Where a line over bumps turns: from crest to crest, or as far apart as it is asked."""

from __future__ import annotations

from .sections import CourseSpec, SlopeSpec

PLAIN_SPACING, PLAIN_LENGTH = 3.5, 28.0
"""Turns on a slope without bumps are set as if round moguls: their usual spacing, and on what length [m]."""
PAST_LAST = 3.0
"""Length [m] of the run behind the last bump's own wave."""


def bump_crests(slope: SlopeSpec, course: CourseSpec) -> tuple[float, int]:
    """Return the distance [m] from crest to crest, or from turn to turn, and their number.

    The first one lies that distance behind `slope.bump_start`.
    """
    usual = {"bumps": 2.0 * slope.bump_width, "moguls": slope.mogul_spacing}.get(slope.kind, PLAIN_SPACING)
    counts = {"bumps": slope.bump_count, "moguls": slope.mogul_count}
    length = usual * counts[slope.kind] if slope.kind in counts else PLAIN_LENGTH
    spacing = usual if isinstance(course.turn_spacing, str) else course.turn_spacing
    return spacing, max(int(length / spacing + 1e-9), 1)
