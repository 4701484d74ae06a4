"""The pendulum on a steered support: both directions of its dynamics, force, and the paper's printed equation."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.gravity import STANDARD_GRAVITY as G
from ski_addon.turning.body import TurningBody, support_speed

BODIES = [TurningBody(), TurningBody(leg_length=0.9, inertia=0.12), TurningBody(leg_length=1.3, inertia=0.05)]


def states(seed: int = 1, n: int = 2000) -> tuple[np.ndarray, ...]:
    rng = np.random.default_rng(seed)
    return rng.uniform(-0.7, 0.7, n), rng.uniform(-2, 2, n), rng.uniform(-0.15, 0.15, n), rng.uniform(3, 15, n)


@pytest.mark.parametrize("body", BODIES)
@pytest.mark.parametrize("across", [0.0, 1.7])
def test_claim_1_forward_and_inverse_dynamics_are_inverses(body: TurningBody, across: float) -> None:
    lean, _, curvature, speed = states()
    acceleration = body.lean_acceleration(lean, curvature, speed, 9.6, across)
    np.testing.assert_allclose(body.curvature_for(lean, acceleration, speed, 9.6, across), curvature, atol=1e-12)


def test_claim_1_the_other_root_of_the_printed_quadratic_is_spurious() -> None:
    lean, acceleration, speed, body = np.deg2rad(17.2), 0.3, 6.0, TurningBody(leg_length=1.0)
    k = G * np.sin(lean) - acceleration * body.leg_length
    a = np.sin(lean) ** 2 * k + speed**2 * np.sin(lean) * np.cos(lean)
    b = -2 * np.sin(lean) * k - speed**2 * np.cos(lean)
    roots = sorted(np.roots([a, b, k]), key=abs)
    assert roots[0] == pytest.approx(body.curvature_for(lean, acceleration, speed), abs=1e-12)
    assert roots[1] == pytest.approx(1 / np.sin(lean), rel=1e-9)


def test_claim_2_upright_at_rest_goes_straight_on() -> None:
    with np.errstate(all="raise"):
        assert TurningBody().curvature_for(np.zeros(3), np.zeros(3), 8.0).tolist() == [0.0, 0.0, 0.0]


@pytest.mark.parametrize("body", BODIES)
def test_force_moves_the_centre_of_mass_of_an_integrated_path(body: TurningBody) -> None:
    """Newton's law on positions differentiated twice: says the same as the equations of Appendix A."""
    dt, speed, across = 1e-4, 7.0, 1.1
    x, y, heading, lean, rate = 0.0, 0.0, 0.2, 0.1, 0.3
    places, forces, lefts = [], [], []
    for step in range(400):
        curvature = 0.06 + 0.05 * np.sin(3.0 * step * dt)
        left = np.array([-np.sin(heading), np.cos(heading)])
        places.append(np.array([x, y, 0.0]) + body.leg_length * np.array([*(left * np.sin(lean)), np.cos(lean)]))
        forces.append(body.leg_force(lean, rate, curvature, speed, 9.5, across))
        lefts.append(left)
        support = support_speed(lean, curvature, speed, body.leg_length)
        x, y = x + dt * support * np.cos(heading), y + dt * support * np.sin(heading)
        acceleration = body.lean_acceleration(lean, curvature, speed, 9.5, across)
        heading, lean, rate = heading + dt * support * curvature, lean + dt * rate, rate + dt * acceleration
    acceleration = np.diff(places, n=2, axis=0)[100:300] / dt**2
    measured = np.stack(
        (np.einsum("ij,ij->i", acceleration[:, :2], np.array(lefts)[101:301]) - across, acceleration[:, 2] + 9.5), 1
    )
    np.testing.assert_allclose(measured, np.array(forces)[101:301], atol=0.03)


def test_force_of_a_point_mass_lies_along_the_leg() -> None:
    lean, rate, curvature, speed = states()
    left, up = TurningBody().leg_force(lean, rate, curvature, speed)
    np.testing.assert_allclose(left * np.cos(lean), up * np.sin(lean), atol=1e-9)


def test_tilting_gravity_is_tilting_the_lean() -> None:
    """Gravity across the path by an angle is flat ground seen from a frame turned by it."""
    tilt, body = 0.2, TurningBody()
    lean = np.linspace(-0.5, 0.5, 11)
    straight = body.lean_acceleration(lean + tilt, 0.0, 8.0)
    np.testing.assert_allclose(
        body.lean_acceleration(lean, 0.0, 8.0, G * np.cos(tilt), G * np.sin(tilt)), straight, atol=1e-12
    )
