"""Recording -> world poses at scene frames."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from ski_addon.animation.poses import (
    EmptyRecordingError,
    body_poses_at,
    frame_times,
    sample_body_poses,
    sample_channels,
)
from ski_addon.body import Skeleton, forward_kinematics
from ski_addon.errors import SpecError
from ski_addon.frames import matrix_from_quaternion, mirror_quaternion, mirror_vector
from ski_addon.spec import RunSpec
from tests.synthetic_motion import SPEED, synthetic_motion


@pytest.mark.parametrize("fps", [24.0, 23.976, 30000 / 1001, 25.0, 60.0, 120.0, 1.0])
@pytest.mark.parametrize("subframes", [1, 3])
def test_frames_show_their_time(fps: float, subframes: int) -> None:
    frame, time = frame_times(2.0, fps, subframes, 101)
    np.testing.assert_allclose(time, (frame - 101) / fps, atol=1e-12)
    assert frame[0] == 101
    assert 2.0 - 1.0 / (fps * subframes) < time[-1] <= 2.0 + 1e-9
    np.testing.assert_allclose(np.diff(frame), 1.0 / subframes)


def test_the_frame_base_counts() -> None:
    """24 frames a second with a base of 1.001 are 23.976."""
    frame, time = frame_times(10.01, 24 / 1.001)
    assert frame[-1] == 241
    assert time[-1] == pytest.approx(10.01)


@pytest.mark.parametrize("fps", [0.0, -24.0, float("nan"), float("inf")])
def test_an_impossible_rate_is_refused(fps: float) -> None:
    with pytest.raises(SpecError, match="bake.fps"):
        frame_times(1.0, fps)


def test_no_keys_per_frame_are_refused() -> None:
    with pytest.raises(SpecError, match="bake.subframes"):
        frame_times(1.0, 24.0, 0)


def test_poses_are_those_recorded(recording: SimpleNamespace, skeleton: Skeleton) -> None:
    """At 25 frames a second every frame falls on a recorded millisecond."""
    poses = sample_body_poses(recording, skeleton, 25.0)
    index = np.round((poses.frame - 1) * 40).astype(int)
    position, rotation = forward_kinematics(skeleton, recording.qpos[index])
    np.testing.assert_allclose(poses.position, position, atol=1e-9)
    np.testing.assert_allclose(matrix_from_quaternion(poses.quaternion), rotation, atol=1e-9)


@pytest.mark.parametrize("step", [0.001, 0.005])
def test_between_steps_poses_are_close_to_the_true_ones(skeleton: Skeleton, step: float) -> None:
    spec = RunSpec()
    coarse, fine = synthetic_motion(skeleton, spec, step=step), synthetic_motion(skeleton, spec, step=step / 10)
    time = fine.time[3:20000:7]
    want = forward_kinematics(skeleton, fine.qpos[3:20000:7])
    got = body_poses_at(coarse, skeleton, time)
    tolerance = 40.0 * step**2  # the second derivative of a swinging limb over eight
    np.testing.assert_allclose(got.position, want[0], atol=tolerance)
    np.testing.assert_allclose(matrix_from_quaternion(got.quaternion), want[1], atol=tolerance)


def test_the_clock_may_start_anywhere(skeleton: Skeleton) -> None:
    at_zero, later = (synthetic_motion(skeleton, RunSpec(), start=start) for start in (0.0, 7.5))
    one, other = (sample_body_poses(recording, skeleton, 24.0) for recording in (at_zero, later))
    np.testing.assert_allclose(one.position, other.position, atol=1e-9)


def test_subframes_hold_the_frames(recording: SimpleNamespace, skeleton: Skeleton) -> None:
    whole, parts = (sample_body_poses(recording, skeleton, 24.0, subframes) for subframes in (1, 4))
    np.testing.assert_allclose(parts.position[::4][: len(whole.frame)], whole.position, atol=1e-12)


def test_a_mirrored_run_gives_mirrored_poses(recording: SimpleNamespace, skeleton: Skeleton) -> None:
    mirrored = SimpleNamespace(**{**vars(recording), "qpos": mirrored_qpos(recording.qpos, skeleton)})
    one, other = (sample_body_poses(each, skeleton, 24.0, 2) for each in (recording, mirrored))
    swap = [skeleton.body(other_side(name)) for name in skeleton.body_names]
    np.testing.assert_allclose(other.position[:, swap], mirror_vector(one.position), atol=1e-9)
    dot = np.sum(other.quaternion[:, swap] * mirror_quaternion(one.quaternion), axis=-1)
    np.testing.assert_allclose(np.abs(dot), 1.0, atol=1e-9)


def other_side(name: str) -> str:
    return {".L": name[:-2] + ".R", ".R": name[:-2] + ".L"}.get(name[-2:], name)


def mirrored_qpos(qpos: np.ndarray, skeleton: Skeleton) -> np.ndarray:
    out = qpos.copy()
    out[:, :3], out[:, 3:7] = mirror_vector(qpos[:, :3]), mirror_quaternion(qpos[:, 3:7])
    for name, address in zip(skeleton.joint_names, skeleton.joint_qpos, strict=True):
        sign = -1.0 if name.partition(".")[0][-1] in "xz" else 1.0
        out[:, address] = sign * qpos[:, skeleton.qpos_of(other_side(name))]
    return out


def test_one_step_is_one_frame(skeleton: Skeleton) -> None:
    assert len(sample_body_poses(synthetic_motion(skeleton, RunSpec(), duration=0.0), skeleton, 24.0).frame) == 1


def test_an_empty_recording_is_refused(recording: SimpleNamespace, skeleton: Skeleton) -> None:
    empty = SimpleNamespace(time=recording.time[:0], qpos=recording.qpos[:0])
    with pytest.raises(EmptyRecordingError, match="empty"):
        sample_body_poses(empty, skeleton, 24.0)


def test_channels_are_in_shown_units(recording: SimpleNamespace) -> None:
    time = np.array([0.0, 0.75, 1.5])
    channels = {channel.name: channel for channel in sample_channels(recording, time)}
    assert list(channels) == [
        "speed",
        "inclination",
        "edge_angle_left",
        "edge_angle_right",
        "snow_force_left",
        "snow_force_right",
        "turn_phase",
    ]
    np.testing.assert_allclose(channels["speed"].values, [SPEED, SPEED + 1.0, SPEED], atol=1e-9)
    np.testing.assert_allclose(channels["inclination"].values, [0.0, 25.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(channels["edge_angle_right"].values, [0.0, 30.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(channels["turn_phase"].values, [0.0, 1.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(channels["snow_force_left"].values[0], 0.5 * 9.81 * 50.0, rtol=1e-9)
    assert channels["snow_force_right"].unit == "N"
