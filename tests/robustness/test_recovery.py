"""Distance from the plan, and the time until a skier is back on it."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ski_addon.robustness.recovery import Deviation, measure_deviation, recovery_time
from tests.ski_runs import COARSE, planned, simulated

TIME = np.arange(0.0, 4.0, 0.01)


@pytest.fixture(scope="module")
def undisturbed():
    run, recording = planned("paper_main", COARSE), simulated("paper_main", COARSE)
    return run, recording, measure_deviation(recording, run.plan, run.model.skeleton)


def test_an_undisturbed_run_is_at_baseline_all_the_time(undisturbed):
    _, recording, deviation = undisturbed
    assert deviation.at_baseline.all()
    assert recovery_time(recording.time, deviation.at_baseline, 1.0) == pytest.approx(0.0, abs=1e-9)


def test_corner_error_is_the_recorded_one_when_the_reference_is_the_plan(undisturbed):
    _, recording, deviation = undisturbed
    np.testing.assert_allclose(deviation.corner, recording.ski_error, atol=5e-4)


def test_moving_the_skier_aside_is_measured_in_every_distance(undisturbed):
    run, recording, before = undisturbed
    left = np.cross(recording.surface_normal, recording.track_tangent)
    qpos = recording.qpos.copy()
    qpos[:, :3] += 0.2 * left
    moved = dataclasses.replace(recording, qpos=qpos, com=recording.com + 0.2 * left)
    deviation = measure_deviation(moved, run.plan, run.model.skeleton)
    np.testing.assert_allclose(deviation.track_offset - before.track_offset, 0.2, atol=1e-5)
    np.testing.assert_allclose(deviation.com_offset - before.com_offset, 0.2, atol=1e-5)
    np.testing.assert_allclose(deviation.corner, 0.2, atol=0.01)
    np.testing.assert_allclose(deviation.pelvis, before.pelvis, atol=1e-6)
    assert not deviation.at_baseline.any()


def test_turning_the_pelvis_is_measured(undisturbed):
    run, recording, _ = undisturbed
    qpos = recording.qpos.copy()
    angle = np.deg2rad(6.0)
    for i, (w, x, y, z) in enumerate(qpos[:, 3:7]):  # times a rotation about its own z axis
        c, s = np.cos(angle / 2), np.sin(angle / 2)
        qpos[i, 3:7] = (w * c - z * s, x * c + y * s, y * c - x * s, z * c + w * s)
    deviation = measure_deviation(dataclasses.replace(recording, qpos=qpos), run.plan, run.model.skeleton)
    np.testing.assert_allclose(deviation.pelvis, angle, atol=0.03)


def test_steps_before_the_first_are_left_out(undisturbed):
    run, recording, whole = undisturbed
    late = measure_deviation(recording, run.plan, run.model.skeleton, first=500)
    np.testing.assert_allclose(late.corner, whole.corner[500:], atol=1e-12)


@pytest.mark.parametrize("field", ["corner", "track_offset", "com_offset", "pelvis"])
def test_every_distance_alone_keeps_a_skier_from_baseline(field):
    zero = {name: np.zeros(3) for name in ("corner", "track_offset", "com_offset", "pelvis")}
    assert Deviation(**zero).at_baseline.all()
    assert not Deviation(**{**zero, field: np.full(3, 0.2)}).at_baseline.any()
    if field != "pelvis" and field != "corner":
        assert not Deviation(**{**zero, field: np.full(3, -0.2)}).at_baseline.any()


@pytest.mark.parametrize(
    ("away", "since", "expected"),
    [
        ([], 1.0, 0.0),
        ([(0.5, 1.5)], 1.0, 0.5),
        ([(0.5, 1.5), (1.6, 2.0)], 1.0, 1.0),  # 0.1 s at baseline is not long enough
        ([(0.5, 1.5), (1.9, 2.0)], 1.0, 0.5),
        ([(0.5, 0.9)], 1.0, 0.0),
        ([(0.5, 5.0)], 1.0, None),
        ([(0.5, 3.8)], 1.0, None),  # too late to be held for 0.3 s
        ([(0.5, 3.7)], 1.0, 2.7),
    ],
)
def test_time_to_recover(away, since, expected):
    at_baseline = np.ones(len(TIME), dtype=bool)
    for begin, end in away:
        at_baseline[(begin - 1e-9 <= TIME) & (end - 1e-9 > TIME)] = False
    found = recovery_time(TIME, at_baseline, since)
    assert found == (None if expected is None else pytest.approx(expected, abs=0.011))


def test_a_run_of_one_step_has_not_recovered():
    assert recovery_time(np.zeros(1), np.ones(1, dtype=bool), 0.0) is None
