"""The regulator against its own equation, and what it does to the skier it was made for."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.control.balance import Regulator, Weights, regulator_gains

OMEGAS = (2.5, 3.736, 5.5)
WEIGHTS = Weights()


def plant(omega: float) -> tuple[np.ndarray, np.ndarray]:
    """Rates of (xi, E, E', a) from the state and from (s, j)."""
    A, B = np.zeros((4, 4)), np.zeros((4, 2))
    A[0, 0], A[0, 1], A[1, 2], A[2, 3] = omega, -omega, 1.0, 1.0
    B[0, 0], B[3, 1] = -omega, 1.0
    return A, B


def feedback(omega: float) -> np.ndarray:
    """The gains on (xi, E, E', a) instead of (xi - E, E, E', a)."""
    gains = regulator_gains(omega, WEIGHTS).copy()
    gains[:, 1] -= gains[:, 0]
    return gains


@pytest.mark.parametrize("omega", OMEGAS)
def test_the_motion_comes_to_rest_on_the_line(omega):
    A, B = plant(omega)
    poles = np.linalg.eigvals(A + B @ feedback(omega))
    assert poles.real.max() < -0.8


@pytest.mark.parametrize("omega", OMEGAS)
def test_no_other_gains_cost_less(omega):
    """The cost of the whole return from several starts, by Lyapunov's equation; gains changed in any direction."""
    from scipy.linalg import solve_continuous_lyapunov

    A, B = plant(omega)
    lead = np.array([1.0, -1.0, 0.0, 0.0])
    Q = WEIGHTS.lead * np.outer(lead, lead) + np.diag([0.0, WEIGHTS.offset, WEIGHTS.offset_rate, WEIGHTS.acceleration])
    R = np.diag([WEIGHTS.shift, WEIGHTS.jerk])

    def cost(K: np.ndarray) -> float:
        return float(np.trace(solve_continuous_lyapunov((A + B @ K).T, -(Q + K.T @ R @ K))))

    best, rng = feedback(omega), np.random.default_rng(0)
    for _ in range(20):
        assert cost(best * (1.0 + 0.02 * rng.normal(size=best.shape))) > cost(best)


def test_gains_of_a_standing_skier():
    """omega = 3.736 1/s, the numbers that were found to survive pushes of 200 N."""
    gains = regulator_gains(3.736, WEIGHTS)
    np.testing.assert_allclose(gains[0, :3], [1.072, 0.292, -0.082], atol=5e-4)
    np.testing.assert_allclose(gains[1], [2444.0, -52.0, -498.0, -53.3], rtol=1e-3)


@pytest.mark.parametrize("omega", [2.0, 2.13, 3.7361, 5.49, 8.0])
def test_the_table_answers_as_the_equation_does(omega):
    state = (0.3, 0.1, -0.2, -1.3)
    expected = regulator_gains(omega, WEIGHTS) @ state
    np.testing.assert_allclose(Regulator().respond(omega, state), expected, rtol=2e-3)


@pytest.mark.parametrize("omega", [0.5, 40.0])
def test_beyond_the_table_its_ends_hold(omega):
    end = Regulator.SLOWEST if omega < 1.0 else Regulator.FASTEST
    expected = regulator_gains(end, WEIGHTS) @ (0.1, 0.0, 0.0, 0.0)
    np.testing.assert_allclose(Regulator().respond(omega, (0.1, 0.0, 0.0, 0.0)), expected, rtol=0.01)


def test_mirrored_states_get_mirrored_answers_and_rest_gets_none():
    regulator = Regulator()
    shift, jerk = regulator.respond(4.0, (0.1, -0.3, 0.5, 2.0))
    assert regulator.respond(4.0, (-0.1, 0.3, -0.5, -2.0)) == (-shift, -jerk)
    assert regulator.respond(4.0, (0.0, 0.0, 0.0, 0.0)) == (0.0, 0.0)
