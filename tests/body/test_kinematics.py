"""Forward kinematics in numpy against MuJoCo's."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from ski_addon.body import build_skier_model, centre_of_mass, forward_kinematics
from ski_addon.body.kinematics import CHUNK, moment_of_mass
from ski_addon.spec import SkierSpec
from tests.ski_runs import mirrored_qpos, random_configuration

PERSONS = [SkierSpec(), SkierSpec(mass=90, height=1.95, sex="female", stance_width=0.4, ski_length=1.6)]


@pytest.mark.parametrize("person", PERSONS, ids=["default", "tall"])
def test_frames_and_centre_of_mass_are_mujocos(person):
    model = build_skier_model(person)
    rng = np.random.default_rng(0)
    qpos = np.array([random_configuration(model, rng) for _ in range(40)])
    position, rotation = forward_kinematics(model.skeleton, qpos)
    com = centre_of_mass(model.skeleton, position, rotation)
    data = model.new_data()
    for i, configuration in enumerate(qpos):
        data.qpos[:] = configuration
        mujoco.mj_fwdPosition(model.mujoco, data)
        np.testing.assert_allclose(position[i], data.xpos[1:], atol=1e-13)
        np.testing.assert_allclose(rotation[i], data.xmat[1:].reshape(-1, 3, 3), atol=1e-13)
        np.testing.assert_allclose(com[i], data.subtree_com[1], atol=1e-13)


def test_many_configurations_are_worked_out_in_parts_as_each_by_itself():
    model = build_skier_model(SkierSpec())
    rng = np.random.default_rng(1)
    qpos = np.array([random_configuration(model, rng) for _ in range(CHUNK + 3)])
    position, rotation = forward_kinematics(model.skeleton, qpos)
    for i in (0, CHUNK - 1, CHUNK, CHUNK + 2):
        alone = forward_kinematics(model.skeleton, qpos[i : i + 1])
        np.testing.assert_allclose(position[i], alone[0][0], atol=1e-14)
        np.testing.assert_allclose(rotation[i], alone[1][0], atol=1e-14)


def test_moment_of_some_bodies_is_their_mass_times_their_centre():
    model = build_skier_model(SkierSpec())
    skeleton, rng = model.skeleton, np.random.default_rng(2)
    qpos = np.array([random_configuration(model, rng) for _ in range(4)])
    bodies = [0, skeleton.body("thigh.R"), skeleton.body("shank.R")]
    position, rotation = forward_kinematics(skeleton, qpos)
    centre = {body: position[:, body] + rotation[:, body] @ skeleton.com[body] for body in bodies}
    expected = sum(skeleton.mass[body] * centre[body] for body in bodies)
    np.testing.assert_allclose(moment_of_mass(skeleton, qpos, bodies).T, expected, atol=1e-12)


def test_mirrored_configuration_is_the_mirror_image():
    model = build_skier_model(SkierSpec())
    skeleton = model.skeleton
    qpos = np.array([random_configuration(model, np.random.default_rng(5)) for _ in range(5)])
    position, _ = forward_kinematics(skeleton, qpos)
    mirrored, _ = forward_kinematics(skeleton, mirrored_qpos(model, qpos))
    swap = {"L": "R", "R": "L"}
    names = [name[:-1] + swap[name[-1]] if "." in name else name for name in skeleton.body_names]
    other = [skeleton.body(name) for name in names]
    np.testing.assert_allclose(mirrored[:, other], position * [1, -1, 1], atol=1e-12)


def test_zero_configuration_stands_upright_with_hanging_arms():
    skeleton = build_skier_model(SkierSpec()).skeleton
    qpos = np.zeros((1, 42))
    qpos[0, 3] = 1.0
    position, rotation = forward_kinematics(skeleton, qpos)
    poles = [skeleton.body(f"pole.{side}") for side in "LR"]
    upright = [i for i in range(20) if i not in poles]
    np.testing.assert_array_equal(rotation[0, upright], np.broadcast_to(np.eye(3), (18, 3, 3)))
    left = position[0, [skeleton.body(f"{part}.L") for part in ("upper_arm", "forearm", "hand", "thigh", "foot")]]
    assert np.all(left[:, 1] > 0)
    assert np.all(np.diff(left[:3, 2]) < 0) and left[4, 2] < left[3, 2] < 0
    for pole in poles:  # its axis is -z of its frame: backward, not forward, and not into the head
        assert -rotation[0, pole, 0, 2] < -0.3
