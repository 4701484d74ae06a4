"""Pushed skiers: who steers stays up, and nobody who is not pushed is steered."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.simulation import summarise
from ski_addon.simulation.falls import FARTHEST_OFF
from ski_addon.spec import PushSpec
from tests.ski_runs import COARSE, simulated

SKIED = {**COARSE, "simulation.time_step": 0.004}
START, END = 0.5, 1.0


def pushed(body: str, direction: str, force: float, balance: str = "steering"):
    """In the middle of the first turn, a right one, for half a second."""
    push = (PushSpec(body, direction, force, START, END - START),)
    return simulated("paper_main", {**SKIED, "push": push, "technique.balance": balance})


@pytest.mark.slow  # a fall takes the solver many iterations
def test_a_push_that_fells_the_skier_who_only_tracks_is_survived_by_steering():
    tracked, steered = (pushed("abdomen", "left", 140.0, balance) for balance in ("tracking", "steering"))
    assert tracked.status == "fell" and steered.status == "finished"
    assert np.all(tracked.steering_offset == 0.0)
    offset = steered.track_offset[:, 0]
    assert 0.3 < offset.max() < 3.0, "to the left, from where the push went"
    assert abs(offset[-1]) < 0.5 * offset.max()
    assert steered.torque_ratio.max() <= 1.0 + 1e-12 and steered.joint_margin.min() >= 0.0


@pytest.mark.slow
def test_the_capture_margin_is_lost_by_who_falls():
    tracked = pushed("abdomen", "left", 140.0, "tracking")
    lost = tracked.time[np.argmax(tracked.capture_margin < 0.0)]
    assert tracked.status == "fell" and START < lost < tracked.time[-1]


def test_the_capture_margin_stays_positive_through_a_push_that_is_survived():
    steered = pushed("abdomen", "left", 200.0)
    assert steered.status == "finished" and steered.capture_margin.min() > 0.05
    summary = summarise(steered)
    assert summary["capture_margin_min_m"] == steered.capture_margin.min()
    assert summary["track_offset_max_m"] == np.abs(steered.track_offset[:, 0]).max()
    assert summary["zmp_margin_min_m"] == steered.zmp_margin.min()


def test_the_load_stays_between_the_edges_that_bear():
    assert pushed("abdomen", "left", 200.0).zmp_margin.min() > -1e-4


def test_the_skier_feels_the_push_and_nothing_else():
    recording = pushed("abdomen", "left", 200.0)
    during = (recording.time > START + 0.05) & (recording.time < END)
    before, after = recording.time < START, recording.time > END + 0.1
    error = np.linalg.norm((recording.disturbance - recording.push_force)[during], axis=1)
    assert np.median(error) < 0.05 * 200.0
    assert np.abs(recording.disturbance[before | after]).max() < 0.5


@pytest.mark.parametrize("body", ["ski.R", "shank.L"])
def test_a_ski_is_held_against_a_push_over_its_lifted_edges(body):
    recording = pushed(body, "right", 150.0)
    assert recording.status == "finished"
    assert np.abs(recording.track_offset).max() < 0.5


def test_nobody_who_is_not_pushed_is_steered():
    """Such a run is the same, step by step, as one that only tracks its plan."""
    steered, tracked = (
        simulated("paper_main", {**SKIED, "technique.balance": mode}) for mode in ("steering", "tracking")
    )
    assert np.all(steered.steering_offset == 0.0)
    np.testing.assert_allclose(steered.qpos, tracked.qpos, atol=1e-6)
    assert np.abs(steered.disturbance).max() < 1e-3
    assert np.abs(steered.track_offset).max() < 2e-3


def test_errors_are_from_the_plan_and_not_from_the_steered_line():
    recording = pushed("abdomen", "left", 200.0)
    far = np.argmax(recording.track_offset[:, 0])
    assert recording.ski_error[far] >= recording.track_offset[far, 0] - 0.01
    assert recording.ski_error.max() < FARTHEST_OFF
    distance = np.linalg.norm(recording.com - recording.com_reference, axis=1)
    np.testing.assert_allclose(recording.com_error, distance, atol=1e-9)
