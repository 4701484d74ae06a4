"""What the legs do over bumps: the least acceleration of the body within their reach, and how low a skier stands."""

from __future__ import annotations

import dataclasses
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.interpolate import CubicSpline
from scipy.ndimage import gaussian_filter1d

from ski_addon.frames import rotation_about
from ski_addon.gravity import GRAVITY
from ski_addon.planning import build_stance
from ski_addon.planning.absorption import (
    LEAST_KNEE,
    SINK_FACTOR,
    SLOWEST_ABSORBED,
    TOLERANCE,
    Sink,
    absorbing_rise,
    legs_for,
    missing_length,
)
from ski_addon.planning.pose import PlannedPoses
from tests.ski_runs import default_model, planned

TIME = np.arange(0.0, 6.0001, 0.005)
LOW, HIGH = 0.22, 0.08
"""How far the legs bend and stretch [m]."""
MIDDLE = (TIME > 1.0) & (TIME < 5.0)


def ridden(lift: np.ndarray, pitch: float = 0.2):
    """A line down `pitch` [rad] whose skis are accelerated by `lift` (n,) [m/s^2] along the body's up axis."""
    frame = np.repeat(rotation_about("y", np.array([pitch])), len(TIME), axis=0)
    pull = np.einsum("nij,ni->nj", frame, np.broadcast_to(GRAVITY, (len(TIME), 3))).copy()
    pull[:, 2] -= lift
    return SimpleNamespace(time=TIME, body_frame=frame, pull=pull)


def legs(low: float = LOW, high: float = HIGH):
    return SimpleNamespace(retraction=low, extension=high, height=0.8)


def wave(height: float, rate: float, phase: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    """Heights (n,) [m] of the ground over `TIME`, and their acceleration [m/s^2]."""
    ground = height * np.sin(rate * TIME + phase)
    return ground, -(rate**2) * ground


def body_acceleration(lift: np.ndarray, rise: np.ndarray) -> np.ndarray:
    return lift + CubicSpline(TIME, rise)(TIME, 2)


# -- least acceleration ---------------------------------------------


@pytest.mark.parametrize("pitch", [0.0, 0.35])
def test_even_ground_asks_nothing_of_the_legs(pitch):
    np.testing.assert_array_equal(absorbing_rise(ridden(np.zeros_like(TIME), pitch), legs(), 1.0), 0.0)


def test_small_bumps_are_taken_up_whole():
    """The body goes straight: the legs shorten by as much as the ground rises."""
    ground, lift = wave(0.05, 5.0)
    rise = absorbing_rise(ridden(lift), legs(), 1.0)
    np.testing.assert_allclose(rise[MIDDLE], -ground[MIDDLE], atol=0.01)
    assert np.std(body_acceleration(lift, rise)[MIDDLE]) < 0.1 * np.std(lift[MIDDLE])


@pytest.mark.parametrize("height", [0.1, 0.2, 0.4])
def test_large_bumps_are_taken_up_as_far_as_the_legs_reach(height):
    """Better than stiff legs, and at both ends of their reach where the bumps are larger than that."""
    ground, lift = wave(height, 4.0)
    rise = absorbing_rise(ridden(lift), legs(), 1.0)
    assert rise.min() > -LOW - 0.003 and rise.max() < HIGH + 0.003
    assert np.var(body_acceleration(lift, rise)[MIDDLE]) < 0.8 * np.var(lift[MIDDLE])
    if height > 0.15:
        assert rise.min() < -LOW + 0.003 and rise.max() > HIGH - 0.003


def test_no_other_motion_of_the_legs_leaves_less_acceleration():
    """Random smooth changes within the reach make it worse, up to what slow standing and jerks cost."""
    ground, lift = wave(0.2, 4.0)
    rise = absorbing_rise(ridden(lift), legs(), 1.0)

    def cost(heights: np.ndarray) -> float:
        jerk = CubicSpline(TIME, heights)(TIME, 3)
        return float(
            np.mean(body_acceleration(lift, heights) ** 2)
            + np.mean((0.03 * jerk) ** 2)
            + SLOWEST_ABSORBED**4 * np.mean(heights**2)
        )

    rng, least = np.random.default_rng(0), cost(rise)
    for _ in range(40):
        rate, phase = rng.uniform(1.0, 12.0), rng.uniform(0, 2 * np.pi)
        bump = np.exp(-0.5 * ((TIME - rng.uniform(1.5, 4.5)) / rng.uniform(0.2, 0.8)) ** 2)
        other = np.clip(rise + rng.choice([-0.02, 0.02]) * bump * np.sin(rate * TIME + phase), -LOW, HIGH)
        assert cost(gaussian_filter1d(other, 4.0, mode="nearest")) > 0.999 * least


def test_slow_waves_are_ridden_not_absorbed():
    slow, quick = (absorbing_rise(ridden(wave(0.05, rate)[1]), legs(), 1.0) for rate in (0.5, 6.0))
    assert np.abs(slow[MIDDLE]).max() < 0.3 * np.abs(quick[MIDDLE]).max()


def test_less_absorption_takes_up_its_share():
    ground, lift = wave(0.05, 5.0)
    whole, half, none = (absorbing_rise(ridden(lift), legs(), share) for share in (1.0, 0.5, 0.0))
    np.testing.assert_allclose(half, 0.5 * whole, atol=1e-4)
    np.testing.assert_array_equal(none, 0.0)


def test_ground_passed_backwards_asks_for_the_same_motion_backwards():
    """It is planned as a whole: legs bend before a crest as they stretch behind it."""
    lift = 5.0 * np.exp(-0.5 * ((TIME - 2.0) / 0.2) ** 2) - 3.0 * np.exp(-0.5 * ((TIME - 3.5) / 0.3) ** 2)
    there, back = (absorbing_rise(ridden(lifted), legs(), 1.0) for lifted in (lift, lift[::-1]))
    np.testing.assert_allclose(back[::-1], there, atol=1e-5)
    assert np.ptp(there) > 0.05


def test_crests_for_hollows_mirror_the_motion_if_the_legs_reach_as_far_both_ways():
    _, lift = wave(0.25, 4.0, 0.7)
    up, down = (absorbing_rise(ridden(sign * lift), legs(0.1, 0.1), 1.0) for sign in (1, -1))
    np.testing.assert_allclose(up, -down, atol=1e-5)


@pytest.mark.parametrize("name", ["bumps", "moguls"])
def test_planned_bodies_are_shaken_less_with_absorption(name):
    """Vertical acceleration of the centre of mass; most of it is left out on bumps that the legs can take up."""
    changes = {"slope.bump_count": 3} if name == "bumps" else {"slope.mogul_count": 6, "technique.load_min": 0.0}
    changes |= {"slope.mogul_height": 0.15} if name == "moguls" else {}
    variances = []
    for absorption in (1.0, 0.0):
        plan = planned(name, {**changes, "technique.absorption": absorption}).plan
        variances.append(np.var(CubicSpline(plan.time, plan.com[:, 2])(plan.time, 2)[8:-8]))
    assert variances[0] < 0.4 * variances[1]


# -- standing lower ---------------------------------------------


@pytest.fixture(scope="module")
def track():
    return planned("paper_main", {"course.turn_count": 2}).track


def test_nobody_sinks_whose_legs_are_long_enough(track):
    sink = Sink(track)
    assert not sink.deepen(track.arc_length, np.full(len(track.arc_length), 0.9 * TOLERANCE))
    np.testing.assert_array_equal(sink.at(track.arc_length), 0.0)


def test_sink_is_deep_enough_where_legs_are_short_and_smooth_around(track):
    sink, arc = Sink(track), track.arc_length
    missing = np.where(np.abs(arc - 15.0) < 1.0, 0.03, 0.0)
    assert sink.deepen(arc, missing)
    depth = sink.at(arc)
    assert np.all(depth[missing > 0] > 0.03) and depth.max() < 1.001 * SINK_FACTOR * 0.03
    assert np.abs(depth[np.abs(arc - 15.0) > 10.0]).max() < 1e-6
    steps = np.diff(depth) / np.diff(arc)
    assert np.abs(steps).max() < 0.03 and np.abs(np.diff(steps)).max() < 2e-3
    assert sink.deepen(arc, missing)
    np.testing.assert_allclose(sink.at(arc), 2 * depth, atol=1e-12)


def test_missing_length_is_how_much_too_straight_the_straighter_leg_is():
    skeleton = default_model().skeleton
    thigh, shank = skeleton.lengths["thigh"], skeleton.lengths["shank"]

    def length(knee: float) -> float:
        return float(np.sqrt(thigh**2 + shank**2 + 2 * thigh * shank * np.cos(knee)))

    qpos = np.repeat(build_stance(skeleton, np.deg2rad(60)).qpos[None], 4, axis=0)
    left, right = (skeleton.qpos_of(f"shank_y.{side}") for side in "LR")
    qpos[1, left], qpos[2, right], qpos[3, left] = LEAST_KNEE, 0.1, 0.0
    reach_error = np.zeros((4, 2))
    reach_error[3, 0] = 0.05
    missing = missing_length(skeleton, PlannedPoses(qpos, qpos, qpos, qpos, reach_error))
    straightest = length(LEAST_KNEE)
    np.testing.assert_allclose(
        missing, [0.0, 0.0, length(0.1) - straightest, thigh + shank + 0.05 - straightest], atol=1e-12
    )


def test_legs_for_a_skier_stand_lower_by_the_sink_and_keep_the_asked_load(track):
    run = planned("paper_main", {"course.turn_count": 2})
    stance = build_stance(run.model.skeleton, np.deg2rad(60))
    line = dataclasses.make_dataclass("Flat", ["time", "arc_length", "pull", "body_frame"])(
        TIME, np.linspace(0.0, track.length, len(TIME)), ridden(0.0 * TIME).pull, ridden(0.0 * TIME).body_frame
    )
    sink = Sink(track)
    sink.deepen(track.arc_length, np.where(np.abs(track.arc_length - 15.0) < 1.0, 0.03, 0.0))
    asked = legs_for(run.spec, line, stance, sink)
    np.testing.assert_allclose(asked.rise, -sink.at(line.arc_length), atol=1e-12)
    assert (asked.length, asked.extension, asked.retraction) == (stance.height, stance.extension, stance.retraction)
    assert asked.least_load == run.spec.technique.load_min
