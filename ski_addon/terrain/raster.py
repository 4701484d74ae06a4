"""Heights of triangles at the crossings of a grid, seen from above: as rays cast straight down would find them.

Rays one by one cost microseconds each. Here each triangle is cut into the grid's lines that run through it, and each
line into its samples, for many triangles at once: a million samples take a few tenths of a second.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

SNAP = 1e-4
"""Samples this close beside a triangle [m] belong to it, so that none falls between two that share an edge."""
_AT_ONCE = 2_000_000


@dataclass(frozen=True)
class Lattice:
    """Samples at x = `low[0]` + i `step` and y = `low[1]` + j `step` [m], i < `shape[0]` and j < `shape[1]`."""

    low: tuple[float, float]
    step: float
    shape: tuple[int, int]


def surface_heights(triangles: np.ndarray, lattice: Lattice) -> tuple[np.ndarray, np.ndarray]:
    """Return the highest and the lowest height (nx, ny) [m] of `triangles` (n, 3, 3) [m] over each sample.

    Where no triangle is, they are -inf and inf. No triangle may stand upright.
    """
    top, bottom = np.full(lattice.shape, -np.inf), np.full(lattice.shape, np.inf)
    corners = np.array(triangles, dtype=float).reshape(-1, 3, 3)
    corners[..., :2] = (corners[..., :2] - lattice.low) / lattice.step
    reach = SNAP / lattice.step
    first, count = _crossed(*_bounds(corners, 0), reach, lattice.shape[0])
    _, beside = _crossed(*_bounds(corners, 1), reach, lattice.shape[1])
    used = (count > 0) & (beside > 0)
    corners, first, count, beside = corners[used], first[used], count[used], beside[used]
    for part in _parts(count + np.minimum(count * beside, _double_area(corners))):
        _scan(corners[part], first[part], count[part], reach, top, bottom)
    return top, bottom


def _bounds(corners: np.ndarray, axis: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the least and the greatest coordinate of each triangle along `axis` (min and max are slow on threes)."""
    a, b, c = (corners[:, k, axis] for k in range(3))
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def _crossed(low: np.ndarray, high: np.ndarray, reach: float, size: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the first of `size` samples from `low` to `high` (n,) [samples], and how many there are."""
    first = np.ceil(np.clip(low - reach, 0.0, size)).astype(np.int64)
    last = np.floor(np.clip(high + reach, -1.0, size - 1.0)).astype(np.int64)
    return first, np.maximum(last - first + 1, 0)


def _double_area(corners: np.ndarray) -> np.ndarray:
    a, b, c = (corners[:, k, :2] for k in range(3))
    return np.abs((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def _parts(cost: np.ndarray) -> Iterator[slice]:
    """Yield slices of triangles whose samples fit into memory together."""
    total = np.cumsum(cost)
    at = 0
    while at < len(cost):
        done = total[at - 1] if at else 0.0
        end = max(int(np.searchsorted(total, done + _AT_ONCE, side="right")), at + 1)
        yield slice(at, end)
        at = end


def _scan(
    corners: np.ndarray, first: np.ndarray, count: np.ndarray, reach: float, top: np.ndarray, bottom: np.ndarray
) -> None:
    """Raise `top` and lower `bottom` to `corners` (m, 3, 3) [samples, samples, m] on `count` lines from `first` on."""
    line_of, i = _spread(first, count)
    low, high = _stretch(corners, line_of, i)
    j_first, j_count = _crossed(low, high, reach, top.shape[1])
    of, j = _spread(j_first, j_count)
    triangle, i = line_of[of], i[of]
    z = _height_at(corners, triangle, i, j)
    places = i * top.shape[1] + j
    np.maximum.at(top.reshape(-1), places, z)
    np.minimum.at(bottom.reshape(-1), places, z)


def _spread(first: np.ndarray, count: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return for each of all counted samples of what it is (an index), and its number from `first` on."""
    of = np.repeat(np.arange(len(count)), count)
    start = np.cumsum(count) - count
    return of, np.arange(len(of)) - start[of] + first[of]


def _stretch(corners: np.ndarray, of: np.ndarray, i: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return from where to where along y [samples] the lines x = `i` run within the triangles `of`."""
    u, v = corners[..., 0], corners[..., 1]
    least, greatest = _bounds(corners, 0)
    at = np.clip(i, least[of], greatest[of])
    low, high = np.full(len(at), np.inf), np.full(len(at), -np.inf)
    for a, b in ((0, 1), (1, 2), (2, 0)):
        start, run = u[of, a], (u[:, b] - u[:, a])[of]
        # An edge along the line gives its first corner; its second one is the first of the next edge.
        share = np.divide(at - start, run, out=np.zeros(len(at)), where=run != 0.0)
        crossing = v[of, a] + share * (v[:, b] - v[:, a])[of]
        met = (np.minimum(start, u[of, b]) <= at) & (at <= np.maximum(start, u[of, b]))
        low = np.where(met, np.minimum(low, crossing), low)
        high = np.where(met, np.maximum(high, crossing), high)
    return low, high


def _height_at(corners: np.ndarray, of: np.ndarray, i: np.ndarray, j: np.ndarray) -> np.ndarray:
    """Return the heights [m] of the triangles `of` at samples `i`, `j`; beside one, at most those of its corners."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    rise_x, rise_y = -normal[:, 0] / normal[:, 2], -normal[:, 1] / normal[:, 2]
    z = corners[of, 0, 2] + rise_x[of] * (i - corners[of, 0, 0]) + rise_y[of] * (j - corners[of, 0, 1])
    least, greatest = _bounds(corners, 2)
    return np.clip(z, least[of], greatest[of])
