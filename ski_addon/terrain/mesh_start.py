"""Where on a sampled mesh a run starts by itself, and how far down the ground is used."""

from __future__ import annotations

import math

import numpy as np

from ..errors import SpecError
from .grid import mean_line
from .mesh_frame import SIZE_LEAST
from .raster import Lattice

START_IN, START_WIDTH = 5.0, 6.0
"""A run starts this far in from the upper end, which begins where the mesh is this wide [m]."""
FALLS = math.tan(math.radians(1.0))
"""Ground that falls by less than this on the whole [m/m] is cut off where it rises again."""
BESIDE, BEYOND = 20.0, 30.0
"""How far to both sides of the start ground is looked at for that, and how much is kept beyond its lowest place [m]."""


def upper_end(covered: np.ndarray, lattice: Lattice, name: str) -> np.ndarray:
    """Return where a run starts by itself (2,) [m]: in from the upper end of the mesh, in the middle of it there.

    `covered` (nx, ny) says which samples of `lattice` the mesh has, `name` what errors call it. Raises `SpecError` for
    a mesh that is all holes.
    """
    inward = max(1, round(min(START_IN, 0.25 * lattice.step * lattice.shape[0]) / lattice.step))
    begin, end = np.array([_longest_run(row) for row in covered]).T
    wide = end - begin >= max(1, min(START_WIDTH / lattice.step, 0.5 * np.max(end - begin)))
    fit = np.flatnonzero(wide[:-inward] & wide[inward:])
    if len(fit) == 0:
        problem = "is not found: the mesh is full of holes"
        raise SpecError(f"{name} start", None, "", "give a start on the mesh", problem=problem)
    i = int(fit[0]) + inward
    return np.array(lattice.low) + lattice.step * np.array((i, 0.5 * (begin[i] + end[i] - 1)))


def _longest_run(row: np.ndarray) -> tuple[int, int]:
    """Return from where to before where the longest run of true values in `row` (n,) lasts."""
    change = np.diff(np.concatenate(([0], row.astype(np.int8), [0])))
    begins, ends = np.flatnonzero(change == 1), np.flatnonzero(change == -1)
    if len(begins) == 0:
        return 0, 0
    longest = int(np.argmax(ends - begins))
    return int(begins[longest]), int(ends[longest])


def rows_used(z: np.ndarray, covered: np.ndarray, lattice: Lattice, begin: np.ndarray) -> int:
    """Return how many rows of `z` (nx, ny) [m] are ground for a run from `begin` (2,) [m].

    All of them, if they fall on the whole. If they do not, as down into a valley and up again on its other side, those
    up to a little beyond the lowest place below the start: the mean plane, in which courses are drawn, has to fall.
    """
    y = lattice.low[1] + lattice.step * np.arange(lattice.shape[1])
    near = covered & (np.abs(y - begin[1]) <= BESIDE)
    rows = np.flatnonzero(np.any(near, axis=1))
    profile = np.where(near, z, 0.0).sum(axis=1)[rows] / near.sum(axis=1)[rows]
    x = lattice.low[0] + lattice.step * rows
    below = np.flatnonzero(x >= begin[0])
    if len(below) == 0 or mean_line(x, profile)[0] >= FALLS:
        return len(z)
    lowest = below[int(np.argmin(profile[below]))]
    if x[lowest] - begin[0] < SIZE_LEAST:
        return len(z)
    return min(len(z), int(rows[lowest]) + math.ceil(BEYOND / lattice.step) + 1)
