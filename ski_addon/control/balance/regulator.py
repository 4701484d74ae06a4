"""How strongly to steer and to shift the load: a linear-quadratic regulator of the skier's divergent motion.

A skier over moving skis is an inverted pendulum. What can be lost of its sideways motion is one number, the divergent
component xi = y + y'/omega: unless the support is put under it, it grows as e^(omega t). With E the sideways offset of
the skis, s the offset of the load's middle (zero-moment point) from the middle of the skis and j the rate of the skis'
sideways acceleration a,

    xi' = omega (xi - E - s),     E'' = a,     a' = j.

The regulator weighs where the body is over the skis (xi - E), how far and fast the skis are off their line, and the
two inputs. It answers with s at once and with j as fast as a person can turn skis.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Weights:
    """Weights of the regulator, per squared unit: of the lead xi - E [m], of E [m], E' [m/s] and a [m/s^2], and of the
    inputs s [m] and j [m/s^3]. The ratio of the last two makes a skier shift his load first and turn his skis next.
    """

    lead: float = 0.063
    offset: float = 5.16
    offset_rate: float = 0.257
    acceleration: float = 0.0186
    shift: float = 60.0
    jerk: float = 1e-5


def regulator_gains(omega: float, weights: Weights) -> np.ndarray:
    """Return K (2, 4) with (s, j) = K (xi - E, E, E', a) for a pendulum of `omega` [1/s]."""
    from scipy.linalg import solve_continuous_are

    dynamics = np.zeros((4, 4))  # of (xi, E, E', a)
    dynamics[0, :2] = omega, -omega
    dynamics[1, 2] = dynamics[2, 3] = 1.0
    inputs = np.zeros((4, 2))
    inputs[0, 0], inputs[3, 1] = -omega, 1.0
    lead = np.array([1.0, -1.0, 0.0, 0.0])
    cost = weights.lead * np.outer(lead, lead) + np.diag(
        [0.0, weights.offset, weights.offset_rate, weights.acceleration]
    )
    input_cost = np.diag([weights.shift, weights.jerk])
    value = solve_continuous_are(dynamics, inputs, cost, input_cost)
    by_state = -np.linalg.solve(input_cost, inputs.T @ value)
    by_lead = by_state.copy()
    by_lead[:, 1] += by_state[:, 0]  # K xi = K (xi - E) + K E
    return by_lead


class Regulator:
    """Gains for any omega, interpolated in a table that is made once."""

    SLOWEST, FASTEST, COUNT = 2.0, 8.0, 25

    def __init__(self, weights: Weights | None = None) -> None:
        """Solve the regulator on a grid of omega between `SLOWEST` and `FASTEST` [1/s]."""
        grid = np.linspace(self.SLOWEST, self.FASTEST, self.COUNT)
        table = [regulator_gains(float(omega), weights or Weights()).ravel() for omega in grid]
        self._table = [row.tolist() for row in table]
        self._per_rate = (self.COUNT - 1) / (self.FASTEST - self.SLOWEST)

    def respond(self, omega: float, state: tuple[float, float, float, float]) -> tuple[float, float]:
        """Return (s [m], j [m/s^3]) at `state` = (xi - E, E, E', a)."""
        place = min(max((omega - self.SLOWEST) * self._per_rate, 0.0), self.COUNT - 1.001)
        i = int(place)
        x = place - i
        low, high = self._table[i], self._table[i + 1]
        lead, offset, rate, acceleration = state

        def row(k: int) -> float:
            a = low[k] * lead + low[k + 1] * offset + low[k + 2] * rate + low[k + 3] * acceleration
            b = high[k] * lead + high[k + 1] * offset + high[k + 2] * rate + high[k + 3] * acceleration
            return a + x * (b - a)

        return row(0), row(4)
