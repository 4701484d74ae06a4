"""Smoothing a drawn polyline until a skier can follow it."""

from __future__ import annotations

import numpy as np

GRID = 0.1
"""Distance between neighbouring places of a smoothed path [m]."""
LEAST, MOST = 0.6, 400.0
"""Smoothing lengths [m] that are tried."""
_END_WEIGHT = 1e4
_GROWTH = 1.12
_ROUNDS = 120


def interpolated(points: np.ndarray) -> np.ndarray:
    """Return places (m, 2) about `GRID` apart on a round curve through `points` (n, 2) [m]; two make a straight line.

    The curve is a cubic spline over the square roots of the distances, which keeps it from looping where points are
    unevenly spaced.
    """
    from scipy.interpolate import CubicSpline

    gaps = np.linalg.norm(np.diff(points, axis=0), axis=1)
    knots = np.concatenate(([0.0], np.cumsum(np.sqrt(gaps))))
    cells = np.maximum(np.ceil(4.0 * gaps / GRID).astype(int), 4)
    fine = np.concatenate(
        [np.linspace(a, b, n, endpoint=False) for a, b, n in zip(knots, knots[1:], cells, strict=False)] + [knots[-1:]]
    )
    curve = CubicSpline(knots, points, bc_type="natural")
    arc = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(curve(fine), axis=0), axis=1))))
    even = np.linspace(0.0, arc[-1], max(int(np.ceil(arc[-1] / GRID)), 20) + 1)
    return curve(np.interp(even, arc, fine))


def smoothed(path: np.ndarray, length: np.ndarray | float) -> np.ndarray:
    """Return `path` (n, 2), at even steps, without its bends shorter than `length` (n,) [m].

    It minimises the squared distance from the path plus length^6 times the squared third derivative: a filter that
    leaves parabolas, and so gentle turns, as they are. Both ends stay in their places. Raises `LinAlgError` for a
    length so many steps long that numbers have too few digits for it.
    """
    from scipy.linalg import solveh_banded

    step = float(np.mean(np.linalg.norm(np.diff(path, axis=0), axis=1)))
    count = len(path)
    weight = np.broadcast_to((np.asarray(length, dtype=float) / step) ** 6, (count,))
    stiff = 0.5 * (weight[1:-2] + weight[2:-1])  # of the third difference over places i..i+3
    pattern = np.array([-1.0, 3.0, -3.0, 1.0])
    banded = np.zeros((4, count))
    for i in range(4):
        for j in range(i, 4):
            banded[3 - (j - i), j : j + count - 3] += pattern[i] * pattern[j] * stiff
    hold = np.ones(count)
    hold[[0, -1]] = _END_WEIGHT
    banded[3] += hold
    return solveh_banded(banded, hold[:, None] * path)


def curvature(path: np.ndarray) -> np.ndarray:
    """Return the curvature (n,) [1/m] of a smooth `path` (n, 2), positive to the left."""
    first, second = np.gradient(path, axis=0), np.gradient(np.gradient(path, axis=0), axis=0)
    cross = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    bend = cross / np.maximum(np.hypot(first[:, 0], first[:, 1]), 1e-9) ** 3
    bend[:2], bend[-2:] = bend[2], bend[-3]
    return bend


def smoothed_to(path: np.ndarray, most: float) -> np.ndarray:
    """Return `path` (n, 2) smoothed, where it must be, until its curvature is at most `most` [1/m]."""
    from scipy.ndimage import gaussian_filter1d, maximum_filter1d

    length = np.full(len(path), LEAST)
    result = smoothed(path, length)
    for _ in range(_ROUNDS):
        tight = np.abs(curvature(result)) > most
        if not tight.any() or length.max() >= MOST:
            break
        reach = maximum_filter1d(np.where(tight, length, 0.0), 2 * int(np.ceil(length[tight].max() / GRID)) + 1)
        grown = np.where(reach > 0.0, np.maximum(length, _GROWTH * reach), length)
        length = np.exp(gaussian_filter1d(np.log(grown), length[tight].mean() / GRID, mode="nearest"))
        length = np.maximum(length, np.where(tight, grown, LEAST))
        try:
            result = smoothed(path, length)
        except np.linalg.LinAlgError:  # so long a window on so long a path is beyond the digits of numbers
            break
    return result
