"""The pelvis and the edges that belong to a centre of mass, against the whole chain of bodies."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body import centre_of_mass, forward_kinematics
from ski_addon.body.leg_ik import ankle_from_ski, solve_leg
from ski_addon.body.skeleton import SIDES
from ski_addon.frames import matrix_from_quaternion, rotation_about
from ski_addon.planning import build_stance
from ski_addon.planning.pendulum import Pendulum
from ski_addon.planning.pose import PlannedPoses, plan_poses
from ski_addon.planning.standing import BOOT_PLAY, MOST_ROUNDS, place_pelvis
from tests.ski_runs import default_model

SKELETON = default_model().skeleton
STANCE = build_stance(SKELETON, np.deg2rad(50.0))
LEAN = np.deg2rad(np.linspace(-50.0, 50.0, 41))


def frames() -> np.ndarray:
    """Frames of the snow that turn and tip from place to place."""
    turns = np.linspace(-0.4, 0.4, len(LEAN))
    return rotation_about("z", turns) @ rotation_about("y", 0.2 + 0.3 * turns) @ rotation_about("x", 0.1 * turns)


def posed(length: float) -> tuple[np.ndarray, np.ndarray, PlannedPoses]:
    """The middles between skis, the centres of mass wanted `length` [m] away, leaning, and the poses for them."""
    skis = frames()
    place = np.cumsum(skis[..., 0], axis=0)
    y, h, none = length * np.sin(LEAN), length * np.cos(LEAN), np.zeros_like(LEAN)
    com = place + y[:, None] * skis[..., 1] + h[:, None] * skis[..., 2]
    pendulum = Pendulum(y, none, h, none, none, none)
    steering = 0.3 * np.cos(3.0 * LEAN)
    gaze = skis[..., 0]
    return place, com, plan_poses(SKELETON, STANCE, skis, skis, place, com, pendulum, none - 0.3, steering, gaze)


@pytest.mark.parametrize("share", [0.85, 1.0])
def test_the_whole_chain_has_its_centre_of_mass_where_it_is_wanted(share):
    _, com, poses = posed(share * STANCE.height)
    found = centre_of_mass(SKELETON, *forward_kinematics(SKELETON, poses.qpos))
    np.testing.assert_allclose(found, com, atol=1e-9)


def test_legs_out_of_reach_still_have_the_centre_of_mass_where_it_is_wanted():
    _, com, poses = posed(1.25 * STANCE.height)
    assert poses.reach_error.max() > 0.05
    found = centre_of_mass(SKELETON, *forward_kinematics(SKELETON, poses.qpos))
    np.testing.assert_allclose(found, com, atol=1e-9)


def test_skis_are_edged_by_the_lean_and_what_the_boots_cannot_take():
    """The inverse kinematics of the finished pose gives back what the search for it believed of boots and edges."""
    place, _, poses = posed(STANCE.height)
    rotation = matrix_from_quaternion(poses.qpos[:, 3:7])
    for side, name in enumerate(SIDES):
        hip = poses.qpos[:, :3] + rotation @ SKELETON.offset[SKELETON.body(f"thigh.{name}")]
        foot = poses.ski_rotation[:, side]
        leg = solve_leg(SKELETON, hip, rotation, ankle_from_ski(SKELETON, poses.ski_position[:, side], foot), foot)
        misfit = poses.edge_angle[:, side] - LEAN + leg.foot_x + leg.edge_error
        expected = LEAN + misfit - BOOT_PLAY * np.tanh(misfit / BOOT_PLAY)
        np.testing.assert_allclose(poses.edge_angle[:, side], expected, atol=1e-9)
    assert np.abs(poses.edge_angle - LEAN[:, None]).max() > np.deg2rad(3.0), "the case is too easy to test anything"


def test_each_place_is_found_by_itself(monkeypatch):
    """A place among others has the pose it has alone, and few rounds find all."""
    monkeypatch.setattr("ski_addon.planning.standing.MOST_ROUNDS", MOST_ROUNDS // 2)
    skis = frames()
    place, com, poses = posed(STANCE.height)
    for i in (0, 17, 40):
        one = slice(i, i + 1)
        pelvis, edge = place_pelvis(SKELETON, poses.qpos[one], skis[one], place[one], com[one], LEAN[one])
        np.testing.assert_allclose(pelvis, poses.qpos[one, :3], atol=1e-9)
        np.testing.assert_allclose(edge, poses.edge_angle[one], atol=1e-9)
