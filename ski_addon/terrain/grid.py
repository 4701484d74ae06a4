"""Ground from a grid of heights: a bicubic spline through its samples, C2 inside, at the edge and beyond."""

from __future__ import annotations

import math

import numpy as np

from .grid_checks import checked_heights, checked_steps, checked_tilt
from .spline import evaluate, evaluate_at, spline_coefficients
from .terrain import Extent, Number, One, is_number, normal_of_gradient, paired, within


class HeightGrid:
    """A surface through evenly spaced heights, its rows running downhill.

    The mean plane (fitted by least squares, tilted along x only) gives `mean_angle`; heights are counted so that this
    plane passes through the origin of the world, `altitude` [m] lower than in the data. What the samples have over the
    plane is a bicubic spline; beyond the grid it runs out within one sample and then stays as it was at the edge, so
    that the plane goes on for ever with the edge's profile drawn out along it.
    """

    def __init__(
        self,
        heights: np.ndarray,
        spacing: float | tuple[float, float],
        origin: tuple[float, float] = (0.0, 0.0),
        *,
        angle: float = 0.0,
        smoothing: float = 0.0,
        name: str = "the height grid",
    ) -> None:
        """Take `heights` (nx, ny) [m], those of x = origin[0] + i spacing[0] and y = origin[1] + j spacing[1].

        Rows run across the slope, the uphill one first; along a row y grows, to the left. `angle` [rad] adds a plane
        under the grid that falls towards +x; `smoothing` [m] is the width (standard deviation) of a Gaussian that blurs
        the samples first; `name` is what errors call the grid. Raises `TerrainError` for holes, cliffs, and sizes or
        numbers that make no ground.
        """
        z, self.spacing, self.origin = checked_heights(heights, spacing, origin, name)
        (nx, ny), (dx, dy), (x0, y0) = z.shape, self.spacing, self.origin
        self.extent: Extent = (x0, x0 + (nx - 1) * dx, y0, y0 + (ny - 1) * dy)
        x = x0 + dx * np.arange(nx)
        fall, self.altitude = mean_line(x, z.mean(axis=1))
        z -= (self.altitude - fall * x)[:, None]
        if smoothing > 0.0:
            z = _smoothed(z, smoothing, self.spacing)
        checked_steps(z, self.spacing, fall, math.tan(angle), name)
        self._fall = fall + math.tan(angle)
        self.mean_angle = checked_tilt(math.atan(self._fall), name)
        self._coefficients = spline_coefficients(z)
        self._ends = float(nx - 1), float(ny - 1)

    @property
    def shape(self) -> tuple[int, int]:
        """Number of samples along x and along y."""
        rows, columns = self._coefficients.shape
        return rows - 2, columns - 2

    def contains(self, x: Number, y: Number) -> np.ndarray:
        """Return whether places lie on the grid; see `Terrain`."""
        return within(self.extent, x, y)

    def height(self, x: Number, y: Number) -> np.ndarray:
        """Return z [m] at `x`, `y`; see `Terrain`."""
        return np.asarray(self._surface(x, y)[0])[()]

    def gradient(self, x: Number, y: Number) -> np.ndarray:
        """Return (dz/dx, dz/dy) (..., 2); see `Terrain`."""
        _, along, across = self._surface(x, y)
        return np.array((along, across)) if is_number(along) else np.stack((along, across), axis=-1)

    def normal(self, x: Number, y: Number) -> np.ndarray:
        """Return unit normals (..., 3); see `Terrain`."""
        return normal_of_gradient(self.gradient(x, y))

    def _surface(self, x: Number, y: Number) -> tuple[Number, Number, Number]:
        """Return the height and its derivatives to x and y."""
        (dx, dy), (x0, y0) = self.spacing, self.origin
        if is_number(x) and is_number(y):
            if not math.isfinite(x + y):
                return math.nan, math.nan, math.nan
            i, i_slope = _held_at((x - x0) / dx, self._ends[0])
            j, j_slope = _held_at((y - y0) / dy, self._ends[1])
            up, along, across = evaluate_at(self._coefficients, i, j)
            return up - self._fall * x, along * i_slope / dx - self._fall, across * j_slope / dy
        return self._surface_of(*paired(x, y))

    def _surface_of(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        (dx, dy), (x0, y0) = self.spacing, self.origin
        known = np.isfinite(x + y)
        i, i_slope = _held(np.where(known, (x - x0) / dx, 0.0), self._ends[0])
        j, j_slope = _held(np.where(known, (y - y0) / dy, 0.0), self._ends[1])
        up, along, across = evaluate(self._coefficients, i, j)
        up = np.where(known, up - self._fall * x, math.nan)
        along = np.where(known, along * i_slope / dx - self._fall, math.nan)
        return up, along, np.where(known, across * j_slope / dy, math.nan)


def mean_line(x: np.ndarray, z: np.ndarray) -> tuple[float, float]:
    """Return by how much the best line through `z` (n,) [m] over `x` (n,) [m] falls per metre, and its z at x = 0."""
    centre = float(x.mean())
    fall = -float(np.dot(x - centre, z) / np.dot(x - centre, x - centre))
    return fall, float(z.mean()) + fall * centre


def _smoothed(z: np.ndarray, width: float, spacing: tuple[float, float]) -> np.ndarray:
    from scipy.ndimage import gaussian_filter

    return gaussian_filter(z, (width / spacing[0], width / spacing[1]), mode="nearest")


def _held_at(place: float, end: float) -> tuple[float, float]:
    """Return `place` [samples] held within half a sample of 0..`end`, and the rate at which it still moves."""
    if 0.0 <= place <= end:
        return place, 1.0
    beyond = min(max(-place, place - end), 1.0)
    moved, rate = _run_out(beyond)
    return (-moved if place < 0.0 else end + moved), rate


def _held(place: np.ndarray, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the same for many places."""
    inside = np.clip(place, 0.0, end)
    moved, rate = _run_out(np.minimum(np.abs(place - inside), 1.0))
    return inside + np.copysign(moved, place - inside), rate


def _run_out(beyond: One) -> tuple[One, One]:
    """Return how far one comes beyond the edge, and the rate: from 1 at the edge to 0 one sample on, C2 at both."""
    square = beyond * beyond
    return beyond * (1.0 - square * (1.0 - 0.5 * beyond)), 1.0 - square * (3.0 - 2.0 * beyond)
