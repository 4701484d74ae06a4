"""Runs that begin at rest and end in a stop: the skier gets going by gravity, brakes across the slope, and stands."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.body import forward_kinematics
from ski_addon.gravity import GRAVITY
from tests.ski_runs import planned, simulated

COARSE = {"course.turn_count": 1, "simulation.time_step": 0.002}
STOP = {**COARSE, "course.start_speed": 5, "course.target_speed": 6}
CASES = {
    "held turn on 20 degrees": ("steep", STOP),
    "from rest to a stop": ("steep", {**STOP, "course.start_speed": 0}),
    "out of a turn on 5 degrees": ("paper_main", {**COARSE, "course.finish": "stop", "course.start_speed": 6}),
}
REST = ("paper_main", {**COARSE, "course.entry": "straight", "course.start_speed": 0, "slope.angle_deg": 10})


def last(recording, seconds: float) -> np.ndarray:
    """Which of a recording's moments are its last."""
    return recording.time > recording.time[-1] - seconds


@pytest.mark.parametrize("case", CASES)
def test_stop_ends_with_a_skier_who_stands(case):
    recording = simulated(*CASES[case])
    standing = last(recording, 0.5)
    assert recording.status == "finished" and recording.solver_status.max() == 0
    assert recording.speed.max() > 5.0 and recording.speed[standing].max() < 0.12
    assert np.linalg.norm(np.ptp(recording.com[standing], axis=0)) < 0.05, "and stays where he is"
    weight = recording.header["mass"] * 9.81
    carried = recording.snow_force[standing].sum(axis=1)
    np.testing.assert_allclose(carried.mean(axis=0), [0.0, 0.0, weight], atol=0.03 * weight)


@pytest.mark.parametrize("case", CASES)
def test_standing_skier_is_upright_over_skis_across_the_slope(case):
    run, recording = planned(*CASES[case]), simulated(*CASES[case])
    standing = last(recording, 0.5)
    skeleton = run.model.skeleton
    position, rotation = forward_kinematics(skeleton, recording.qpos[standing])
    skis = [skeleton.body("ski.L"), skeleton.body("ski.R")]
    along = rotation[:, skis][..., 0]
    assert np.abs(np.sum(along * recording.track_tangent[standing][:, None], axis=2)).max() < 0.1
    over = recording.com[standing] - position[:, skis].mean(axis=1)
    assert np.linalg.norm(over[:, :2], axis=1).max() < 0.1 and over[:, 2].min() > 0.3 * skeleton.height
    assert rotation[:, 0, 2, 2].min() > 0.8, "the pelvis is upright"


@pytest.mark.parametrize("case", CASES)
def test_stop_brakes_about_as_hard_as_it_is_asked(case):
    """From 5 to 1.5 m/s on the whole; for moments a skier who keeps his balance brakes harder and less."""
    run, recording = planned(*CASES[case]), simulated(*CASES[case])
    braking = recording.arc_length > run.track.stop_from
    fast, slow = (recording.time[braking & (recording.speed > speed)].max() for speed in (5.0, 1.5))
    assert (5.0 - 1.5) / (slow - fast) == pytest.approx(run.spec.technique.stop_deceleration, rel=0.35)


@pytest.mark.parametrize("case", CASES)
def test_skier_who_stands_is_off_the_plan_only_along_the_skis_where_nothing_holds_him(case):
    recording = simulated(*CASES[case])
    standing = last(recording, 0.5)
    astray = recording.com[standing] - recording.com_reference[standing]
    assert np.abs(np.sum(astray * recording.track_tangent[standing], axis=1)).max() < 0.1
    assert np.abs(recording.track_offset[:, 0]).max() < 1.0 and recording.com_error.max() < 1.2


def test_skis_are_thrown_across_to_the_side_of_the_last_turn_and_a_mirrored_run_to_the_other():
    name, changes = CASES["out of a turn on 5 degrees"]
    right, left = (planned(name, {**changes, "course.first_turn": side}).plan for side in ("right", "left"))
    assert np.rad2deg(left.steering[-1]) == pytest.approx(-np.rad2deg(right.steering[-1]), abs=1e-6)
    assert np.rad2deg(abs(left.steering[-1])) == pytest.approx(90, abs=0.5)


def test_start_from_rest_glides_off_by_gravity_and_turns_when_it_is_fast_enough():
    run, recording = planned(*REST), simulated(*REST)
    assert recording.status == "finished" and recording.speed[0] < 0.05
    gain = run.track.tangent[0] @ GRAVITY - run.spec.snow.friction * 9.81 * np.cos(np.radians(10))
    early = recording.time < 1.0
    np.testing.assert_allclose(recording.speed[early], gain * recording.time[early], atol=0.02)
    turning = np.flatnonzero(recording.phase)[0]
    assert recording.speed[turning] > 4.0 and np.abs(recording.curvature[recording.speed < 3.5]).max() < 1e-6
    assert recording.ski_error.max() < 0.005 and recording.com_error.max() < 0.005


def test_start_from_rest_at_the_top_of_a_run_that_stops_is_followed_as_planned_until_it_brakes():
    run, recording = planned(*CASES["from rest to a stop"]), simulated(*CASES["from rest to a stop"])
    before = recording.arc_length < run.track.stop_from
    assert np.count_nonzero(before) > 1000
    assert recording.ski_error[before].max() < 0.01 and recording.com_error[before].max() < 0.01
