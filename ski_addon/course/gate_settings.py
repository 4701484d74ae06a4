"""Where the gates stand: those of a run document, or a set of them as a course setter would set it."""

from __future__ import annotations

import numpy as np

from ..errors import SpecError
from ..spec import CourseSpec, RunSpec
from ..spec.gate_defaults import GIANT_SLALOM, MARGIN, SLALOM, SLALOM_SPACING_MAX, gate_defaults, usual_run_in
from .fair_line import Poles

UNEVEN_SPACING, UNEVEN_OFFSET = 0.25, 0.4
"""Shares by which spacing and offset change at most, at full variation."""


def set_poles(spec: RunSpec) -> Poles:
    """Return the poles that `spec.course` asks for, in the order they are passed, in the slope's mean plane.

    Distances are resolved; radii that the line may choose are NaN.
    """
    return _listed(spec) if spec.course.gate_setting == "list" else _generated(spec)


def run_in_of(course: CourseSpec, down: np.ndarray) -> float:
    """Return the distance [m] from the start to the first of the places `down` (n,) [m]."""
    if not isinstance(course.run_in, str):
        return course.run_in
    spacing = float(down[1] - down[0]) if len(down) > 1 else gate_defaults(course).spacing
    return usual_run_in(float(down[0]), spacing)


def alternate(first_turn: str, count: int) -> np.ndarray:
    """Return sides (count,) that alternate from `first_turn`: +1 left, -1 right."""
    return (1.0 if first_turn == "left" else -1.0) * (-1.0) ** np.arange(count)


def _generated(spec: RunSpec) -> Poles:
    course, usual, count = spec.course, gate_defaults(spec.course), spec.course.gate_count
    rng = np.random.default_rng(spec.simulation.seed)
    uneven = rng.uniform(-course.gate_variation, course.gate_variation, (2, count))
    steps = usual.spacing * (1.0 + UNEVEN_SPACING * uneven[0])
    steps[0] = MARGIN * usual.spacing if isinstance(course.run_in, str) else course.run_in
    side = alternate(course.first_turn, count)
    left = -0.5 * side * usual.offset * (1.0 + UNEVEN_OFFSET * uneven[1])
    radius = np.nan if isinstance(course.gate_radius, str) else course.gate_radius
    return Poles(np.cumsum(steps), left, side, np.full(count, usual.distance), np.full(count, radius))


def _listed(spec: RunSpec) -> Poles:
    course, rows = spec.course, spec.gate
    if not rows:
        hint = 'add [[gate]] rows with x and y, or choose gate_setting = "slalom"'
        raise SpecError("course.gate_setting", "list", problem="has no gates", hint=hint)
    down = np.array([row.x for row in rows], dtype=float)
    near = float(np.median(np.abs(np.diff(down)))) <= SLALOM_SPACING_MAX if len(down) > 1 else True
    distance = (SLALOM if near else GIANT_SLALOM).distance
    side: list[float] = []
    for row in rows:
        following = -side[-1] if side else (1.0 if course.first_turn == "left" else -1.0)
        side.append({"left": 1.0, "right": -1.0}.get(row.side, following))
    return Poles(
        down=down,
        left=np.array([row.y for row in rows], dtype=float),
        side=np.array(side),
        distance=np.array([_chosen(row.distance, course.gate_distance, distance) for row in rows]),
        radius=np.array([_chosen(row.radius, course.gate_radius, np.nan) for row in rows]),
    )


def _chosen(own: float | str, common: float | str, usual: float) -> float:
    """Return the first that is a number: a gate's own value, that of all gates, the usual one."""
    return next((float(value) for value in (own, common) if not isinstance(value, str)), usual)
