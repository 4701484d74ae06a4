"""The bounded lean over a known way."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.gravity import STANDARD_GRAVITY as G
from ski_addon.turning.balance import balanced_lean
from ski_addon.turning.body import TurningBody

STEP, SPEED = 0.01, 8.0
BODIES = [TurningBody(), TurningBody(leg_length=0.85, inertia=0.08)]


def lean_on(body: TurningBody, curvature: np.ndarray, across: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """The lean of a body whose support goes 8 m/s on flat ground."""
    pull = across - SPEED**2 * curvature
    return balanced_lean(body, STEP, pull, np.full_like(pull, G), SPEED * curvature)


@pytest.mark.parametrize("body", BODIES)
def test_steady_turn_leans_by_the_balance_of_forces(body):
    curvature = np.full(400, 0.07)
    lean, rate = lean_on(body, curvature)
    middle = 1.0 - 0.07 * body.leg_length * np.sin(lean)  # the body's circle is smaller than the support's
    np.testing.assert_allclose(np.tan(lean), SPEED**2 * 0.07 * middle / G, rtol=1e-8)
    assert np.abs(rate).max() < 1e-9


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("across", [0.0, 1.2])
def test_lean_obeys_the_pendulum(body, across):
    """Its second difference is what the forward dynamics say."""
    time = STEP * np.arange(900)
    curvature = 0.09 * np.sin(2.5 * time) * np.minimum(time, 1.0)
    lean, _ = lean_on(body, curvature, across)
    speed = SPEED * (1.0 - curvature * body.leg_length * np.sin(lean))  # of the centre of mass
    wanted = body.lean_acceleration(lean, curvature, speed, G, across)
    np.testing.assert_allclose(np.diff(lean, n=2) / STEP**2, wanted[1:-1], atol=1e-6)


def test_a_traverse_stands_upright_to_gravity():
    lean, _ = lean_on(TurningBody(), np.zeros(300), across=-1.3)
    np.testing.assert_allclose(lean, np.arctan(1.3 / G), atol=1e-9)


def test_lean_begins_before_the_turn_and_the_body_swings_the_other_way_never():
    """A step of curvature: the body is already leaning when it comes, by half of what the turn needs."""
    curvature = np.where(np.arange(1000) < 500, 0.0, 0.06)
    lean, _ = lean_on(TurningBody(), curvature)
    assert lean[500] == pytest.approx(0.5 * lean[-1], rel=0.05)
    assert lean.min() > -1e-9 and np.all(np.diff(lean) > -1e-9)


def test_mirrored_way_is_leaned_on_mirrored():
    curvature = 0.08 * np.sin(3.0 * STEP * np.arange(600)) + 0.02
    left, right = lean_on(BODIES[1], curvature, 0.6), lean_on(BODIES[1], -curvature, -0.6)
    np.testing.assert_allclose(left[0], -right[0], atol=1e-12)
    np.testing.assert_allclose(left[1], -right[1], atol=1e-12)
