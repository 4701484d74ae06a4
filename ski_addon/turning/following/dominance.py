"""Which nodes of a layer go on: the cheapest of those in nearly the same state, everywhere beside the path."""

from __future__ import annotations

import math

import numpy as np

from ...frames import Array
from .problem import Problem
from .stepping import CURVATURE, HEADING, LEAN, LEAN_RATE, Bodies, X, Y

CELL = np.array([0.7, 0.14, 0.15, 0.05])
"""States that differ by less in offset from the path [m], heading and unstable lean [rad] and curvature [1/m] are
one."""
SOON = 6
"""Samples for which the way back to the path is counted."""
NEAR, GROWTH = 0.7, 0.1
"""Size of the cells at the first stage, and by how much it grows from stage to stage: what is far off is planned
again before it comes."""


def cells(problem: Problem, bodies: Bodies, cost: Array, stage: int, fineness: float = 1.0) -> tuple[Array, Array]:
    """Return the number (n,) of the cell that each of `bodies` is in after a `stage`, and their order (n,), cell by
    cell and in each the cheapest first by `cost` (n,) [m]. Cells are smaller by the factor `fineness`.
    """
    state = bodies.state
    offset, heading = _beside(problem, bodies)
    unstable = state[LEAN] + 0.32 * state[LEAN_RATE]
    values = np.stack((offset, heading, unstable, state[CURVATURE]))
    size = CELL * ((NEAR + GROWTH * stage) / fineness)
    cell = np.floor(values / size[:, None]).astype(np.int64) + 512
    key = ((cell[0] * 1024 + cell[1]) * 1024 + cell[2]) * 1024 + cell[3]
    return key, np.lexsort((cost, key))


def still_to_come(problem: Problem, bodies: Bodies, samples: int) -> Array:
    """Return the least distance (n,) [m] that so many `samples` will add: nobody comes back to the path at once.

    That is of a body that turns towards a straight path as sharply as the bounds of lean and curvature let it.
    """
    offset, heading = _beside(problem, bodies)
    lane, at = problem.lane, bodies.nearest
    speed = lane.speed[at]
    gravity = lane.normal[at] * math.tan(problem.settings.lean_bound)
    turning = np.minimum(gravity, np.square(speed) * problem.curvature_bound)
    away = np.abs(offset)
    towards = -np.sign(offset) * speed * np.sin(heading)
    time = problem.settings.sample_time * np.arange(1, min(samples, SOON) + 1)[:, None]
    return np.maximum(away - time * (towards + (0.5 * time) * turning), 0.0).sum(axis=0)


def _beside(problem: Problem, bodies: Bodies) -> tuple[Array, Array]:
    """Return the offsets (n,) [m] from the path and the headings (n,) [rad] against it, to the left."""
    path, at, state = problem.lane.path, bodies.nearest, bodies.state
    along, place = path.heading[at], path.places[at]
    offset = (state[Y] - place[:, 1]) * np.cos(along) - (state[X] - place[:, 0]) * np.sin(along)
    return offset, state[HEADING] - along
