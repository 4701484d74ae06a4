"""Shipped gate courses, simulated: nobody falls and every gate is passed as asked."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.pipeline import make_plan, run_simulation
from ski_addon.simulation import Recording, recorded_gates
from ski_addon.spec import RunSpec
from ski_addon.terrain import build_terrain
from tests.ski_runs import planned, preset, simulated

COURSES = {
    "slalom": 20,
    "uneven_slalom": 20,
    "giant_slalom_race": 15,
    "rolling_slalom": 20,
    "rolling_giant_slalom": 15,
}
"""Preset -> number of its gates."""
ROLLING = ("rolling_slalom", "rolling_giant_slalom")


def assert_gates_are_passed_as_asked(recording: Recording, count: int, stop_from: float) -> None:
    """Nobody fell, and both skis passed every pole on its side, 5 cm at most nearer or farther than asked.

    From `stop_from` [m] on skis lie across the way and slide: nothing holds them on a line there.
    """
    assert recording.status == "finished"
    assert recording.ski_error[recording.arc_length < stop_from].max() <= 0.010
    passing = recorded_gates(recording)
    assert len(passing.gates) == count and passing.passed.all()
    np.testing.assert_allclose(passing.distance, passing.gates.distance, atol=0.05)


def assert_skied_as_a_strong_skier_could(recording: Recording) -> None:
    """Within the body's limits and pressed on the snow all the time."""
    assert recording.torque_ratio.max() <= 1.0 and recording.joint_margin.min() >= 0.0
    assert np.all(recording.solver_status == 0) and recording.capture_margin.min() > 0.2
    load = np.linalg.norm(recording.snow_force.sum(axis=1), axis=1) / (recording.header["mass"] * 9.81)
    assert load.min() > 0.4 and load.max() < 2.2


def steepness(spec: RunSpec, length: float) -> np.ndarray:
    """Angle of the ground [degrees] along the fall line, over the length [m] of a course."""
    down = np.linspace(0.0, length, 1000)
    normal = build_terrain(spec.slope).normal(down, 0.0 * down)
    return np.degrees(np.arctan2(normal[:, 0], normal[:, 2]))


@pytest.mark.slow
@pytest.mark.parametrize("name", COURSES)
def test_every_gate_of_a_shipped_course_is_passed_on_its_side_at_its_distance(name):
    assert_gates_are_passed_as_asked(simulated(name), COURSES[name], planned(name).track.stop_from)


@pytest.mark.slow
@pytest.mark.parametrize("name", COURSES)
def test_shipped_courses_are_skied_within_human_limits_at_the_speed_that_was_asked(name):
    recording = simulated(name)
    assert_skied_as_a_strong_skier_could(recording)
    last_gate = recorded_gates(recording).gates.position[-1, 0]
    assert recording.speed[recording.com[:, 0] < last_gate].max() <= 1.1 * planned(name).spec.course.target_speed


@pytest.mark.slow
@pytest.mark.parametrize(("name", "count", "length"), [("slalom", 20, 210.0), ("giant_slalom_race", 15, 370.0)])
def test_gates_on_waves_of_five_degrees_are_passed_all_the_same(name, count, length, tmp_path):
    """A grid of waves of 40 m: ten degrees and twenty, again and again, which no line of the shipped hill has."""
    down = np.arange(-20.0, 520.0, 1.0)
    wave = np.tan(np.radians(5.0)) * 40.0 / (2.0 * np.pi) * np.sin(2.0 * np.pi * down / 40.0)
    grid = tmp_path / "waves.npz"
    np.savez(grid, height=np.repeat(wave[:, None], 61, axis=1), spacing=1.0, origin=[-20.0, -30.0])
    spec = preset(name, {"slope.kind": "grid", "slope.grid_file": str(grid), "course.finish": "glide"})
    found = steepness(spec, length)
    assert found.min() == pytest.approx(10.0, abs=0.5) and found.max() == pytest.approx(20.0, abs=0.5)
    run = make_plan(spec)
    recording = run_simulation(run)[0]
    assert_gates_are_passed_as_asked(recording, count, run.track.stop_from)
    assert_skied_as_a_strong_skier_could(recording)


@pytest.mark.parametrize("name", ROLLING)
def test_rolling_courses_are_on_fifteen_degrees_that_change(name):
    spec = preset(name)
    found = steepness(spec, 340.0 if spec.course.gate_setting == "giant_slalom" else 200.0)
    assert spec.slope.kind == "grid" and np.mean(found) == pytest.approx(15.0, abs=0.5)
    assert found.min() < 11.0 and found.max() > 17.0
