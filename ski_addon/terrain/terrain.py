"""What every ground offers, and the shape of the numbers it takes and gives.

Heights and normals are asked for with arrays (tracks, meshes) and with single numbers (the simulation, every few
milliseconds). A ground answers both alike; with plain floats it takes a short way round numpy.
"""

from __future__ import annotations

import math
from typing import Protocol, TypeGuard, TypeVar

import numpy as np

Number = np.ndarray | float
One = TypeVar("One", float, np.ndarray)
"""One number or many, in a formula that serves both."""
Extent = tuple[float, float, float, float]
EVERYWHERE: Extent = (-math.inf, math.inf, -math.inf, math.inf)
"""The extent of a ground without an edge."""


class Terrain(Protocol):
    """A snow surface over the horizontal plane; x points down the fall line, y to the left [m, world].

    Every surface is C2: its curvature is continuous, also across joints and at the edge of what is known of it.
    """

    @property
    def mean_angle(self) -> float:
        """Steepness [rad] of the plane through the origin in whose coordinates courses are drawn."""
        ...

    @property
    def extent(self) -> Extent:
        """The known ground (x_low, x_high, y_low, y_high) [m, world]; infinite where it has no edge."""
        ...

    def contains(self, x: Number, y: Number) -> np.ndarray:
        """Return whether `x`, `y` (broadcast together) lie on the known ground; beyond it the ground is made up."""
        ...

    def height(self, x: Number, y: Number) -> np.ndarray:
        """Return the surface's z [m] at `x`, `y` (broadcast together)."""
        ...

    def gradient(self, x: Number, y: Number) -> np.ndarray:
        """Return (dz/dx, dz/dy) (..., 2) at `x`, `y`."""
        ...

    def normal(self, x: Number, y: Number) -> np.ndarray:
        """Return upward unit normals (..., 3) at `x`, `y`."""
        ...


def is_number(value: object) -> TypeGuard[float]:
    """Return whether `value` is one plain number (numpy's float64 is a float, an array without axes is not)."""
    return isinstance(value, float | int)


def paired(x: Number, y: Number) -> tuple[np.ndarray, np.ndarray]:
    """Return `x` and `y` as float arrays of one shape."""
    first, second = np.broadcast_arrays(np.asarray(x, dtype=float), np.asarray(y, dtype=float))
    return first, second


def normal_of_gradient(gradient: np.ndarray) -> np.ndarray:
    """Return the upward unit normals (..., 3) of a surface with `gradient` (..., 2)."""
    if gradient.ndim == 1:
        slope_x, slope_y = gradient.tolist()
        scale = 1.0 / math.sqrt(1.0 + slope_x * slope_x + slope_y * slope_y)
        return np.array((-slope_x * scale, -slope_y * scale, scale))
    scale = 1.0 / np.sqrt(1.0 + np.einsum("...i,...i", gradient, gradient))
    return np.stack((-gradient[..., 0] * scale, -gradient[..., 1] * scale, scale), axis=-1)


def within(extent: Extent, x: Number, y: Number) -> np.ndarray:
    """Return whether `x`, `y` (broadcast together) lie inside `extent`, edges included."""
    x_low, x_high, y_low, y_high = extent
    x, y = paired(x, y)
    return (x >= x_low) & (x <= x_high) & (y >= y_low) & (y <= y_high)
