"""How fast a body goes that swings down a slope: gravity, friction and drag, and braking to a speed by skidding."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from ..planning.ride_steps import AIM, CONTROL_TIME, LEAST_SIDE_FORCE
from .numbers import ARRAYS, Numbers


@dataclass(frozen=True)
class Pace:
    """Where gravity acts and what brakes; numbers, or arrays (m,) of one for each body.

    `gravity_normal`, `gravity_down` [m/s^2] into the slope and down its fall line; `friction`,
    `friction_per_speed` [s/m] and `drag` [1/m] as of `Snow`; `most` [m/s] is the speed to hold, `skid` [rad] the
    largest angle between skis and path; a `held` body keeps its start speed whatever acts on it.
    """

    gravity_normal: Any = 9.81
    gravity_down: Any = 0.0
    friction: Any = 0.0
    friction_per_speed: Any = 0.0
    drag: Any = 0.0
    most: Any = math.inf
    skid: Any = math.radians(35.0)
    held: bool = False

    def acceleration(self, speed: Any, along: Any, side: Any, numbers: Numbers = ARRAYS) -> Any:
        """Return v' [m/s^2] with gravity's part `along` the path and the ground's force to the `side` per mass [m/s^2].

        As the plan does (`planning.ride`): skis that are turned out of the path brake with a part of the side force.
        """
        glide = along - (self.friction + self.friction_per_speed * speed) * self.gravity_normal
        glide = glide - self.drag * speed * speed
        if self._unlimited:
            return glide
        asked = numbers.most(glide + (speed - AIM * self.most) / CONTROL_TIME, 0.0)
        square = side * side
        skidding = asked * square / (square + LEAST_SIDE_FORCE * LEAST_SIDE_FORCE)
        return glide - numbers.least(skidding, numbers.most(side, -side) * numbers.tan(self.skid))

    @property
    def _unlimited(self) -> bool:
        return isinstance(self.most, float) and math.isinf(self.most)
