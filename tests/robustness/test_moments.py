"""When pushes start, and courses long enough to recover on."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from ski_addon.errors import SpecError
from ski_addon.robustness import moments
from ski_addon.robustness.moments import HOLD, SETTLE, SPARE, WATCH, find_apexes, find_changes, prepare
from tests.ski_runs import planned, preset

QUICK = {"course.turn_duration": 0.3, "course.transition_duration": 0.4, "simulation.time_step": 0.002}
BOTH = ("turn", "transition")


@pytest.fixture(scope="module")
def prepared():
    return prepare(preset("paper_main", {**QUICK, "course.turn_count": 1}), 8.0, 0.5, BOTH)


def test_apexes_are_the_middles_of_turns_of_constant_radius():
    plan = planned("paper_main", {"course.turn_count": 3, "course.start_speed": 8}).plan
    np.testing.assert_allclose(plan.time[find_apexes(plan)], [0.5, 3.0, 5.5], atol=0.1)
    np.testing.assert_array_equal(plan.phase[find_apexes(plan)], [-1, 1, -1])


def test_changes_are_where_the_curvature_changes_sign():
    plan = planned("paper_main", {"course.turn_count": 3, "course.start_speed": 8}).plan
    found = find_changes(plan)
    np.testing.assert_allclose(plan.time[found], [1.75, 4.25], atol=0.1)
    np.testing.assert_allclose(plan.curvature[found], 0.0, atol=1e-3)


def test_a_turn_of_changing_radius_has_its_apex_where_it_is_tightest():
    plan = planned("paper_main", {"course.turn_count": 1, "course.start_speed": 8}).plan
    bend = np.linspace(0.5, 1.0, len(plan.time)) * plan.curvature
    bend[len(bend) // 3] *= 3.0
    assert find_apexes(dataclasses.replace(plan, curvature=bend)).tolist() == [len(bend) // 3]


def test_a_straight_between_two_turns_changes_in_its_middle():
    plan = planned("paper_main", {"course.turn_count": 2, "course.start_speed": 8}).plan
    bend = np.where(np.abs(plan.time - 1.75) < 0.3, 0.0, plan.curvature)
    (found,) = find_changes(dataclasses.replace(plan, curvature=bend))
    assert plan.time[found] == pytest.approx(1.75, abs=0.02)


def test_a_course_of_turns_is_made_long_enough(prepared):
    plan = prepared.planned.plan
    assert prepared.planned.spec.course.turn_count > 1 and prepared.planned.spec.course.start_speed == 8.0
    for moment in BOTH:
        start = prepared.start(moment)
        assert SETTLE <= start <= plan.duration - 0.5 - WATCH - HOLD - SPARE
        assert start / 0.002 == pytest.approx(round(start / 0.002), abs=1e-9)
        assert start == pytest.approx(plan.time[prepared.places[moment]], abs=0.001)
    assert plan.phase[prepared.places["turn"]] != 0 and plan.phase[prepared.places["transition"]] == 0


def test_a_long_course_stays_as_it_is():
    spec = preset("paper_main", {**QUICK, "course.turn_count": 20})
    assert prepare(spec, 8.0, 0.5, ("turn",)).planned.spec.course.turn_count == 20


def test_pushes_of_the_run_document_are_left_out():
    push = {"body": "head", "direction": "left", "force": 100, "start": 1}
    assert prepare(preset("paper_main", {**QUICK, "push": [push]}), 8.0, 0.5, ("turn",)).planned.spec.push == ()


def test_a_course_without_a_fitting_moment_is_refused(monkeypatch):
    monkeypatch.setattr(moments, "SETTLE", 20.0)
    monkeypatch.setattr(moments, "WATCH", -20.0)
    with pytest.raises(SpecError) as caught:
        prepare(preset("paper_main", {**QUICK, "course.turn_count": 2}), 8.0, 0.5, ("turn",))
    assert "course has no turn from 20 s after its start" in str(caught.value)
