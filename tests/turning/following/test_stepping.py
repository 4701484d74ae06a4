from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.turning.body import TurningBody, support_speed
from ski_addon.turning.following.stepping import CURVATURE, HEADING, LEAN, LEAN_RATE, motion_after

BODY = TurningBody(leg_length=1.1, inertia=0.08)
STATE = np.array([[1.0, -2.0, 0.3, 0.15, -0.1, 0.04], [0.0, 0.0, -0.4, -0.2, 0.3, -0.05]]).T
RATE, SPEED = np.array([0.2, -0.3]), np.array([8.0, 6.0])
NORMAL, PULL = np.full(2, 9.6), np.array([(1.9, 0.2), (1.9, 0.0)])


def fine(pull: np.ndarray | None, duration: float, count: int = 6000) -> np.ndarray:
    """The same by tiny steps of the midpoint rule."""
    step = duration / count

    def rates(state: np.ndarray) -> np.ndarray:
        _, _, heading, lean, lean_rate, curvature = state
        across = 0.0 if pull is None else pull[:, 1] * np.cos(heading) - pull[:, 0] * np.sin(heading)
        pace = support_speed(lean, curvature, SPEED, BODY.leg_length)
        acceleration = BODY.lean_acceleration(lean, curvature, SPEED, NORMAL, across)
        return np.stack(
            (pace * np.cos(heading), pace * np.sin(heading), pace * curvature, lean_rate, acceleration, RATE)
        )

    state = STATE.copy()
    for _ in range(count):
        state = state + step * rates(state + 0.5 * step * rates(state))
    return state


def test_stage_of_three_samples_is_the_motion_of_tiny_steps():
    states = motion_after(BODY, STATE, RATE, 0.1, 3, SPEED, NORMAL, None)
    assert states.shape == (3, 6, 2)
    assert states[-1] == pytest.approx(fine(None, 0.3), abs=5e-5)
    assert states[0] == pytest.approx(fine(None, 0.1), abs=5e-5)


def test_stage_on_a_slope_is_the_motion_of_tiny_steps():
    states = motion_after(BODY, STATE, RATE, 0.1, 3, SPEED, NORMAL, PULL)
    # gravity is taken along the heading of a support as fast as the centre of mass
    assert states[-1] == pytest.approx(fine(PULL, 0.3), abs=2e-3)


def test_order_of_the_method_is_four():
    exact = fine(None, 0.6, 20000)
    errors = []
    for count in (3, 6):
        state = motion_after(BODY, STATE, RATE, 0.6 / count, count, SPEED, NORMAL, None)[-1]
        errors.append(np.abs(state - exact)[[HEADING, LEAN, LEAN_RATE]].max())
    assert errors[0] / errors[1] > 10.0


def test_upright_body_on_level_ground_runs_straight_on_and_curvature_is_the_integral_of_its_rate():
    still = np.array([[0.0], [0.0], [math.pi / 2], [0.0], [0.0], [0.0]])
    states = motion_after(BODY, still, np.zeros(1), 0.1, 3, SPEED[:1], NORMAL[:1], None)
    assert states[-1, :, 0] == pytest.approx([0.0, 2.4, math.pi / 2, 0, 0, 0], abs=1e-12)
    bent = motion_after(BODY, STATE, RATE, 0.1, 3, SPEED, NORMAL, None)
    assert bent[:, CURVATURE] == pytest.approx(STATE[CURVATURE] + np.array([[0.1], [0.2], [0.3]]) * RATE)
