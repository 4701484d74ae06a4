"""A field of moguls: crests and troughs in rows and columns, neighbouring columns offset by half.

The height over the plane is a product of two cosines, one down the slope and one across. Column 0 runs down the
middle (left = 0) with a crest every `spacing` and a trough half-way between; the columns beside it, `across` away,
have their crests where it has troughs. Half-way between two columns the ground stays on the plane.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .terrain import One


@dataclass(frozen=True)
class MogulField:
    """A relief (see `Relief`) of `count` crests down each even column, endless to the sides.

    `height` from trough to crest, `spacing` down a column, `across` between columns, `start` down the slope where the
    field begins to rise out of the plane [m]; the first crest of column 0 is one spacing further. Over the last
    spacing behind the last crest it sinks back.
    """

    count: int
    height: float
    spacing: float
    across: float
    start: float

    @property
    def reach(self) -> float:
        """Most height over or under the plane [m]."""
        return 0.5 * self.height

    @property
    def length(self) -> float:
        """Length of the whole field with its two ends [m]."""
        return (self.count + 1) * self.spacing

    @property
    def radius(self) -> float:
        """Radius of curvature [m] of crests and troughs along the fall line, the smallest on that line."""
        return 1.0 / (self.reach * self._along**2)

    @cached_property
    def steepest(self) -> float:
        """Steepest slope along the fall line, as rise over run; it is in a joint or where the field begins."""
        down = self.start + np.linspace(0.0, 2.0 * self.spacing, 2001)
        return float(np.max(np.abs(self.over(down, np.zeros_like(down))[1])))

    def crests(self, half_width: float) -> np.ndarray:
        """Return the crests (m, 2) (down, left) [m] of full height within `half_width` of the middle, by columns."""
        return self._places(half_width, 0)

    def troughs(self, half_width: float) -> np.ndarray:
        """Return the troughs (m, 2) (down, left) [m] of full depth within `half_width` of the middle, by columns."""
        return self._places(half_width, 1)

    def at(self, down: float, left: float) -> tuple[float, float, float]:
        """Return height and slopes at one place; see `Relief`."""
        share, rise = self._share(min(max(self._from_end(down), 0.0), 1.0))
        phase, side = self._along * (down - self.start), self._aside * left
        waves = math.cos(phase), math.sin(phase), math.cos(side), math.sin(side)
        return self._product(share, math.copysign(rise, self._middle - down), *waves)

    def over(self, down: np.ndarray, left: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return heights and slopes at many places; see `Relief`."""
        share, rise = self._share(np.clip(self._from_end(down), 0.0, 1.0))
        phase, side = self._along * (down - self.start), self._aside * left
        waves = np.cos(phase), np.sin(phase), np.cos(side), np.sin(side)
        return self._product(share, np.copysign(rise, self._middle - down), *waves)

    def _product(self, share: One, rise: One, cos: One, sin: One, cos_side: One, sin_side: One) -> tuple[One, One, One]:
        """Return height and slopes of the two waves where `share` of the full height is there, growing by `rise`."""
        up = self.reach * share * cos
        slope = self.reach * (rise * cos - share * self._along * sin)
        return up * cos_side, slope * cos_side, -self._aside * up * sin_side

    def _from_end(self, down: One) -> One:
        """Return the distance from the nearer end of the field, in spacings."""
        return (0.5 * self.length - abs(down - self._middle)) / self.spacing

    def _share(self, inside: One) -> tuple[One, One]:
        """Return the share of the full height `inside` (0..1) spacings from the end, and its growth inward [1/m]."""
        share = inside**3 * (10.0 - inside * (15.0 - 6.0 * inside))
        return share, 30.0 * (inside * (1.0 - inside)) ** 2 / self.spacing

    def _places(self, half_width: float, first: int) -> np.ndarray:
        """Return the extremes (m, 2) of columns; `first` is 0 for crests and 1 for troughs, which lie half on."""
        columns = math.floor(half_width / self.across + 1e-9)
        found = [np.zeros((0, 2))]
        for column in range(-columns, columns + 1):
            shifted = (column + first) % 2
            down = self.start + self.spacing * (1.0 + 0.5 * shifted + np.arange(self.count - shifted))
            found.append(np.column_stack((down, np.full_like(down, column * self.across))))
        return np.concatenate(found)

    @cached_property
    def _middle(self) -> float:
        return self.start + 0.5 * self.length

    @cached_property
    def _along(self) -> float:
        return 2.0 * math.pi / self.spacing

    @cached_property
    def _aside(self) -> float:
        return math.pi / self.across
