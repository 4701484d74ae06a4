"""The track as it is passed: its two frames, how they turn, and what pulls on a body in them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from ski_addon.frames import normalized, rotation_about
from ski_addon.gravity import GRAVITY
from ski_addon.planning.line import (
    SMOOTH_LENGTH,
    Line,
    TrackSpline,
    body_normals,
    frame_spin,
    smoothed_along,
    turned_frames,
)
from ski_addon.planning.ride import Body, SpeedControl, plan_ride
from ski_addon.snow import Snow
from tests.ski_runs import planned

INNER = slice(8, -8)
RUNS = {
    "bumps": ("bumps", {"slope.bump_count": 3}),
    "moguls": ("moguls", {"slope.mogul_count": 6}),
    "turns": ("paper_main", {"course.turn_count": 2}),
}


def ridden(name: str) -> tuple[Line, Snow]:
    """The line of a run as a skier without a body rides it, braking where the document asks for it."""
    run = planned(*RUNS[name])
    snow, track = Snow.of(run.spec.snow, run.spec.skier), run.track
    body = Body(-(track.surface_normal @ GRAVITY), 0.0 * track.arc_length, track.arc_length)
    most = float(run.spec.course.target_speed) if run.spec.course.target_speed != "free" else np.inf
    return TrackSpline(track).line(plan_ride(track, snow, body, SpeedControl(most=most)), snow), snow


def random_directions(seed: int, count: int = 50) -> tuple[np.ndarray, np.ndarray]:
    """Unit tangents and up axes that need not be orthogonal."""
    rng = np.random.default_rng(seed)
    tangent = normalized(np.array([1.0, 0.0, -0.3]) + 0.3 * rng.normal(size=(count, 3)))
    return tangent, normalized(np.array([0.3, 0.0, 1.0]) + 0.2 * rng.normal(size=(count, 3)))


def test_turned_frames_are_rotations_with_the_given_up_axis():
    tangent, up = random_directions(0)
    frame = turned_frames(tangent, up, np.linspace(-1.5, 1.5, 50))
    np.testing.assert_allclose(frame @ np.swapaxes(frame, 1, 2), np.broadcast_to(np.eye(3), (50, 3, 3)), atol=1e-12)
    np.testing.assert_allclose(np.linalg.det(frame), 1.0, atol=1e-12)
    np.testing.assert_allclose(frame[..., 2], up, atol=1e-12)


def test_steering_is_the_angle_to_the_left_from_the_track():
    tangent, up = random_directions(1)
    steering = np.linspace(-1.5, 1.5, 50)
    straight, turned = turned_frames(tangent, up, np.zeros(50)), turned_frames(tangent, up, steering)
    assert (
        np.all(np.sum(straight[..., 0] * tangent, axis=1) > 0)
        and np.abs(np.sum(straight[..., 1] * tangent, axis=1)).max() < 1e-12
    ), "without steering the skis point along the track"
    np.testing.assert_allclose(
        np.arctan2(
            np.sum(turned[..., 0] * straight[..., 1], axis=1), np.sum(turned[..., 0] * straight[..., 0], axis=1)
        ),
        steering,
        atol=1e-12,
    )


def test_spin_of_a_frame_that_turns_evenly_is_its_rate_in_its_own_axes():
    time = np.arange(0.0, 1.0, 0.005)
    rate = np.array([0.4, -0.9, 1.7])
    frame = rotation_about("y", np.array([0.5])) @ Rotation.from_rotvec(time[:, None] * rate).as_matrix()
    np.testing.assert_allclose(frame_spin(frame, time), np.broadcast_to(rate, (len(time), 3)), atol=2e-4)


@pytest.mark.parametrize("name", RUNS)
def test_spin_turns_each_frame_into_the_next(name):
    line, _ = ridden(name)
    turn = Rotation.from_matrix(np.swapaxes(line.body_frame[:-1], 1, 2) @ line.body_frame[1:]).as_rotvec()
    between = 0.5 * (line.spin[1:] + line.spin[:-1])
    np.testing.assert_allclose((turn / np.diff(line.time)[:, None])[INNER], between[INNER], atol=0.05)


@pytest.mark.parametrize("name", RUNS)
def test_pull_is_gravity_and_drag_less_the_acceleration_of_the_skis(name):
    """The skis' acceleration by second differences of their places over time."""
    line, snow = ridden(name)
    moved = CubicSpline(line.time, line.position)(line.time, 2)
    drag = snow.drag_factor * line.speed**2
    np.testing.assert_allclose(line.drag, drag, rtol=1e-12)
    pull = GRAVITY - drag[:, None] * line.tangent - moved
    expected = np.einsum("nij,ni->nj", line.body_frame, pull)
    error = np.abs(line.pull - expected)[INNER]
    assert np.percentile(error, 99) < 0.06, "where the acceleration along the track has a kink it is further off"
    parts = np.stack((line.gravity_along, line.gravity_left, -line.gravity_into), axis=1)
    axes = np.stack((line.tangent, line.left, line.surface_normal), axis=1)
    np.testing.assert_allclose(parts, axes @ GRAVITY, atol=1e-12)


def test_frames_of_the_body_and_of_the_skis_agree_on_a_plane():
    line, _ = ridden("turns")
    np.testing.assert_allclose(line.body_frame[..., 2], line.surface_normal, atol=1e-9)
    np.testing.assert_allclose(line.body_frame[..., 0], line.tangent, atol=1e-9)


@pytest.mark.parametrize("name", ["bumps", "moguls"])
def test_body_nods_less_than_the_skis(name):
    """On bumps it goes along with about a third of their pitch."""
    line, _ = ridden(name)
    mean = normalized(line.surface_normal.mean(axis=0))
    nods = [np.arccos(np.clip(up @ mean, -1, 1)).max() for up in (line.surface_normal, line.body_frame[..., 2])]
    assert nods[0] > np.deg2rad(8) and 0.2 * nods[0] < nods[1] < 0.6 * nods[0]


# -- smooth ground ---------------------------------------------


def test_smoothed_normals_keep_a_plane():
    track = planned(*RUNS["turns"]).track
    np.testing.assert_allclose(smoothed_along(track, track.surface_normal), track.surface_normal, atol=1e-12)
    np.testing.assert_allclose(body_normals(track), track.surface_normal, atol=1e-12)


def test_smoothing_keeps_what_changes_evenly_up_to_both_ends():
    track = planned(*RUNS["bumps"]).track
    even = np.stack((3.0 - 0.2 * track.arc_length, 0.01 * track.arc_length), axis=1)
    np.testing.assert_allclose(smoothed_along(track, even), even, atol=1e-9)


@pytest.mark.parametrize("wave", [6.0, 12.0, 40.0])
def test_waves_are_smoothed_by_their_length(wave):
    """A Gaussian window of deviation s leaves exp(-(2 pi s / wave)^2 / 2) of a wave."""
    track = planned(*RUNS["bumps"]).track
    ripple = np.sin(2 * np.pi * track.arc_length / wave)
    inside = (track.arc_length > 4 * SMOOTH_LENGTH) & (track.arc_length < track.length - 4 * SMOOTH_LENGTH)
    left = smoothed_along(track, ripple[:, None])[inside, 0]
    share = np.exp(-0.5 * (2 * np.pi * SMOOTH_LENGTH / wave) ** 2)
    np.testing.assert_allclose(left, share * ripple[inside], atol=2e-3)
