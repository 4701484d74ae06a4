"""Leg inverse kinematics: the way back from forward kinematics, and honest about what is out of reach."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body import forward_kinematics
from ski_addon.body.leg_ik import MINIMUM_KNEE, ankle_from_ski, solve_leg
from ski_addon.frames import rotation_about
from tests.ski_runs import default_model

MODEL = default_model()
SKELETON = MODEL.skeleton
HINGES = ("thigh_y", "thigh_x", "thigh_z", "shank_y", "foot_y", "foot_x")
LIMIT = np.deg2rad(5.0)
COUNT = 300


def random_legs(side: str, seed: int = 0) -> np.ndarray:
    """Angles (n, 6) of one leg within its joint ranges, the knee a little from straight."""
    rng = np.random.default_rng(seed)
    names = [SKELETON.joint_names[i] for i in SKELETON.actuated]
    place = [names.index(f"{hinge}.{side}") for hinge in HINGES]
    lower, upper = MODEL.joint_lower[place], MODEL.joint_upper[place]
    lower[3] = MINIMUM_KNEE + 0.02
    return rng.uniform(lower, upper, size=(COUNT, 6))


def pose(side: str, angles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Body positions and rotations, and qpos, of a leg at `angles` under a random pelvis."""
    rng = np.random.default_rng(7)
    qpos = np.zeros((len(angles), SKELETON.nq))
    qpos[:, :3] = rng.normal(size=(len(angles), 3))
    qpos[:, 3:7] = rng.normal(size=(len(angles), 4))
    qpos[:, 3:7] /= np.linalg.norm(qpos[:, 3:7], axis=1, keepdims=True)
    for column, hinge in enumerate(HINGES):
        qpos[:, SKELETON.qpos_of(f"{hinge}.{side}")] = angles[:, column]
    return *forward_kinematics(SKELETON, qpos), qpos


def body(frames: np.ndarray, name: str) -> np.ndarray:
    return frames[:, SKELETON.body(name)]


def solved(side: str, position: np.ndarray, rotation: np.ndarray, foot: np.ndarray | None = None):
    hip, ankle = body(position, f"thigh.{side}"), body(position, f"foot.{side}")
    foot_rotation = body(rotation, f"foot.{side}") if foot is None else foot
    return solve_leg(SKELETON, hip, body(rotation, "pelvis"), ankle, foot_rotation, LIMIT)


def stacked(legs) -> np.ndarray:
    return np.column_stack((legs.thigh, legs.shank, legs.foot_y, legs.foot_x))


@pytest.mark.parametrize("side", ["L", "R"])
def test_round_trip(side):
    angles = random_legs(side)
    position, rotation, _ = pose(side, angles)
    legs = solved(side, position, rotation)
    # the other solution, with the foot turned right round, is never wanted
    ahead = np.einsum("ni,ni->n", body(rotation, f"shank.{side}")[..., 1], body(rotation, f"foot.{side}")[..., 1]) > 0
    usual = ahead & (np.cos(angles[:, 4] + 0.5 * angles[:, 3]) > 0.3)
    assert usual.sum() > COUNT // 2
    np.testing.assert_allclose(stacked(legs)[usual], angles[usual], atol=1e-9)
    assert np.abs(legs.length_error).max() < 1e-12
    assert np.abs(legs.edge_error[usual]).max() < 1e-9


def test_knee_always_bends_and_points_forward():
    """Whatever is asked: the knee never bends backward and lies ahead of the line from hip to ankle."""
    rng = np.random.default_rng(3)
    ski = rotation_about("z", rng.uniform(-0.3, 0.3, COUNT)) @ rotation_about("x", rng.uniform(-1.0, 1.0, COUNT))
    ankle = np.zeros((COUNT, 3))
    lean = rng.uniform(-0.9, 0.9, COUNT)
    reach = rng.uniform(0.2, 0.9, COUNT)  # too near and too far as well
    hip = reach[:, None] * np.stack((rng.uniform(-0.4, 0.4, COUNT), np.sin(lean), np.cos(lean)), axis=1)
    pelvis = rotation_about("x", -0.5 * lean)
    legs = solve_leg(SKELETON, hip, pelvis, ankle, ski, LIMIT)
    assert legs.shank.min() >= MINIMUM_KNEE - 1e-12
    assert legs.shank.max() <= np.deg2rad(150) + 1e-12
    thigh = pelvis @ rotation_about("y", legs.thigh[:, 0]) @ rotation_about("x", legs.thigh[:, 1])
    thigh = thigh @ rotation_about("z", legs.thigh[:, 2])
    knee = hip - SKELETON.lengths["thigh"] * thigh[..., 2]
    line = ankle - hip
    along = np.einsum("ni,ni->n", knee - hip, line) / np.einsum("ni,ni->n", line, line)
    off_line = knee - hip - along[:, None] * line
    assert np.all(np.einsum("ni,ni->n", off_line, ski[..., 0]) > 0)


@pytest.mark.parametrize("excess", [0.03, -0.05])
def test_reach_error_is_how_far_the_hip_is_out_of_reach(excess):
    thigh, shank = SKELETON.lengths["thigh"], SKELETON.lengths["shank"]
    knee = MINIMUM_KNEE if excess > 0 else np.deg2rad(150)
    limit = np.sqrt(thigh**2 + shank**2 + 2 * thigh * shank * np.cos(knee))
    hip, eye = np.array([[0.0, 0.0, limit + excess]]), np.eye(3)[None]
    legs = solve_leg(SKELETON, hip, eye, np.zeros((1, 3)), eye)
    assert legs.length_error[0] == pytest.approx(excess, abs=1e-12)
    assert legs.shank[0] == pytest.approx(knee)
    within = solve_leg(SKELETON, 0.95 * hip / hip[0, 2] * limit if excess > 0 else hip * 2, eye, np.zeros((1, 3)), eye)
    assert within.length_error[0] == 0.0


@pytest.mark.parametrize("roll", [-20.0, -6.0, -3.0, 3.0, 6.0, 20.0])
def test_boot_takes_five_degrees_and_the_rest_is_the_edge_error(roll):
    """A ski rolled against the leg: the ankle gives its play, and the ski ends up exactly the error short."""
    angles = random_legs("L", seed=1)
    angles[:, 3] = np.clip(angles[:, 3], 0.5, 1.6)
    angles[:, 4] = -0.45 * angles[:, 3]
    angles[:, 5] = 0.0
    position, rotation, qpos = pose("L", angles)
    asked = body(rotation, "foot.L") @ rotation_about("x", np.deg2rad(roll))
    legs = solved("L", position, rotation, asked)
    assert np.abs(legs.foot_x).max() <= LIMIT + 1e-12
    np.testing.assert_allclose(legs.foot_x + legs.edge_error, np.deg2rad(roll), atol=1e-9)
    np.testing.assert_allclose(legs.edge_error, np.sign(roll) * max(abs(np.deg2rad(roll)) - LIMIT, 0.0), atol=1e-9)
    for column, hinge in enumerate(HINGES):
        qpos[:, SKELETON.qpos_of(f"{hinge}.L")] = stacked(legs)[:, column]
    reached_position, reached = forward_kinematics(SKELETON, qpos)
    np.testing.assert_allclose(body(reached_position, "foot.L"), body(position, "foot.L"), atol=1e-9)
    short = asked @ rotation_about("x", -legs.edge_error)
    np.testing.assert_allclose(body(reached, "foot.L"), short, atol=1e-9)


def test_ankle_is_over_the_ski_as_in_the_skeleton():
    position, rotation, _ = pose("R", random_legs("R"))
    ankle = ankle_from_ski(SKELETON, body(position, "ski.R"), body(rotation, "ski.R"))
    np.testing.assert_allclose(ankle, body(position, "foot.R"), atol=1e-12)
