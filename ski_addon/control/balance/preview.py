"""What the plan's near future asks of a skier who is faster or slower than planned.

At `rate` planned seconds a second the plan's curves are passed at another speed: centripetal accelerations grow with
rate^2, gravity's share does not. With P the sideways acceleration that the planned lean gives (gravity and the
pendulum), a body on the planned line is pulled to the side by (1 - rate^2) P. Of all the motions that answer this pull
one stays bounded; its divergent component is what the skier has to be at now,

    xi_ref = -int_0^inf exp(-int_0^t omega) (1 - rate^2) P / omega dt,

so that a fast skier leans more before a turn comes, not in it. One whose skis are E off their line in a curve goes
round in a smaller or a larger circle, which pulls by (rate spin)^2 E more, with the spin of the planned skis. The pendulum's omega changes along the plan with load
and height; with omega' = omega^2 - (N / h + spin^2) the divergent component xi = y + y' / omega separates exactly.
"""

from __future__ import annotations

import math

import numpy as np

from ...gravity import GRAVITY, STANDARD_GRAVITY
from ...planning import MotionPlan

STEP = 0.01
"""Planned time between entries of the table [s]."""
RATES = (0.25, 0.4, 0.6, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.0)
"""Rates of progress in the table."""


class Preview:
    """Tables along a plan: `omega` [1/s] of its pendulum and the divergent component it wants at any rate."""

    def __init__(self, plan: MotionPlan) -> None:
        """Integrate both backwards from the plan's end."""
        count = max(int(math.ceil(plan.duration / STEP)), 1) + 1
        time = np.linspace(0.0, plan.duration, count)
        stiffness, pull, square = (np.interp(time, plan.time, values) for values in _pendulum(plan))
        step = float(time[1] - time[0])
        self.omega = _divergent_rate(stiffness, step)
        pulls = np.stack((pull, square))
        self.table = np.stack([_bounded_answer(pulls, self.omega, step, rate) for rate in RATES])  # (k, 2, n)
        self._per_second = 1.0 / step
        self._last = count - 1.001
        self._omega: list[float] = self.omega.tolist()
        self._table: list[list[list[float]]] = self.table.tolist()

    def at(self, progress: float, rate: float, offset: float) -> tuple[float, float]:
        """Return (omega [1/s], xi_ref [m]) for a skier `progress` [s] into the plan who passes it at `rate` with the skis
        `offset` [m] to the left of their line.
        """
        place = min(max(progress * self._per_second, 0.0), self._last)
        i = int(place)
        x = place - i
        k = 0
        while k < len(RATES) - 2 and rate > RATES[k + 1]:
            k += 1
        u = min(max((rate - RATES[k]) / (RATES[k + 1] - RATES[k]), 0.0), 1.0)
        answers = []
        for slow, fast in zip(self._table[k], self._table[k + 1], strict=True):
            low = slow[i] + x * (slow[i + 1] - slow[i])
            high = fast[i] + x * (fast[i + 1] - fast[i])
            answers.append(low + u * (high - low))
        omega = self._omega[i] + x * (self._omega[i + 1] - self._omega[i])
        square = rate * rate
        return omega, (1.0 - square) * answers[0] + square * offset * answers[1]


def _pendulum(plan: MotionPlan) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the plan's pendulum stiffness N / h + spin^2 [1/s^2], sideways pull P [m/s^2] and spin^2, all (n,)."""
    left, up = plan.ski_frame[..., 1], plan.ski_frame[..., 2]
    over = plan.com - plan.position
    y, h = np.sum(over * left, axis=1), np.sum(over * up, axis=1)
    normal = np.maximum(plan.load, 0.05) * STANDARD_GRAVITY / np.maximum(h, 0.1)
    square = (plan.curvature * plan.speed) ** 2
    return normal + square, normal * y + left @ GRAVITY, square


def _divergent_rate(stiffness: np.ndarray, step: float) -> np.ndarray:
    """Return the omega (n,) that solves omega' = omega^2 - stiffness and stays bounded."""
    out = np.empty_like(stiffness)
    out[-1] = omega = math.sqrt(stiffness[-1])
    for i in range(len(out) - 2, -1, -1):
        steady = math.sqrt(0.5 * (stiffness[i] + stiffness[i + 1]))
        lag = math.tanh(steady * step)  # exact for constant stiffness
        omega = steady * (omega + steady * lag) / (steady + omega * lag)
        out[i] = omega
    return out


def _bounded_answer(pull: np.ndarray, omega: np.ndarray, step: float, rate: float) -> np.ndarray:
    """Return the bounded xi (..., n) [m] of xi' = omega xi + pull / omega for `pull` (..., n), at `rate` along
    the table."""
    out = np.empty_like(pull)
    steady = -pull / omega**2
    out[..., -1] = xi = steady[..., -1]
    for i in range(len(omega) - 2, -1, -1):
        middle = 0.5 * (steady[..., i] + steady[..., i + 1])
        fade = math.exp(-0.5 * (omega[i] + omega[i + 1]) * step / rate)
        xi = middle + (xi - middle) * fade
        out[..., i] = xi
    return out
