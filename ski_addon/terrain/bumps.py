"""A train of bumps across the fall line: arcs of circles with filleted joints [SG19 sec 4.6, Eq. 16].

Crests and troughs alternate, each an arc of chord `width` and height `height`, so that one wave is two widths long
and the ground goes up and down by twice the height. Neighbouring arcs share their tangent but not their curvature;
an odd polynomial of fifth order blends them (the fillet), so that the curvature is continuous. The arcs outside the
fillets stay what Eq. 16 says. From the plane to the first crest, and from the last one back, leads a gentle ramp
one width long.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from .terrain import One


def bump_radius(height: float, width: float) -> float:
    """Return the radius [m] of an arc of `height` over a chord of `width` [m] [SG19 Eq. 16]."""
    return 0.5 * height + width * width / (8.0 * height)


def bump_angle(height: float, width: float) -> float:
    """Return the angle [rad] between chord and arc at the arc's ends; 90 degrees for a half circle."""
    return 2.0 * math.atan(2.0 * height / width)


@dataclass(frozen=True)
class BumpTrain:
    """A relief (see `Relief`) of `count` crests with troughs between them, the same at every place across.

    `height` and `width` [m] of an arc over its chord (`height` less than half of `width`), `start` [m] down the
    slope where the first ramp begins, `fillet` the share of `width` over which two arcs are blended.
    """

    count: int
    height: float
    width: float
    start: float
    fillet: float

    @cached_property
    def radius(self) -> float:
        """Radius [m] of crests and troughs."""
        return bump_radius(self.height, self.width)

    @property
    def reach(self) -> float:
        """Most height over or under the plane [m]."""
        return self.height

    @property
    def length(self) -> float:
        """Length of the whole train with its ramps [m], two widths for each crest."""
        return 2.0 * self.width * self.count

    @cached_property
    def steepest(self) -> float:
        """Steepest slope, as rise over run."""
        return float(np.max(np.abs(self._half_wave[0])))

    @cached_property
    def sharpest(self) -> float:
        """Smallest radius of curvature [m] anywhere; the fillets bend up to a sixth more than the arcs."""
        slope, bend = self._half_wave
        return float(np.min((1.0 + slope * slope) ** 1.5 / np.maximum(np.abs(bend), 1e-12)))

    def crests(self) -> np.ndarray:
        """Return the distances down the slope (count,) [m] of the crests."""
        return self.start + self.width * (1.0 + 2.0 * np.arange(self.count))

    def troughs(self) -> np.ndarray:
        """Return the distances down the slope (count - 1,) [m] of the troughs."""
        return self.crests()[:-1] + self.width

    def at(self, down: float, left: float) -> tuple[float, float, float]:
        """Return height and slopes at one place; see `Relief`."""
        up, slope, _ = self.profile_at(down)
        return up, slope, 0.0

    def over(self, down: np.ndarray, left: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return heights and slopes at many places; see `Relief`."""
        up, slope, _ = self.profile(down)
        return up, slope, np.zeros_like(up)

    def profile_at(self, down: float) -> tuple[float, float, float]:
        """Return height [m], slope and second derivative [1/m] of the profile at one distance `down` the slope [m]."""
        place = (down - self.start) / self.width - 1.0  # in arcs, 0 at the first crest
        arc = min(max(round(place), 0), self._last_arc)
        offset = (place - arc) * self.width
        from_top = abs(offset)
        if place < 0.0 or place > self._last_arc:
            up, slope, bend = self._ramp(min(from_top, self.width))
        elif from_top <= self._arc_end:
            up, slope, bend = self._arc(from_top)
        else:
            up, slope, bend = self._fillet(0.5 * self.width - from_top)
        sign = 1.0 - 2.0 * (arc % 2)
        return sign * up, sign * math.copysign(slope, slope * offset), sign * bend

    def profile(self, down: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the same at many distances `down` (...) [m]: three arrays (...)."""
        place = (np.asarray(down, dtype=float) - self.start) / self.width - 1.0
        arc = np.clip(np.round(place), 0, self._last_arc)
        offset = (place - arc) * self.width
        from_top = np.abs(offset)
        outside, in_arc = (place < 0.0) | (place > self._last_arc), from_top <= self._arc_end
        ramp = self._ramp(np.minimum(from_top, self.width))
        arcs = self._arc(np.minimum(from_top, self._arc_end))
        fillet = self._fillet(0.5 * self.width - from_top)
        up, slope, bend = (
            np.where(outside, a, np.where(in_arc, b, c)) for a, b, c in zip(ramp, arcs, fillet, strict=True)
        )
        sign = 1.0 - 2.0 * (arc % 2)
        return sign * up, sign * np.where(offset < 0.0, -slope, slope), sign * bend

    @cached_property
    def _last_arc(self) -> int:
        return 2 * (self.count - 1)

    @cached_property
    def _arc_end(self) -> float:
        """Distance from the top at which the arc ends and the fillet begins [m]."""
        return 0.5 * self.width * (1.0 - self.fillet)

    @cached_property
    def _fillet_terms(self) -> tuple[float, float, float]:
        """Coefficients of u, u^3 and u^5 that continue the arc C2, u [m] from the joint; odd, as both sides mirror."""
        u = 0.5 * self.width - self._arc_end
        up, slope, bend = self._arc(self._arc_end)
        up, slope, bend = up / u, -slope, bend * u  # by u now
        fifth = (3.0 * (up - slope) + bend) / 8.0
        third = 0.5 * (slope - up) - 2.0 * fifth
        return up - third - fifth, third / u**2, fifth / u**4

    @cached_property
    def _ramp_terms(self) -> tuple[float, float, float]:
        """Coefficients of u^3, u^4 and u^5 from the plane (u = 0) to a crest of its full curvature (u = 1)."""
        bend = self.width**2 / self.radius
        return 10.0 * self.height - 0.5 * bend, bend - 15.0 * self.height, 6.0 * self.height - 0.5 * bend

    def _arc(self, from_top: One) -> tuple[One, One, One]:
        """Return height over the plane, slope outward and second derivative of a crest's arc."""
        root = (self.radius * self.radius - from_top * from_top) ** 0.5
        return root - (self.radius - self.height), -from_top / root, -(self.radius**2) / root**3

    def _fillet(self, u: One) -> tuple[One, One, One]:
        """Return the same on a crest's half of a fillet, `u` [m] from the joint."""
        first, third, fifth = self._fillet_terms
        square = u * u
        up = u * (first + square * (third + square * fifth))
        slope = -(first + square * (3.0 * third + 5.0 * square * fifth))
        return up, slope, u * (6.0 * third + 20.0 * square * fifth)

    def _ramp(self, from_top: One) -> tuple[One, One, One]:
        """Return the same on the ramp between the plane and a crest."""
        third, fourth, fifth = self._ramp_terms
        u = 1.0 - from_top / self.width
        up = u * u * u * (third + u * (fourth + u * fifth))
        slope = -u * u * (3.0 * third + u * (4.0 * fourth + 5.0 * u * fifth)) / self.width
        bend = u * (6.0 * third + u * (12.0 * fourth + 20.0 * u * fifth)) / self.width**2
        return up, slope, bend

    @cached_property
    def _half_wave(self) -> tuple[np.ndarray, np.ndarray]:
        """Slopes and second derivatives from the plane over a ramp and half an arc to the first joint."""
        return self.profile(self.start + np.linspace(0.0, 1.5, 3001) * self.width)[1:]
