"""Gates give way to the body, no more than they must, and come to rest again."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ski_addon.animation import gate_motion
from ski_addon.animation.gate_motion import GateSwing, gate_swings, pose_swings
from ski_addon.animation.poses import body_poses_at
from ski_addon.body import build_skeleton, forward_kinematics
from ski_addon.course import Gates
from ski_addon.spec import RunSpec
from tests.synthetic_motion import SPEED, synthetic_motion


@pytest.fixture(scope="module")
def spec() -> RunSpec:
    return RunSpec()


@pytest.fixture(scope="module")
def recording(spec: RunSpec) -> SimpleNamespace:
    return synthetic_motion(build_skeleton(spec.skier), spec, duration=4.0)


def gates_beside(recording: SimpleNamespace, time: float, left: float) -> Gates:
    """One gate that stands `left` [m] of where the skier is at `time` [s]; a negative one stands to the right."""
    place = recording.track_position[int(time * 1000)] + np.array([0.0, left, 0.0])
    return Gates(place[None], np.array([1 if left > 0 else -1], dtype=np.int8), np.array([abs(left)]))


def test_a_pole_out_of_reach_stands_still(spec, recording) -> None:
    skeleton = build_skeleton(spec.skier)
    assert gate_swings(recording, skeleton, gates_beside(recording, 2.0, 2.5)) == [None]
    assert gate_swings(recording, skeleton, gates_beside(recording, 2.0, 40.0)) == [None]


@pytest.mark.parametrize("left", [0.1, -0.1])
def test_a_pole_in_the_way_is_knocked_over_ahead_and_away(spec, recording, left: float) -> None:
    (swing,) = gate_swings(recording, build_skeleton(spec.skier), gates_beside(recording, 2.0, left))
    assert swing is not None
    assert swing.towards[0] > 0.7 and swing.towards[1] * left > 0.0
    assert np.linalg.norm(swing.towards) == pytest.approx(1.0)
    assert 60.0 < np.degrees(swing.angle.max()) <= np.degrees(gate_motion.FLATTEST)
    touched = swing.pushed > 0.0
    assert np.all(swing.angle[touched] >= swing.pushed[touched] - 1e-12)
    assert abs(swing.time[np.argmax(swing.angle)] - 2.0) < 2.0 / SPEED


def test_a_pole_stands_before_and_after(spec, recording) -> None:
    (swing,) = gate_swings(recording, build_skeleton(spec.skier), gates_beside(recording, 2.0, 0.1))
    np.testing.assert_array_equal(swing.at(np.array([0.0, swing.time[0], swing.time[-1], 100.0])), 0.0)
    last = swing.angle[swing.time > swing.time[-1] - 0.1]
    assert np.degrees(np.abs(last).max()) < 1.5


def test_no_ball_of_the_body_is_within_the_pole(spec, recording) -> None:
    skeleton, gates = build_skeleton(spec.skier), gates_beside(recording, 2.0, 0.25)
    (swing,) = gate_swings(recording, skeleton, gates)
    index = np.arange(1700, 2400, 20)
    frames = forward_kinematics(skeleton, recording.qpos[index])
    places, radii = gate_motion._balls(skeleton.body_names, *frames)
    angle = swing.at(index * 0.001)
    pole = np.stack((*(np.sin(angle) * swing.towards[:, None]), np.cos(angle)), axis=1)
    offset = places - gates.position[0]
    along = np.clip(np.einsum("mkc,mc->mk", offset, pole), 0.0, gate_motion.POLE_LENGTH)
    gap = np.linalg.norm(offset - along[..., None] * pole[:, None], axis=2) - radii
    free = (angle < gate_motion.FLATTEST - 1e-3)[:, None] & (offset[..., 2] > 0.1)
    assert np.any(angle > 0.5)
    assert np.min(gap[free & (along < gate_motion.POLE_LENGTH)]) > -0.02


def test_a_swing_turns_the_pole_towards_the_push() -> None:
    swing = GateSwing(np.array([0.0, 1.0]), np.array([0.0, 1.0]), np.zeros(2), np.array([0.6, -0.8]))
    w, x, y, z = swing.quaternion(swing.at(np.array([0.5])))[0]
    up = np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)])
    np.testing.assert_allclose(up, [0.6 * np.sin(0.5), -0.8 * np.sin(0.5), np.cos(0.5)], atol=1e-12)


def test_poses_knock_a_gate_over_as_the_recording_they_are_from(spec, recording) -> None:
    skeleton, gates = build_skeleton(spec.skier), gates_beside(recording, 2.0, 0.1)
    poses = body_poses_at(recording, skeleton, np.arange(0.0, recording.time[-1], gate_motion.STEP))
    (recorded,), (posed,) = gate_swings(recording, skeleton, gates), pose_swings(poses, gates)
    assert recorded is not None and posed is not None
    np.testing.assert_allclose(posed.angle, recorded.angle, atol=1e-6)
    np.testing.assert_allclose(posed.towards, recorded.towards, atol=1e-6)
