"""The inclined plane."""

from __future__ import annotations

import math

import numpy as np

from .terrain import EVERYWHERE, Extent, Number, is_number, paired, within


class PlaneTerrain:
    """A plane that falls by `angle` [rad] towards +x and passes through the origin."""

    def __init__(self, angle: float) -> None:
        """Take the slope's angle [rad], 0 for flat ground."""
        self.angle = angle
        self.mean_angle = angle
        self.extent: Extent = EVERYWHERE
        self._gradient = (-math.tan(angle), 0.0)
        self._normal = (math.sin(angle), 0.0, math.cos(angle))

    def contains(self, x: Number, y: Number) -> np.ndarray:
        """Return true for every place; see `Terrain`."""
        return within(self.extent, x, y)

    def height(self, x: Number, y: Number) -> np.ndarray:
        """Return z [m] at `x`, `y`; see `Terrain`."""
        if is_number(x) and is_number(y):
            return np.asarray(x * self._gradient[0])[()]
        return paired(x, y)[0] * self._gradient[0]

    def gradient(self, x: Number, y: Number) -> np.ndarray:
        """Return (dz/dx, dz/dy) (..., 2); see `Terrain`."""
        return self._everywhere(self._gradient, x, y)

    def normal(self, x: Number, y: Number) -> np.ndarray:
        """Return unit normals (..., 3); see `Terrain`."""
        return self._everywhere(self._normal, x, y)

    @staticmethod
    def _everywhere(vector: tuple[float, ...], x: Number, y: Number) -> np.ndarray:
        """Return `vector` (k,) at every place, as an array (..., k) that may be changed."""
        if is_number(x) and is_number(y):
            return np.array(vector)
        return np.broadcast_to(vector, (*np.broadcast_shapes(np.shape(x), np.shape(y)), len(vector))).copy()
