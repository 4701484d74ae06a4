"""The skis' way off their planned line: steered under the body, within what skis can do, and back.

[VP93] keeps a body that leans on a moving edge from falling by turning the edge under it. Here the regulator decides
how, and this state integrates the line: E, E' and a = E'' to the left of the planned line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from .regulator import Regulator

TIGHTEST = 0.35
"""Most curvature of the steered line [1/m]: turns of 3 m, skidded."""
MOST_ACCELERATION = 12.0
"""Most sideways acceleration of the skis [m/s^2]; more only where the plan has more."""
SPARE_ACCELERATION = 3.0
"""Sideways acceleration [m/s^2] kept for steering on top of what a hard turn of the plan takes."""
FASTEST_TURNING = 3.0
"""Most turning speed of the skis [rad/s]."""
MOST_JERK = 150.0
"""Most change of the sideways acceleration [m/s^3]: at 5 m/s from straight to the tightest turn in 40 ms."""
REJOIN_FROM = 0.434
"""Offset [m] beyond which the wish to be back on the line grows no more: it must never outvote balance."""
REJOIN_SPEED, REJOIN_MOST = 5.0, 1.4
"""Up to this speed [m/s]; faster skis come back at the same angle, up to this many times as far off."""


@dataclass(frozen=True)
class Reach:
    """What can be done at one moment: the load's middle `right`..`left` of the skis' [m] (right is negative), the
    skis' sideways acceleration `slowest`..`fastest` [m/s^2]; `speed` of the skis [m/s].
    """

    right: float
    left: float
    slowest: float
    fastest: float
    speed: float


def acceleration_bounds(speed: float, centripetal: float) -> tuple[float, float]:
    """Return the least and the greatest a [m/s^2] at `speed` [m/s].

    `centripetal` [m/s^2] is what the planned curve itself takes, positive to the left; the bounds widen
    to what the plan has.
    """
    planned = abs(centripetal)
    most = max(MOST_ACCELERATION, planned + SPARE_ACCELERATION)
    most = min(most, TIGHTEST * speed * speed, FASTEST_TURNING * speed)
    most = max(most, planned)
    return -most - centripetal, most - centripetal


class Steering:
    """State of the line: `offset` E [m], `rate` E' [m/s], `acceleration` a [m/s^2], and the inputs of the last
    `update`: `shift` s [m] and `jerk` j [m/s^3].
    """

    STATE = ("offset", "rate", "acceleration")

    def __init__(self, regulator: Regulator, time_step: float) -> None:
        """Start on the planned line; `advance` moves on by `time_step` [s]."""
        self._regulator, self._step = regulator, time_step
        self.offset = self.rate = self.acceleration = 0.0
        self.shift = self.jerk = 0.0

    def update(self, divergent: float, omega: float, reach: Reach) -> None:
        """Decide `shift` and `jerk` for the divergent component `divergent` [m], measured from the planned line."""
        most = REJOIN_FROM * min(max(reach.speed / REJOIN_SPEED, 1.0), REJOIN_MOST)
        rejoin = min(max(self.offset, -most), most)
        state = (divergent - self.offset, rejoin, self.rate, self.acceleration)
        shift, jerk = self._regulator.respond(omega, state)
        self.shift = min(max(shift, reach.right), reach.left)
        self.jerk = min(max(jerk, -MOST_JERK), MOST_JERK)
        wanted = self.acceleration + self.jerk * self._step
        wanted = min(max(wanted, reach.slowest), reach.fastest)
        self.jerk = (wanted - self.acceleration) / self._step
        self.jerk = min(max(self.jerk, -2.0 * MOST_JERK), 2.0 * MOST_JERK)

    def advance(self) -> None:
        """Move on by one step."""
        step = self._step
        self.acceleration += self.jerk * step
        self.rate += self.acceleration * step
        self.offset += self.rate * step

    def capture_margin(self, divergent: float, omega: float, reach: Reach) -> float:
        """Return how far [m] the divergent component is from what steering and load shift can still catch.

        It can be caught from the left when xi < s_left + omega int e^(-omega t) E dt with E steered to the left as hard
        and as fast as can be; positive: it can be caught.
        """
        ahead = self.offset + self.rate / omega
        left = ahead + reach.left + self._swing(reach.fastest, omega)
        right = ahead + reach.right + self._swing(reach.slowest, omega)
        return min(left - divergent, divergent - right)

    def _swing(self, target: float, omega: float) -> float:
        """Return omega int e^(-omega t) of the offset that a gains, going to `target` at the greatest jerk [m]."""
        change = target - self.acceleration
        jerk = math.copysign(MOST_JERK, change)
        ramp = 1.0 - math.exp(-omega * change / jerk)
        return (self.acceleration + jerk / omega * ramp) / (omega * omega)
