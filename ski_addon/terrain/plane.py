"""The inclined plane, and what every terrain offers."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np


class Terrain(Protocol):
    """A snow surface over the horizontal plane; x points down the fall line, y to the left [m, world]."""

    mean_angle: float
    """Steepness [rad] of the plane in whose coordinates courses are drawn."""

    def height(self, x: np.ndarray | float, y: np.ndarray | float) -> np.ndarray:
        """Return the surface's z [m] at `x`, `y` (broadcast together)."""
        ...

    def normal(self, x: np.ndarray | float, y: np.ndarray | float) -> np.ndarray:
        """Return upward unit normals (..., 3) at `x`, `y`."""
        ...


class PlaneTerrain:
    """A plane that falls by `angle` [rad] towards +x and passes through the origin."""

    def __init__(self, angle: float) -> None:
        """Take the slope's angle [rad], 0 for flat ground."""
        self.angle = angle
        self.mean_angle = angle

    def height(self, x: np.ndarray | float, y: np.ndarray | float) -> np.ndarray:
        """Return z [m] at `x`, `y`; see `Terrain`."""
        x, y = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
        return -x * math.tan(self.angle)

    def normal(self, x: np.ndarray | float, y: np.ndarray | float) -> np.ndarray:
        """Return unit normals (..., 3); see `Terrain`."""
        shape = np.broadcast_shapes(np.shape(x), np.shape(y))
        return np.broadcast_to([math.sin(self.angle), 0.0, math.cos(self.angle)], (*shape, 3)).copy()
