"""From scattered points of a surface (the vertices of a mesh) to a grid of heights."""

from __future__ import annotations

import math

import numpy as np

from ..errors import TerrainError
from .grid import HeightGrid
from .grid_checks import check_shape

SAMPLES_LEAST = 16
"""Fewest points that make a ground."""
_SAME_PLACE, _SAME_HEIGHT = 1e-6, 1e-3


def grid_from_samples(
    x: np.ndarray,
    y: np.ndarray,
    z: np.ndarray,
    spacing: float | None = None,
    *,
    smoothing: float = 0.0,
    name: str = "the ground's points",
) -> HeightGrid:
    """Return the ground through scattered points `x`, `y`, `z` (n,) [m, world], in any order.

    They are joined by triangles with a smooth surface over them, which is sampled every `spacing` [m] (None: about the
    distance between the points). Where the bounding rectangle reaches beyond the points, the ground has what the
    nearest one has over the mean plane. Raises `TerrainError` for points that make no ground.
    """
    x, y, z = (np.asarray(values, dtype=float).ravel() for values in (x, y, z))
    _check_points(x, y, z, name)
    if spacing is None:
        spacing = math.sqrt(np.ptp(x) * np.ptp(y) / len(x))
    counts = [max(round(float(np.ptp(values)) / spacing), 3) + 1 for values in (x, y)]
    check_shape(tuple(counts), name)
    axes = [np.linspace(values.min(), values.max(), count) for values, count in zip((x, y), counts, strict=True)]
    steps = float(axes[0][1] - axes[0][0]), float(axes[1][1] - axes[1][0])
    heights = _interpolated(np.column_stack((x, y)), z, axes)
    return HeightGrid(heights, steps, (float(axes[0][0]), float(axes[1][0])), smoothing=smoothing, name=name)


def _interpolated(places: np.ndarray, z: np.ndarray, axes: list[np.ndarray]) -> np.ndarray:
    """Return the heights (nx, ny) at the crossings of `axes` of a smooth surface through `places` (n, 2)."""
    from scipy.interpolate import CloughTocher2DInterpolator, NearestNDInterpolator

    plane, *_ = np.linalg.lstsq(np.column_stack((places, np.ones(len(z)))), z, rcond=None)
    over = z - places @ plane[:2] - plane[2]
    grid = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)
    found = CloughTocher2DInterpolator(places, over)(grid)
    outside = np.isnan(found)
    if np.any(outside):
        found[outside] = NearestNDInterpolator(places, over)(grid[outside])
    return found + grid @ plane[:2] + plane[2]


def _check_points(x: np.ndarray, y: np.ndarray, z: np.ndarray, name: str) -> None:
    if not len(x) == len(y) == len(z):
        raise TerrainError(name, f"there are {len(x)} x, {len(y)} y and {len(z)} z", "give as many of each")
    if len(x) < SAMPLES_LEAST:
        raise TerrainError(name, f"there are {len(x)}, at least {SAMPLES_LEAST} are needed", "subdivide the mesh")
    known = np.isfinite(x + y + z)
    if not np.all(known):
        first = int(np.argmin(known))
        shown = f"({x[first]:g}, {y[first]:g}, {z[first]:g})"
        raise TerrainError(name, f"point {first} = {shown} is not finite", "remove it", index=(first,))
    size = max(float(np.ptp(x)), float(np.ptp(y)))
    spread = np.linalg.svd(np.column_stack((x - x.mean(), y - y.mean())), compute_uv=False)
    if spread[1] <= 1e-6 * spread[0]:
        raise TerrainError(name, "all points lie on one line, seen from above", "give points of a surface")
    _check_overhang(x, y, z, _SAME_PLACE * size, name)


def _check_overhang(x: np.ndarray, y: np.ndarray, z: np.ndarray, close: float, name: str) -> None:
    """Raise `TerrainError` if two points lie over each other."""
    cells = np.round(np.column_stack((x, y)) / close)
    order = np.lexsort((z, cells[:, 1], cells[:, 0]))
    same = np.all(cells[order][1:] == cells[order][:-1], axis=1)
    apart = np.where(same, np.diff(z[order]), 0.0)
    worst = int(np.argmax(apart))
    if apart[worst] > _SAME_HEIGHT:
        i, j = sorted(int(k) for k in order[worst : worst + 2])
        problem = f"points {i} and {j} lie over each other, {apart[worst]:.3g} m apart"
        raise TerrainError(name, problem, "give the upper surface only", index=(i, j), value=float(apart[worst]))
