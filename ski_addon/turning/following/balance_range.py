"""Which rates of curvature leave a body a way to stay up: the range that a stage may choose from.

The pendulum topples with the time constant 1 / w = sqrt(L / g), about as long as a stage, so that most inputs of an
even grid end in a fall some stages later. For small leans the body can be caught if and only if its unstable part

    z = lean + lean_rate / w

is matched by the steering to come: z = (V^2 / g) w * integral of exp(-w t) C(t) dt. The most that this can be is
reached by steering as quickly as allowed to the most curvature allowed, and likewise the least. A stage's rate
decides z and C at its end, and so the rates that lead to states that can be caught form an interval.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...frames import Array
from .problem import Problem
from .stepping import CURVATURE, HEADING, LEAN, LEAN_RATE, Bodies

SHARE = 0.92
"""Share of the range that is used: the rest is for what small angles leave out."""
_ROUNDS = 3


@dataclass(frozen=True)
class BalanceRange:
    """The ranges of one problem, by the samples of its lane (m,).

    `topple` w [1/s], `grip` V^2 / g [m] (the small lean that a curvature holds), `growth` of the unstable part in a
    stage, `effect` of a rate on it, and the `most` curvature [1/m] that the bounds of lean and curvature let hold.
    """

    problem: Problem
    topple: Array
    grip: Array
    growth: Array
    effect: Array
    most: Array

    @classmethod
    def of(cls, problem: Problem) -> BalanceRange:
        """Return the ranges of `problem`."""
        body, lane, settings = problem.body, problem.lane, problem.settings
        length = float(body.leg_length)
        topple = np.sqrt(lane.normal / (length + float(body.inertia) / length))
        grip = np.square(lane.speed) / lane.normal
        growth = np.exp(topple * settings.stage_time)
        effect = grip * (growth - 1.0 - topple * settings.stage_time) / topple
        most = np.minimum(math.tan(settings.lean_bound) / grip, problem.curvature_bound)
        return cls(problem, topple, grip, growth, effect, most)

    def rates(self, now: Bodies) -> tuple[Array, Array]:
        """Return the least and the most rate of curvature (n,) [1/m/s] of the next stage for bodies `now`.

        Where nothing can catch a body both are the rate that comes nearest to it.
        """
        at, curvature = now.nearest, now.state[CURVATURE]
        topple, grip, growth = self.topple[at], self.grip[at], self.growth[at]
        unstable = now.state[LEAN] + now.state[LEAN_RATE] / topple
        if self.problem.lane.tilted:
            pull, heading = self.problem.lane.pull[at], now.state[HEADING]
            across = pull[:, 1] * np.cos(heading) - pull[:, 0] * np.sin(heading)
            unstable = unstable + across / self.problem.lane.normal[at]
        coasting = growth * unstable - (growth - 1.0) * (grip * curvature)
        limit = self._limits(coasting, curvature, at, topple, grip)
        duration, bound = self.problem.settings.stage_time, self.problem.curvature_bound
        room = duration * self.problem.rate_bound
        floor = np.maximum(-bound - curvature, -room) / duration
        ceiling = np.minimum(bound - curvature, room) / duration
        low = np.minimum(np.maximum(limit[0], floor), ceiling)
        return low, np.maximum(np.minimum(np.maximum(-limit[1], floor), ceiling), low)

    def _limits(self, coasting: Array, curvature: Array, at: Array, topple: Array, grip: Array) -> Array:
        """Return the rates (2, n), the second with its sign changed, that leave the unstable part at the most that
        steering to the left, or to the right, can catch.

        Newton's method on coasting - effect * rate = SHARE * grip * (C + (r / w) (1 - exp(-w (C_most - C) / r))),
        C the curvature at the end of the stage; the right side grows with the rate, and ever less.
        """
        duration = self.problem.settings.stage_time
        quick = self.problem.rate_bound / topple
        coasting, curvature = np.stack((coasting, -coasting)), np.stack((curvature, -curvature))
        effect, most, grip = self.effect[at], self.most[at], SHARE * grip
        stretch, rate = grip * duration, np.zeros_like(curvature)
        for _ in range(_ROUNDS):
            end = curvature + duration * rate
            left = 1.0 - np.exp(np.minimum((end - most) / quick, 0.0))
            rate = rate + (coasting - effect * rate - grip * (end + quick * left)) / (effect + stretch * left)
        return np.asarray(rate)
