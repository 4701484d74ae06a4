"""Which nodes of a layer go on: the cheapest of those in nearly the same state, everywhere beside the path."""

from __future__ import annotations

import numpy as np

from ...frames import Array
from .problem import Problem
from .stepping import CURVATURE, HEADING, LEAN, LEAN_RATE, Bodies, X, Y

CELL = np.array([0.7, 0.14, 0.15, 0.05])
"""States that differ by less in offset from the path [m], heading and unstable lean [rad] and curvature [1/m] are
one."""
NEAR, GROWTH = 0.7, 0.1
"""Size of the cells at the first stage, and by how much it grows from stage to stage: what is far off is planned
again before it comes."""


def kept(problem: Problem, bodies: Bodies, cost: Array, stage: int, fineness: float = 1.0) -> Array:
    """Return the indices of the nodes that go on after a `stage`, the cheapest of each cell, of `bodies` that cost (n,)
    [m] so far. Cells are smaller by the factor `fineness`.
    """
    lane, at = problem.lane, bodies.nearest
    state, along = bodies.state, lane.path.heading[at]
    place = lane.path.places[at]
    offset = (state[Y] - place[:, 1]) * np.cos(along) - (state[X] - place[:, 0]) * np.sin(along)
    unstable = state[LEAN] + 0.32 * state[LEAN_RATE]
    values = np.stack((offset, state[HEADING] - along, unstable, state[CURVATURE]))
    size = CELL * ((NEAR + GROWTH * stage) / fineness)
    cell = np.floor(values / size[:, None]).astype(np.int64) + 512
    key = ((cell[0] * 1024 + cell[1]) * 1024 + cell[2]) * 1024 + cell[3]
    order = np.lexsort((cost, key))
    first = np.concatenate(([True], np.diff(key[order]) != 0))
    return np.asarray(order[first])
