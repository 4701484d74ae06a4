"""The simulation as a job: in slices, with progress, and stopped with what is done kept."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.blender_tools import Context


@pytest.fixture
def spec(core, extension):
    run = core("blender.properties").preset_specs()["paper_main"]
    return run.with_overrides({"course.turn_count": 1, "course.turn_duration": 0.3, "course.transition_duration": 0.5})


@pytest.fixture
def jobs(core, spec):
    return core("blender.jobs")


def test_a_job_is_the_library_s_simulation(core, spec, jobs) -> None:
    pipeline = core("pipeline")
    want, _ = pipeline.run_simulation(pipeline.make_plan(spec))
    found = jobs.run_to_end(jobs.simulation_job(spec))
    np.testing.assert_allclose(found.qpos, want.qpos, atol=1e-9)
    assert found.status == "finished"


def test_progress_rises_to_the_end(spec, jobs) -> None:
    told = list(jobs.simulation_job(spec))
    fractions = [fraction for fraction, _ in told]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0.0
    assert 0.9 < fractions[-1] <= 1.0
    assert told[0][1] == "Planning"
    assert all(text for _, text in told)


def test_a_stopped_job_keeps_what_is_done(spec, jobs) -> None:
    job = jobs.simulation_job(spec)
    for _ in range(6):
        next(job)
    with pytest.raises(StopIteration) as stopped:
        job.send(True)
    recording = stopped.value.value
    assert recording.status == "cancelled"
    assert len(recording.time) == 5 * jobs.STEPS


def test_an_infeasible_run_fails_on_the_first_slice(core, spec, jobs) -> None:
    job = jobs.simulation_job(spec.with_overrides({"course.turn_radius": 4, "course.start_speed": 15}))
    next(job)
    with pytest.raises(core("errors").PlanInfeasible):
        next(job)


def test_a_runner_cleans_up_and_has_the_recording(spec, jobs) -> None:
    context = Context()
    runner = jobs.JobRunner(jobs.simulation_job(spec), context)
    assert jobs.RUNNING.text == "Planning"
    while runner.slice(context):
        assert jobs.RUNNING.text
    runner.close(context)
    assert runner.result.status == "finished"
    assert context.window_manager.open == []
    assert jobs.RUNNING.text == ""


def test_a_runner_that_is_stopped_has_the_part(spec, jobs, monkeypatch) -> None:
    monkeypatch.setattr(jobs, "SLICE_SECONDS", 0.0001)
    context = Context()
    runner = jobs.JobRunner(jobs.simulation_job(spec), context)
    for _ in range(4):
        assert runner.slice(context)
    runner.stop()
    runner.close(context)
    assert runner.result.status == "cancelled"
    assert 0 < len(runner.result.time) < 800
    assert context.window_manager.open == []
