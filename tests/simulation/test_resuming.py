"""Going on with a run from a moment of its recording: the same run, a longer one, and what cannot be."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.errors import SpecError
from ski_addon.pipeline import make_plan, resume_simulation, run_simulation, start_simulation
from ski_addon.spec import RunSpec, find_document

SHORT = {"course.turn_count": 2, "course.turn_duration": 0.6, "course.transition_duration": 0.6}


@pytest.fixture(scope="module")
def spec() -> RunSpec:
    return RunSpec.from_toml(find_document("paper_main")).with_overrides(SHORT)


@pytest.fixture(scope="module")
def whole(spec):
    return run_simulation(make_plan(spec))[0]


def finish(simulation):
    while simulation.advance(100):
        pass
    return simulation.recording()


def test_a_run_goes_on_where_it_was(spec, whole) -> None:
    simulation = resume_simulation(make_plan(spec), whole, 0.6)
    assert simulation.step_done == 600
    again = finish(simulation)
    assert again.status == "finished"
    np.testing.assert_array_equal(again.qpos[:600], whole.qpos[:600])
    np.testing.assert_allclose(again.qpos[600], whole.qpos[600], atol=1e-12)
    size = min(len(again.time), len(whole.time))
    assert abs(len(again.time) - len(whole.time)) <= 2
    np.testing.assert_allclose(np.diff(again.time), spec.simulation.time_step, atol=1e-9)
    assert np.abs(again.com[:size] - whole.com[:size]).max() < 0.005


def test_a_cancelled_run_is_brought_to_its_end(spec, whole) -> None:
    simulation = start_simulation(make_plan(spec))
    simulation.advance(500)
    part = simulation.recording()
    assert part.status == "cancelled"
    done = finish(resume_simulation(make_plan(spec), part, float(part.time[-1])))
    assert done.status == "finished"
    assert np.linalg.norm(done.com[-1] - whole.com[-1]) < 0.02


def test_a_run_is_made_longer(spec, whole) -> None:
    """Two more turns: the way up to the resumed moment is that of the recording."""
    longer = spec.with_overrides({"course.turn_count": 4})
    planned = make_plan(longer)
    done = finish(resume_simulation(planned, whole, 0.8))
    assert done.status == "finished"
    assert done.duration > whole.duration + 1.5
    np.testing.assert_array_equal(done.com[:800], whole.com[:800])
    speed = np.linalg.norm(np.diff(done.com, axis=0), axis=1) / spec.simulation.time_step
    assert np.abs(np.diff(speed)).max() < 0.05  # no jump where it goes on
    assert done.header["spec_hash"] == longer.content_hash()


def test_another_skier_cannot_go_on(spec, whole) -> None:
    planned = make_plan(spec.with_overrides({"skier.mass": 70.0}))
    with pytest.raises(SpecError, match="skier is another one than in the recording"):
        resume_simulation(planned, whole, 0.6)


def test_another_time_step_cannot_go_on(spec, whole) -> None:
    planned = make_plan(spec.with_overrides({"simulation.time_step": 0.002}))
    with pytest.raises(
        SpecError, match=r"simulation\.time_step = 0\.002 is not that of the recording: set it to 0\.001"
    ):
        resume_simulation(planned, whole, 0.6)


@pytest.mark.parametrize("time", [-1.0, 0.0, 99.0, float("nan")])
def test_there_must_be_such_a_moment(spec, whole, time) -> None:
    with pytest.raises(SpecError, match="resume time"):
        resume_simulation(make_plan(spec), whole, time)


def test_a_course_that_leads_elsewhere_is_refused_with_the_place(spec, whole) -> None:
    planned = make_plan(spec.with_overrides({"course.first_turn": "left"}))
    with pytest.raises(SpecError, match="the changed course leads .* beside the skier at .* the two part at"):
        resume_simulation(planned, whole, float(whole.time[-1]))
