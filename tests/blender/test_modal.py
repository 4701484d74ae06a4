"""Simulate with a window: slices on the timer, Esc keeps the part, failures clean up. The window is a stand-in."""

from __future__ import annotations

from importlib import import_module
from types import SimpleNamespace
from typing import Any

import pytest

from tests.blender.blender_tools import Context, Event


class Operator:
    """Stands for the running operator: Blender makes those itself."""

    _after = None

    def __init__(self, kind: type, skier: str, spec: Any, runner: Any) -> None:
        self._skier, self._spec, self._runner = skier, spec, runner
        self.reports: list[tuple[set, str]] = []
        self._kind = kind

    def report(self, level: set, text: str) -> None:
        self.reports.append((level, text))

    def __getattr__(self, name: str) -> Any:
        return getattr(self._kind, name).__get__(self)


@pytest.fixture
def spec(core, scene):
    run = core("blender.properties").preset_specs()["paper_main"]
    return run.with_overrides({"course.turn_count": 1, "course.turn_duration": 0.3, "course.transition_duration": 0.5})


@pytest.fixture
def start(core, extension, scene, ski):
    """Starts an operator on a run and returns (operator, context)."""
    kind = import_module(f"{extension}.operators.simulate").SKI_OT_simulate
    jobs = core("blender.jobs")

    def started(spec):
        context = Context(scene)
        return Operator(kind, ski.id_data.name, spec, jobs.JobRunner(jobs.simulation_job(spec), context)), context

    yield started
    jobs.RUNNING.text = ""


def run_to_end(operator, context) -> set:
    for _ in range(10_000):
        result = operator.modal(context, Event("TIMER"))
        if result != {"RUNNING_MODAL"}:
            return result
    raise AssertionError("the operator never ended")


def test_the_timer_drives_it_to_the_end(core, ski, spec, start) -> None:
    operator, context = start(spec)
    assert run_to_end(operator, context) == {"FINISHED"}
    assert ski.simulation_text.startswith("Skied to the end")
    assert core("blender.cache").load_recording(ski.recording).status == "finished"
    assert operator.reports[-1][0] == {"INFO"}
    assert context.window_manager.open == []
    assert core("blender.jobs").RUNNING.text == ""


def test_other_events_pass_through(spec, start) -> None:
    operator, context = start(spec)
    for kind in ("MOUSEMOVE", "LEFTMOUSE", "G", "SPACE"):
        assert operator.modal(context, Event(kind, "PRESS")) == {"PASS_THROUGH"}
    assert operator.modal(context, Event("ESC", "RELEASE")) == {"PASS_THROUGH"}
    operator.cancel(context)


def test_escape_keeps_what_is_done(core, ski, spec, start, monkeypatch) -> None:
    monkeypatch.setattr(core("blender.jobs"), "SLICE_SECONDS", 0.001)
    operator, context = start(spec)
    for _ in range(3):
        assert operator.modal(context, Event("TIMER")) == {"RUNNING_MODAL"}
    assert operator.modal(context, Event("ESC", "PRESS")) == {"FINISHED"}
    assert ski.simulation_failed
    assert ski.simulation_text.startswith("Stopped after")
    assert core("blender.cache").load_recording(ski.recording).status == "cancelled"
    assert operator.reports[-1][0] == {"WARNING"}
    assert context.window_manager.open == []


def test_escape_before_the_first_step_keeps_nothing(ski, spec, start) -> None:
    operator, context = start(spec)
    assert operator.modal(context, Event("ESC", "PRESS")) == {"CANCELLED"}
    assert ski.recording == ""
    assert "before the first step" in operator.reports[-1][1]
    assert context.window_manager.open == []


def test_an_infeasible_run_is_said_and_cleaned_up(core, ski, spec, start) -> None:
    operator, context = start(spec.with_overrides({"course.turn_radius": 4, "course.start_speed": 15}))
    assert run_to_end(operator, context) == {"CANCELLED"}
    assert operator.reports[-1][0] == {"ERROR"}
    assert "cannot be skied at turn 1" in ski.simulation_text
    assert context.window_manager.open == []
    assert core("blender.jobs").RUNNING.text == ""


def test_an_unexpected_failure_is_cleaned_up_too(core, spec, start, monkeypatch) -> None:
    operator, context = start(spec)
    monkeypatch.setattr(core("pipeline"), "start_simulation", lambda _planned: 1 / 0)
    assert run_to_end(operator, context) == {"CANCELLED"}
    assert "ZeroDivisionError" in operator.reports[-1][1]
    assert context.window_manager.open == []


def test_blender_may_end_it(core, spec, start) -> None:
    """Another file is opened while it runs."""
    operator, context = start(spec)
    operator.modal(context, Event("TIMER"))
    operator.cancel(context)
    assert context.window_manager.open == []
    assert core("blender.jobs").RUNNING.text == ""
    operator.cancel(context)  # once more does no harm


def test_a_second_one_cannot_be_started(core, extension, spec, start) -> None:
    import bpy

    operator, context = start(spec)
    assert not bpy.ops.ski.simulate.poll()
    assert not bpy.ops.ski.bake.poll()
    operator.cancel(context)
    assert bpy.ops.ski.simulate.poll()


def test_a_skier_that_was_removed_meanwhile_is_named(ski, spec, start) -> None:
    import bpy

    operator, context = start(spec)
    bpy.data.objects.remove(ski.id_data)
    assert run_to_end(operator, context) == {"CANCELLED"}
    assert "was removed or renamed meanwhile" in operator.reports[-1][1]
    assert context.window_manager.open == []


def test_progress_is_shown_in_the_status_bar_too(spec, start, monkeypatch, core) -> None:
    monkeypatch.setattr(core("blender.jobs"), "REDRAW_SECONDS", 0.0)
    operator, context = start(spec)
    said: list[Any] = []
    context.workspace = SimpleNamespace(status_text_set=said.append)
    run_to_end(operator, context)
    assert any("s skied" in text and "Esc" in text for text in said[:-1])
    assert said[-1] is None  # the status bar is Blender's again
