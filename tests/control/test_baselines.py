"""Skis that nobody steers, and the gains of what is compared."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.control import Dynamics, FreeSkis, Gains, gains_of
from ski_addon.control.tasks import Desired
from ski_addon.frames import matrix_from_quaternion, quaternion_from_matrix, rotation_about
from ski_addon.planning import build_stance
from ski_addon.snow import Snow
from ski_addon.spec import SkierSpec, SlopeSpec, SnowSpec
from ski_addon.terrain import build_terrain
from tests.ski_runs import default_model

SNOW = Snow.of(SnowSpec(), SkierSpec(drag_area=0.0))
SLOPE = np.deg2rad(10.0)
UP = np.array([np.sin(SLOPE), 0.0, np.cos(SLOPE)])
DOWN = np.array([np.cos(SLOPE), 0.0, -np.sin(SLOPE)])
LEFT = np.array([0.0, 1.0, 0.0])


def released(edge: float = 0.0, velocity=(8.0, 0.0, 0.0), spin=(0.0, 0.0, 0.0), lift: float = 0.0) -> np.ndarray:
    """What snow does to the left ski (2, 3): linear and angular acceleration along the slope's down, left and up.

    The skier stands straight down the slope, tipped to the left by `edge` [rad] about the left ski's middle, `lift` [m]
    over the snow, moving with `velocity` and turning with `spin` in the same axes.
    """
    model = default_model()
    dynamics = Dynamics(model)
    slope = np.stack((DOWN, LEFT, UP), axis=1)
    dynamics.qpos[:] = build_stance(model.skeleton, np.deg2rad(60)).qpos
    tip = slope @ rotation_about("x", np.array(-edge))
    place, pelvis = dynamics.qpos[:3].copy(), matrix_from_quaternion(dynamics.qpos[3:7])
    middle = np.array([0.0, 0.5 * model.skeleton.stance_width, 0.0])
    dynamics.qpos[:3] = tip @ (place - middle) + lift * UP
    dynamics.qpos[3:7] = quaternion_from_matrix(tip @ pelvis)
    dynamics.update()
    arm = dynamics.qpos[:3] - dynamics.ski_position(0)
    dynamics.qvel[:3] = slope @ np.array(velocity) + np.cross(slope @ np.array(spin), arm)
    dynamics.qvel[3:6] = dynamics.root_rotation.T @ slope @ np.array(spin)
    dynamics.update()
    desired = Desired()
    FreeSkis(dynamics, SNOW, build_terrain(SlopeSpec(angle_deg=10))).release(desired)
    angular = dynamics.ski_rotation(0) @ desired.ski[0, 3:]
    return np.stack((desired.ski[0, :3] @ slope, angular @ slope))


def test_flat_ski_glides_straight_on_by_gravity_and_friction():
    linear, angular = released()
    glide = 9.81 * (np.sin(SLOPE) - (0.071 + 0.004 * 8.0) * np.cos(SLOPE))
    np.testing.assert_allclose(linear, [glide, 0, 0], atol=1e-6)
    np.testing.assert_allclose(angular, 0.0, atol=1e-6)


def test_snow_holds_a_ski_at_its_surface():
    assert released(lift=-0.01)[0, 2] == pytest.approx(4.0) and released(lift=0.01)[0, 2] == pytest.approx(-4.0)
    assert released(velocity=(8, 0, -0.5))[0, 2] == pytest.approx(20.0)


def test_snow_stops_a_ski_that_slips_sideways():
    assert released(velocity=(8, 0.5, 0))[0, 1] == pytest.approx(-20.0)
    assert released(velocity=(8, -0.5, 0))[0, 1] == pytest.approx(20.0)


def test_edged_ski_turns_round_the_circle_of_its_side():
    """Leaning left it turns left, by v^2 / (R cos(edge)), and right the same."""
    edge = np.deg2rad(30.0)
    radius = SkierSpec().ski_sidecut_radius * np.cos(edge)
    for side in (1.0, -1.0):
        linear, angular = released(edge=side * edge)
        assert linear[1] == pytest.approx(side * 64.0 / radius, rel=1e-3)
        assert angular[2] == pytest.approx(side * 40.0 * 8.0 / radius, rel=1e-3)
        on_circle = released(edge=side * edge, spin=(0, 0, side * 8.0 / radius))[1]
        assert on_circle[2] == pytest.approx(0.0, abs=0.1)


def test_snow_turns_a_lifted_tip_down_again_but_leaves_the_edging_alone():
    assert released(spin=(0, -1.0, 0))[1, 1] == pytest.approx(40.0)
    assert released(spin=(1.0, 0, 0))[1, 0] == pytest.approx(0.0, abs=1e-6)


def test_only_the_whole_body_balances():
    assert gains_of("whole_body") == Gains()
    open_loop = gains_of("open_loop")
    assert {open_loop.com.weight, open_loop.pelvis.weight, open_loop.angular_momentum.weight} == {0.0}
    assert open_loop.edging.weight == 0.0, "snow does not set the edge angle"
    assert gains_of("inclination_only").com == Gains().com
