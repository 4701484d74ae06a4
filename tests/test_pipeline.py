"""The one flow: what is refused, that a plan depends on its document only, and that both ways to ski it agree."""

from __future__ import annotations

import dataclasses
import re

import numpy as np
import pytest

from ski_addon.errors import PlanInfeasible, SpecError
from ski_addon.pipeline import make_plan, run_simulation, start_simulation
from ski_addon.results import plan_lines, plan_summary
from ski_addon.simulation.recording import array_names
from ski_addon.spec import RunSpec, estimate, list_presets
from tests.ski_runs import planned, preset

RUNS = tuple(
    preset.identifier for preset in list_presets("runs") if RunSpec.from_toml(preset.path).figure.kind == "alpine"
)
"""Runs with the whole physics; other figures are for the preview."""
LIVELY = ("giant_slalom", "medium_carving", "short_turns")
SHORT = {"course.turn_count": 1, "course.turn_duration": 0.3, "course.transition_duration": 0.4}
"""A run of 0.3 s: the simulation starts within its only turn."""


def lean(plan) -> float:
    """Most lean of a plan [deg]."""
    return float(np.rad2deg(np.abs(plan.inclination).max()))


def arrays(value) -> dict[str, np.ndarray]:
    """The arrays of a frozen dataclass."""
    named = {field.name: getattr(value, field.name) for field in dataclasses.fields(value)}
    return {name: array for name, array in named.items() if isinstance(array, np.ndarray)}


def refusal(spec: RunSpec) -> PlanInfeasible:
    with pytest.raises(PlanInfeasible) as caught:
        make_plan(spec)
    return caught.value


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [
        ("course", "turn_radius", 1.0),
        ("skier", "mass", float("nan")),
        ("slope", "angle_deg", "steep"),
        ("snow", "friction", True),
    ],
)
def test_document_is_checked_before_anything_is_planned(monkeypatch, section, key, value):
    def never(*_):
        raise AssertionError("planned a document that is wrong")

    for step in ("build_terrain", "build_track", "build_skier_model", "plan_motion"):
        monkeypatch.setattr(f"ski_addon.pipeline.{step}", never)
    spec = preset("paper_main")
    wrong = dataclasses.replace(spec, **{section: dataclasses.replace(getattr(spec, section), **{key: value})})
    with pytest.raises(SpecError, match=f"{section}.{key} = "):
        make_plan(wrong)


@pytest.mark.parametrize("name", RUNS)
def test_every_shipped_run_can_be_planned_within_its_own_limit(name):
    run = planned(name)
    assert lean(run.plan) <= run.spec.technique.inclination_max_deg
    rough = 0.05 if run.spec.course.kind == "turns" else 0.25  # only turns are asked for by their duration
    assert run.plan.duration == pytest.approx(estimate(run.spec).simulated_seconds, rel=rough)
    moving = run.plan.arc_length < run.track.stop_from
    assert np.all(run.plan.speed[moving] > 1.0) and np.all(run.plan.load > 0.0)
    assert (run.plan.speed[-1] < 0.02) == (run.spec.course.finish == "stop")
    assert all(np.all(np.isfinite(array)) for array in arrays(run.plan).values())


@pytest.mark.parametrize("name", LIVELY)
def test_lively_runs_lean_as_much_as_lively_skiing_does(name):
    assert 25.0 <= lean(planned(name).plan) <= 45.0


def test_beginners_lean_less_than_anybody_in_a_lively_run():
    assert lean(planned("beginner_turns").plan) < min(lean(planned(name).plan) for name in LIVELY)
    assert lean(planned("beginner_turns").plan) < 25.0


@pytest.mark.parametrize(
    "name", [name for name in RUNS if re.search("degrees of lean|leaning", preset(name).description)]
)
def test_lean_in_a_runs_description_is_the_planned_one(name):
    stated = float(re.search(r"(\d+) degrees", preset(name).description)[1])
    assert lean(planned(name).plan) == pytest.approx(stated, abs=2.5)


def test_wider_turns_of_the_paper_need_less_lean():
    leans = [lean(planned(name).plan) for name in ("paper_r10", "paper_main", "paper_r25")]
    assert leans == sorted(leans, reverse=True)


@pytest.mark.parametrize("name", ["giant_slalom", "short_turns", "paper_r10"])
def test_following_the_refusals_leads_to_a_run(name):
    """A refusal says the speed that is needed at its place; starting slower by as much energy gives it there."""
    spec = preset(name, {"course.turn_count": 3, "technique.inclination_max_deg": 45})
    start = 1.6 * spec.course.start_speed
    refusals = 0
    while refusals <= 4:
        try:
            run = make_plan(spec.with_overrides({"course.start_speed": start}))
            break
        except PlanInfeasible as error:
            refusals += 1
            assert re.match(r"(turn|the transition after turn) [123] \(\d+\.\d m, \d+\.\d s\)$", error.place)
            had = float(re.search(r"at ([\d.]+) m/s it needs", str(error))[1])
            assert 0.0 < error.speed < had and f"{spec.technique.inclination_max_deg:g}" in str(error)
            start = 0.99 * np.sqrt(start**2 - had**2 + error.speed**2)
    assert 1 <= refusals <= 3
    assert 35.0 < lean(run.plan) <= 45.0


def test_limit_refuses_what_is_past_it_and_nothing_else():
    run = planned("medium_carving", {"course.turn_count": 2})
    most = lean(run.plan)
    above = run.spec.with_overrides({"technique.inclination_max_deg": most + 0.01})
    assert lean(make_plan(above).plan) == most
    error = refusal(run.spec.with_overrides({"technique.inclination_max_deg": most - 0.1}))
    steepest = int(np.abs(run.plan.inclination).argmax())
    assert f"turn {run.plan.turn[steepest]} ({run.plan.arc_length[steepest]:.1f} m" in error.place
    assert 0.9 * run.plan.speed[steepest] < error.speed < run.plan.speed[steepest]


def test_plan_depends_on_the_document_only_not_on_how_it_was_made():
    changes = {"course.turn_radius": 12.0, "skier.mass": 80.0, "snow.friction": 0.03, "technique.angulation": -0.3}
    base = preset("paper_main", SHORT)
    forwards = backwards = base
    for key, value in changes.items():
        forwards = forwards.with_overrides({key: value})
    for key, value in reversed(changes.items()):
        backwards = backwards.with_overrides({key: str(value)})
    written = RunSpec.from_text(forwards.to_toml())
    plans = [arrays(make_plan(spec).plan) for spec in (forwards, backwards, written)]
    for plan in plans[1:]:
        for name, array in plans[0].items():
            assert array.tobytes() == plan[name].tobytes(), name


def test_keys_that_the_motion_does_not_depend_on_leave_the_plan_alone():
    base = preset("paper_main", SHORT)
    other = base.with_overrides({"name": "x", "bake.fps": 60, "simulation.seed": 3, "simulation.time_step": 0.002})
    first, second = (arrays(make_plan(spec).plan) for spec in (base, other))
    assert all(first[name].tobytes() == second[name].tobytes() for name in first)


def test_all_that_is_planned_is_read_only_and_of_one_length():
    run = planned("paper_main", SHORT)
    for value in (run.plan, run.track):
        count = len(value.arc_length)
        for name, array in arrays(value).items():
            assert len(array) == count, name
            with pytest.raises(ValueError, match="read-only"):
                array[0] = 0
    with pytest.raises(dataclasses.FrozenInstanceError):
        run.plan = None


@pytest.mark.parametrize(("name", "near"), [("paper_main", 2e-4), ("slalom", 2e-3), ("bumps", 2e-3)])
def test_plan_keeps_the_frames_of_its_track_at_its_own_places(name, near):
    """The plan's places are even in planned time, the track's are not: between them nothing else is interpolated."""
    run = planned(name, {"course.finish": "glide"})  # one who stops leaves some track over
    plan, track = run.plan, run.track
    assert np.ptp(np.diff(plan.time)) < 1e-9 < np.ptp(np.diff(plan.arc_length))
    assert (plan.arc_length[0], plan.arc_length[-1]) == pytest.approx((0.0, track.length), abs=1e-6)
    for key in ("position", "tangent", "surface_normal", "curvature"):
        there = getattr(track, key).reshape(len(track.arc_length), -1)
        between = np.stack([np.interp(plan.arc_length, track.arc_length, column) for column in there.T], axis=1)
        np.testing.assert_allclose(getattr(plan, key).reshape(between.shape), between, atol=near, err_msg=key)
    place = np.searchsorted(track.arc_length, plan.arc_length, side="right") - 1
    np.testing.assert_array_equal(plan.phase, track.phase[place])
    np.testing.assert_array_equal(plan.turn, track.turn[place])
    np.testing.assert_allclose(run.terrain.height(*plan.position[:, :2].T), plan.position[:, 2], atol=1e-6)


@pytest.fixture(scope="module")
def short_run():
    run = planned("paper_main", SHORT)
    return run, *run_simulation(run)


def test_stepping_by_hand_gives_the_recording_of_the_whole_run(short_run):
    run, recording, step_seconds = short_run
    simulation = start_simulation(run)
    assert simulation.step_done == 0 and simulation.fraction == 0.0 and simulation.running
    chunks = 0
    while simulation.advance(37):
        chunks += 1
        assert simulation.step_done == 37 * chunks and 0.0 < simulation.fraction < 1.0
    assert not simulation.advance(1) and simulation.fraction == 1.0
    by_hand = simulation.recording()
    assert by_hand.header == recording.header and recording.status == "finished"
    for name in array_names():
        assert getattr(by_hand, name).tobytes() == getattr(recording, name).tobytes(), name
    assert len(step_seconds) == len(recording.time) == simulation.step_done


def test_recording_carries_its_document(short_run):
    run, recording, _ = short_run
    assert RunSpec.from_text(recording.header["spec"]) == run.spec
    assert recording.header["spec_hash"] == run.spec.content_hash()
    assert recording.duration == pytest.approx(run.plan.duration, abs=0.02)


def test_progress_rises_and_names_the_work(short_run):
    heard = []
    run_simulation(short_run[0], lambda fraction, text: heard.append((fraction, text)))
    fractions = [fraction for fraction, _ in heard]
    assert fractions == sorted(fractions) and fractions[0] > 0.0 and fractions[-1] < 1.0
    assert all(re.fullmatch(r"simulating \d\.\d of 0\.3 s", text) for _, text in heard)


def test_run_cancelled_by_its_progress_keeps_what_was_skied(short_run):
    run, recording, _ = short_run
    cancelled, seconds = run_simulation(run, lambda fraction, text: fraction < 0.5)
    count = len(cancelled.time)
    assert cancelled.status == "cancelled" and 0.4 * len(recording.time) < count < 0.8 * len(recording.time)
    assert len(seconds) == count
    for name in array_names():
        assert getattr(cancelled, name).tobytes() == getattr(recording, name)[:count].tobytes(), name


def test_summary_of_a_plan_is_its_numbers():
    run = planned("paper_main", SHORT)
    summary = plan_summary(run.spec)
    assert summary["inclination_max_deg"] == lean(run.plan) and summary["spec_hash"] == run.spec.content_hash()
    assert (summary["length_m"], summary["duration_s"]) == (run.plan.length, run.plan.duration)
    assert (summary["speed_min"], summary["speed_max"]) == (run.plan.speed.min(), run.plan.speed.max())
    lines = "\n".join(plan_lines(summary))
    for said in (f"{run.plan.length:.0f} m in {run.plan.duration:.1f} s", f"leans up to {lean(run.plan):.0f} degrees"):
        assert said in lines
