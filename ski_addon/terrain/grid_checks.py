"""What a grid of heights must be to be a ground; each failure is one line with index, value and what would work."""

from __future__ import annotations

import math

import numpy as np

from ..errors import TerrainError

SAMPLES_MOST = 64_000_000
"""More samples than this are refused; a spline through them would not fit into the memory of most computers."""
SAMPLES_LEAST = 4
"""Fewest samples along each axis; the spline needs them."""
STEEPEST_STEP = math.radians(60.0)
"""A step between neighbouring samples that is steeper is a cliff [rad]."""
RISING = math.radians(2.0)
"""A grid whose mean plane rises downhill by more than this lies the wrong way round [rad]."""


def check_shape(shape: tuple[int, ...], name: str) -> None:
    """Raise `TerrainError` unless `shape` is of a grid of a size that can be used."""
    shown = " x ".join(str(size) for size in shape) or "one number"
    if len(shape) != 2:
        raise TerrainError(name, f"its heights are {shown}, not a table of rows and columns", "give a 2-d array")
    if min(shape) < SAMPLES_LEAST:
        least = f"at least {SAMPLES_LEAST} x {SAMPLES_LEAST}"
        raise TerrainError(name, f"it has {shown} samples, {least} are needed", "sample the ground more closely")
    if shape[0] * shape[1] > SAMPLES_MOST:
        by = math.ceil(math.sqrt(shape[0] * shape[1] / SAMPLES_MOST))
        problem = f"it has {shown} samples, allowed are {SAMPLES_MOST // 10**6} million"
        raise TerrainError(name, problem, f"cut out a part, or keep one row and column of {by}")


def checked_heights(
    heights: np.ndarray, spacing: float | tuple[float, float], origin: tuple[float, float], name: str
) -> tuple[np.ndarray, tuple[float, float], tuple[float, float]]:
    """Return a copy of `heights` as floats, the spacing of both axes and the origin; raises `TerrainError`."""
    raw = np.asarray(heights)
    if raw.dtype.kind not in "iufb":
        raise TerrainError(name, f"its heights are of type {raw.dtype}, not numbers", "give heights in metres")
    check_shape(raw.shape, name)
    pair = np.broadcast_to(np.asarray(spacing, dtype=float), 2).tolist()
    if not all(math.isfinite(step) and step > 0.0 for step in pair):
        raise TerrainError(name, f"its spacing is {spacing}", "give the metres between samples, more than 0")
    start = np.asarray(origin, dtype=float)
    if start.shape != (2,) or not np.all(np.isfinite(start)):
        raise TerrainError(name, f"its origin is {origin}", "give x and y of the first sample in metres")
    z = raw.astype(float)
    check_holes(z, name)
    return z, (pair[0], pair[1]), (float(start[0]), float(start[1]))


def check_holes(z: np.ndarray, name: str) -> None:
    """Raise `TerrainError` if any of the heights `z` (nx, ny) is not a finite number."""
    known = np.isfinite(z)
    if np.all(known):
        return
    i, j = (int(k) for k in np.unravel_index(int(np.argmin(known)), z.shape))
    count = int(z.size - np.count_nonzero(known))
    problem = f"height[{i}, {j}] = {z[i, j]} is a hole, the first of {count}"
    hint = "fill holes with heights of their neighbours, or cut out a part without any"
    raise TerrainError(name, problem, hint, index=(i, j), value=float(z[i, j]))


def checked_steps(z: np.ndarray, spacing: tuple[float, float], fall: float, more: float, name: str) -> None:
    """Raise `TerrainError` if a step between neighbours is a cliff.

    `z` (nx, ny) [m] are the heights over the mean plane of the samples, which falls by `fall` [m/m]; the plane under
    the grid falls by `more`.
    """
    limit = math.tan(STEEPEST_STEP)
    worst, works = None, 1.0
    for axis, step, tilt, under in ((0, spacing[0], fall, more), (1, spacing[1], 0.0, 0.0)):
        rise = np.diff(z, axis=axis) - tilt * step
        works = min(works, (limit - under) * step / max(float(np.max(rise)), -float(np.min(rise)), 1e-300))
        rise -= under * step
        for at in (int(np.argmax(rise)), int(np.argmin(rise))):
            index = tuple(int(k) for k in np.unravel_index(at, rise.shape))
            slope = float(rise[index]) / step
            if abs(slope) > limit and (worst is None or abs(slope) > abs(worst[0])):
                worst = slope, index, axis, step
    if worst is None:
        return
    slope, (i, j), axis, step = worst
    beside = (i + 1, j) if axis == 0 else (i, j + 1)
    problem = (
        f"from height[{i}, {j}] to height[{beside[0]}, {beside[1]}] is a cliff of {slope * step:.4g} m over {step:g} m "
        f"({math.degrees(math.atan(abs(slope))):.1f} degrees, at most {math.degrees(STEEPEST_STEP):.0f})"
    )
    hint = f"heights of at most {math.floor(1000.0 * works) / 10.0:g} % of these, or smoothing, would work"
    raise TerrainError(name, problem, hint, index=(i, j), value=slope * step)


def checked_tilt(angle: float, name: str) -> float:
    """Return the steepness of the mean plane [rad]; raises `TerrainError` if it rises downhill."""
    if angle < -RISING:
        problem = f"it rises by {math.degrees(-angle):.1f} degrees along x, where it should fall"
        raise TerrainError(name, problem, 'turn it round (slope.grid_downhill), for instance to "top"')
    return angle
