"""What the plan's near future asks of a skier who is faster or slower than planned, or off the line.

At `rate` planned seconds a second the plan's curves are passed at another speed: they take rate^2 times the planned
sideways acceleration P, while the planned lean still gives P, so that a body on the planned line is pulled to the side
by (1 - rate^2) P. Skis that are E off their line in a curve go round in a smaller or larger circle, which pulls by
(rate spin)^2 E, with the spin of the planned skis. Of all motions that answer a pull p one stays bounded; its divergent
component is where the skier has to be now,

    xi_ref(t) = -int_t^inf exp(-int_t^s omega) p / omega ds,

so that a fast skier leans more before a turn comes, not in it. The pendulum's omega changes along the plan with load
and height; where omega' = omega^2 - (N / h + spin^2) the divergent component xi = y + y' / omega separates exactly.
"""

from __future__ import annotations

import math

import numpy as np

from ...gravity import STANDARD_GRAVITY
from ...planning import Reference

LEAST_LOAD = 0.05
"""Load [skier's weights] below which a plan's pendulum is not reckoned with."""
STEP = 0.01
"""Planned time between entries of the table [s]."""
RATES = (0.25, 0.4, 0.6, 0.8, 1.0, 1.25, 1.6, 2.0, 2.5, 3.0)
"""Rates of progress in the table."""


class Preview:
    """Tables along a plan: `omega` [1/s] of its pendulum and the divergent component it wants at any rate."""

    def __init__(self, reference: Reference) -> None:
        """Integrate both backwards from the plan's end."""
        count = max(math.ceil(reference.end / STEP), 1) + 1
        time = np.linspace(0.0, reference.end, count)
        stiffness, *pulls = _pendulum(reference, time)
        step = float(time[1] - time[0])
        self.omega = _divergent_rate(stiffness, step)
        self.table = np.stack([_bounded_answer(np.stack(pulls), self.omega, step, rate) for rate in RATES])  # (k, 2, n)
        self._per_second = 1.0 / step
        self._last = count - 1.001
        self._omega: list[float] = self.omega.tolist()
        self._table: list[list[list[float]]] = self.table.tolist()

    def at(self, progress: float, rate: float, offset: float) -> tuple[float, float]:
        """Return (omega [1/s], xi_ref [m]) for a skier `progress` [s] into the plan.

        The plan is passed at `rate` with the skis `offset` [m] to the left of their line.
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


def _pendulum(reference: Reference, time: np.ndarray) -> np.ndarray:
    """Return (3, n): the plan's pendulum stiffness N / h + spin^2 [1/s^2], sideways pull P [m/s^2] and spin^2."""
    columns = reference.columns
    samples = np.stack([reference.at(float(now)) for now in time], axis=1)  # (3, n, width)
    value, slope, bend = samples
    across, com = value[:, columns["across"]], columns["com"]
    height = np.sum((value[:, com] - value[:, columns["track_position"]]) * value[:, columns["normal"]], axis=1)
    load = np.maximum(value[:, columns["load"]][:, 0], LEAST_LOAD) * STANDARD_GRAVITY
    square = np.sum(slope[:, columns["along"]] * across, axis=1) ** 2
    return np.stack((load / np.maximum(height, 0.1) + square, np.sum(bend[:, com] * across, axis=1), square))


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
    """Return the bounded xi (..., n) [m] of xi' = omega xi + pull / omega for `pull` (..., n) passed at `rate`."""
    out = np.empty_like(pull)
    steady = -pull / omega**2
    out[..., -1] = xi = steady[..., -1]
    for i in range(len(omega) - 2, -1, -1):
        middle = 0.5 * (steady[..., i] + steady[..., i + 1])
        fade = math.exp(-0.5 * (omega[i] + omega[i + 1]) * step / rate)
        xi = middle + (xi - middle) * fade
        out[..., i] = xi
    return out


def lean_offset(even: float, y: float, h: float) -> float:
    """Return the sideways offset [m] off the planned `y` of a body on a leg of fixed length.

    `even` [m] is the offset of a pendulum of constant height `h` [m]: both have the same tangent of the lean.
    """
    whole = y + even
    return math.sqrt((y * y + h * h) / (whole * whole + h * h)) * whole - y
