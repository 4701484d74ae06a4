"""A plane with a relief on it: shapes that are defined in the slope's own coordinates.

Down the slope, to the left and up along the plane's normal [m]. A place (x, y) of the world lies under the one point
of the surface for which `down cos a + up(down, left) sin a = x`, which Newton's method finds to the last digit; the
derivatives are exact. It is one point only where no side overhangs.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from .terrain import EVERYWHERE, Extent, Number, is_number, paired, within

STEEPEST = math.radians(85.0)
"""A side may not be steeper [rad]; past a right angle it would overhang."""
_CLOSE = 1e-12
"""How close Newton's last step has to be [m]; a step later the error is in the last digit."""


class Relief(Protocol):
    """A shape on a plane, C2: its height over the plane and the two slopes of it."""

    @property
    def reach(self) -> float:
        """Most height over or under the plane [m]."""
        ...

    @property
    def steepest(self) -> float:
        """Steepest slope along the fall line, as rise over run."""
        ...

    def at(self, down: float, left: float) -> tuple[float, float, float]:
        """Return height over the plane [m], and its derivatives to `down` and to `left` at one place [m]."""
        ...

    def over(self, down: np.ndarray, left: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the same at many places: three arrays of the shape of `down` and `left`."""
        ...


class ReliefTerrain:
    """A plane that falls by `angle` [rad] towards +x through the origin, with `relief` on it."""

    def __init__(self, angle: float, relief: Relief) -> None:
        """Put `relief` on the plane; no side of it may be steeper than `STEEPEST` (the builders refuse it)."""
        self.angle = angle
        self.mean_angle = angle
        self.relief = relief
        self.extent: Extent = EVERYWHERE
        self._cos, self._sin = math.cos(angle), math.sin(angle)
        self._move = 1.01 * relief.reach * math.tan(angle) + _CLOSE  # the wanted point is at most this far along

    def contains(self, x: Number, y: Number) -> np.ndarray:
        """Return true for every place; see `Terrain`."""
        return within(self.extent, x, y)

    def height(self, x: Number, y: Number) -> np.ndarray:
        """Return z [m] at `x`, `y`; see `Terrain`."""
        down, up, _, _ = self.slope_coordinates(x, y)
        return np.asarray(up * self._cos - down * self._sin)[()]

    def gradient(self, x: Number, y: Number) -> np.ndarray:
        """Return (dz/dx, dz/dy) (..., 2); see `Terrain`."""
        _, _, along, across = self.slope_coordinates(x, y)
        scale = 1.0 / (self._cos + along * self._sin)
        slopes = ((along * self._cos - self._sin) * scale, across * scale)
        return np.array(slopes) if is_number(scale) else np.stack(slopes, axis=-1)

    def normal(self, x: Number, y: Number) -> np.ndarray:
        """Return unit normals (..., 3); see `Terrain`."""
        _, _, along, across = self.slope_coordinates(x, y)
        scale = (1.0 + along * along + across * across) ** -0.5
        outward, upward = self._sin - along * self._cos, self._cos + along * self._sin
        parts = (outward * scale, -across * scale, upward * scale)
        return np.array(parts) if is_number(scale) else np.stack(parts, axis=-1)

    def slope_coordinates(self, x: Number, y: Number) -> tuple[Number, Number, Number, Number]:
        """Return the distance down the slope and the height over it [m], and that height's slopes down and left."""
        if is_number(x) and is_number(y):
            return self._solve(float(x), float(y))
        return self._solve_many(*paired(x, y))

    def _solve(self, x: float, y: float) -> tuple[float, float, float, float]:
        if not math.isfinite(x + y):
            return math.nan, math.nan, math.nan, math.nan
        cos, sin = self._cos, self._sin
        down = x / cos
        low, high = down - self._move, down + self._move
        while True:
            up, along, across = self.relief.at(down, y)
            off = down * cos + up * sin - x
            low, high = (low, down) if off > 0.0 else (down, high)
            step = off / (cos + along * sin)
            if abs(step) < _CLOSE * (1.0 + abs(down)) or high - low < _CLOSE * (1.0 + abs(down)):
                return down, up, along, across
            down = down - step if low < down - step < high else 0.5 * (low + high)

    def _solve_many(self, x: np.ndarray, y: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        cos, sin = self._cos, self._sin
        down = x / cos
        low, high = down - self._move, down + self._move
        while True:
            up, along, across = self.relief.over(down, y)
            off = down * cos + up * sin - x
            low, high = np.where(off > 0.0, low, down), np.where(off > 0.0, down, high)
            step = off / (cos + along * sin)
            close = _CLOSE * (1.0 + np.abs(down))
            done = (np.abs(step) < close) | (high - low < close) | ~np.isfinite(step)
            if np.all(done):
                return down, up, along, across
            guess = down - step
            guess = np.where((guess > low) & (guess < high), guess, 0.5 * (low + high))
            down = np.where(done, down, guess)
