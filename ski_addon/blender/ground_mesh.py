"""Faces for a ground: a tree of quads, fine where the ground bends near the track, coarse elsewhere, without cracks.

The tree's roots are the cells between given lines. A cell is cut into four while its flat face would lie too far off
the ground. Neighbours differ by one cut at most; a quad beside finer ones becomes a fan that uses their corners.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ..frames import Array

CUTS = 6
"""How often a root may be cut: 8 m become 0.125 m."""
TOLERANCE, TOLERANCE_GROWTH = 0.0015, 0.0012
"""How far faces may lie off the ground at the track [m], and by how much more for each metre beside it."""
MOST_CELLS = 150_000
"""With more cells than this the tolerance is doubled until they are fewer; fans make up to twice as many faces."""
_NEIGHBOURS = ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))
_CHUNK = 4096


@dataclass(frozen=True)
class _Lattice:
    """Places of vertices by whole numbers: lines `x` and `y` [m], with 2**CUTS steps between neighbouring ones."""

    x: Array
    y: Array

    def size(self, level: int) -> tuple[int, int]:
        """Return how many cells of `level` lie along x and along y."""
        return (len(self.x) - 1) << level, (len(self.y) - 1) << level

    def places(self, i: Array, j: Array, level: float = CUTS) -> tuple[Array, Array]:
        """Return x and y [m] of corners `i`, `j` counted in cells of `level`."""
        scale = 0.5**level
        x = np.interp(i * scale, np.arange(len(self.x)), self.x)
        return x, np.interp(j * scale, np.arange(len(self.y)), self.y)


def ground_mesh(
    height: Callable[[Array, Array], Array], lines: tuple[Array, Array], track: Array, *, most: int = MOST_CELLS
) -> tuple[Array, list[tuple[int, ...]]]:
    """Return vertices (n, 3) [m, world] on the surface of `height`, and faces that look up.

    `lines` are the rising x and y [m] of the roots' edges and of the mesh's border, `track` (m, 2 or 3) the places
    near which the mesh is fine.
    """
    lattice = _Lattice(*(np.asarray(values, dtype=float) for values in lines))
    path = np.asarray(track)[:: max(1, len(track) // 400), :2]
    factor = 1.0
    while (leaves := _leaves(height, lattice, path, factor, most)) is None:
        factor *= 2.0
    return _faces(height, lattice, *leaves)


def _leaves(
    height: Callable[[Array, Array], Array], lattice: _Lattice, path: Array, factor: float, most: int
) -> tuple[Array, Array, Array] | None:
    """Return level, i and j of the cells that are not cut further, or None if they are more than `most`."""
    rows, columns = lattice.size(0)
    cells = np.stack(np.divmod(np.arange(rows * columns), columns), axis=1)
    cut = []
    for level in range(CUTS):
        cells = cells[_too_coarse(height, lattice, cells, level, path, factor)]
        cut.append(cells)
        cells = _children(cells)
        if len(cells) > most:
            return None
    _balance(cut, lattice)
    found = []
    cells = np.stack(np.divmod(np.arange(rows * columns), columns), axis=1)
    for level in range(CUTS + 1):
        here = cells
        if level < CUTS:
            here = cells[~np.isin(_keys(cells, lattice, level), _keys(cut[level], lattice, level))]
            cells = _children(cut[level])
        found.append(np.column_stack((np.full(len(here), level), here)))
    leaves = np.concatenate(found)
    return (leaves[:, 0], leaves[:, 1], leaves[:, 2]) if len(leaves) <= most or factor > 1e6 else None


def _keys(cells: Array, lattice: _Lattice, level: int) -> Array:
    return cells[:, 0] * lattice.size(level)[1] + cells[:, 1]


def _children(cells: Array) -> Array:
    return np.concatenate([2 * cells + offset for offset in ((0, 0), (0, 1), (1, 0), (1, 1))])


def _balance(cut: list[Array], lattice: _Lattice) -> None:
    """Cut more cells in place, so that beside a cell of one level lie none that are two levels coarser."""
    for level in range(CUTS - 1, 0, -1):
        rows, columns = lattice.size(level)
        near = np.concatenate([cut[level] + offset for offset in _NEIGHBOURS])
        inside = (near >= 0).all(axis=1) & (near[:, 0] < rows) & (near[:, 1] < columns)
        parents = np.concatenate((cut[level - 1], near[inside] >> 1))
        keys = np.unique(_keys(parents, lattice, level - 1))
        cut[level - 1] = np.stack(np.divmod(keys, lattice.size(level - 1)[1]), axis=1)


def _too_coarse(
    height: Callable[[Array, Array], Array], lattice: _Lattice, cells: Array, level: int, path: Array, factor: float
) -> Array:
    """Return whether a flat face over each cell would lie further off the ground than it may."""
    steps = 5 if level < 2 else 3  # large cells may hold whole waves
    share = np.linspace(0.0, 1.0, steps)
    answers = [np.zeros(0, dtype=bool)]
    for start in range(0, len(cells), _CHUNK):
        some = cells[start : start + _CHUNK]
        i = some[:, 0, None, None] + share[None, :, None] + 0.0 * share[None, None, :]
        j = some[:, 1, None, None] + share[None, None, :] + 0.0 * share[None, :, None]
        x, y = lattice.places(i, j, level)
        z = height(x, y)
        along, across = share[None, :, None], share[None, None, :]
        low = z[:, :1, :1] * (1.0 - across) + z[:, :1, -1:] * across
        high = z[:, -1:, :1] * (1.0 - across) + z[:, -1:, -1:] * across
        off = np.abs(z - low * (1.0 - along) - high * along).max(axis=(1, 2))
        middle = steps // 2
        centre = np.stack((x[:, middle, middle], y[:, middle, middle]), axis=1)
        reach = 0.5 * np.hypot(x[:, -1, 0] - x[:, 0, 0], y[:, 0, -1] - y[:, 0, 0])
        beside = np.maximum(_distance(centre, path) - reach, 0.0)
        answers.append(off > factor * (TOLERANCE + TOLERANCE_GROWTH * beside))
    return np.concatenate(answers)


def _distance(places: Array, path: Array) -> Array:
    """Return the distance (n,) [m] of each of `places` (n, 2) from the nearest of `path` (m, 2)."""
    origin = path.mean(axis=0)
    a, b = places - origin, path - origin
    nearest = ((b * b).sum(axis=1) - 2.0 * (a @ b.T)).min(axis=1)
    return np.sqrt(np.maximum((a * a).sum(axis=1) + nearest, 0.0))


def _faces(
    height: Callable[[Array, Array], Array], lattice: _Lattice, level: Array, i: Array, j: Array
) -> tuple[Array, list[tuple[int, ...]]]:
    """Return vertices and faces of the leaves: quads, and fans where a neighbour is finer."""
    width = lattice.size(CUTS)[1] + 1
    size = 1 << (CUTS - level)
    i, j = i * size, j * size
    corners = np.stack([(i + a * size) * width + j + b * size for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))], axis=1)
    half, known = size >> 1, np.unique(corners)
    middles = np.stack(
        [
            (i + a * half) * width + j + b * half
            for a, b in ((1, 0), (2, 1), (1, 2), (0, 1))  # of the side from each corner to the next
        ],
        axis=1,
    )
    shared = (half > 0)[:, None] & np.isin(middles, known)
    fan = shared.any(axis=1)
    centre = (i + half) * width + j + half
    keys = np.union1d(known, centre[fan])
    triangles = []
    for side in range(4):
        first, last = corners[:, side], corners[:, (side + 1) % 4]
        split, whole = fan & shared[:, side], fan & ~shared[:, side]
        triangles += [
            np.stack((centre[split], first[split], middles[split, side]), axis=1),
            np.stack((centre[split], middles[split, side], last[split]), axis=1),
            np.stack((centre[whole], first[whole], last[whole]), axis=1),
        ]
    x, y = lattice.places(*np.divmod(keys, width))
    faces = np.searchsorted(keys, corners[~fan]).tolist() + np.searchsorted(keys, np.concatenate(triangles)).tolist()
    return np.stack((x, y, height(x, y)), axis=1), faces
