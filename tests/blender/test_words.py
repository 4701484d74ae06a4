"""What the sidebar says: short lines with the numbers that matter."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture
def words(core, extension):
    return core("blender.words")


def recording(status: str = "finished", detail: dict | None = None, steps: int = 100) -> SimpleNamespace:
    force = np.zeros((steps, 2, 3))
    force[:, :, 2] = 0.6 * 9.81 * 50.0
    return SimpleNamespace(
        header={"status": status, "status_detail": detail or {}, "mass": 50.0},
        time=np.arange(steps) * 0.1,
        duration=0.1 * steps,
        speed=np.linspace(4.0, 9.04, steps),
        inclination=np.radians(np.linspace(-31.0, 12.0, steps)),
        snow_force=force,
    )


def test_a_finished_run(words) -> None:
    assert words.recording_lines(recording()) == [
        "Skied to the end in 10 s",
        "Speed 4.0 to 9.0 m/s",
        "Leans up to 31°",
        "Snow force up to 1.20 body weights",
    ]


def test_a_fall_says_where_when_and_why(words) -> None:
    detail = {"time": 4.21, "where": 31.4, "what": "the pelvis tipped over", "why": "thigh_x.L was at its torque limit"}
    assert words.ending(recording("fell", detail)) == (
        "Fell at 4.2 s, 31 m: the pelvis tipped over; thigh_x.L was at its torque limit"
    )


def test_a_stopped_run(words) -> None:
    assert words.ending(recording("cancelled", steps=34)) == "Stopped after 3.4 s of skiing"


def test_a_diverged_run(words) -> None:
    detail = {"time": 1.0, "where": 5.0, "what": "the state is no longer a number", "why": "unknown"}
    assert words.ending(recording("diverged", detail)).startswith("Diverged at 1.0 s, 5 m: the state")


def test_a_run_without_steps_has_an_ending_only(words) -> None:
    assert words.recording_lines(recording("cancelled", steps=0)) == ["Stopped after 0 s of skiing"]


def test_a_plan(words) -> None:
    plan = SimpleNamespace(
        length=98.4,
        duration=13.52,
        speed=np.array([4.0, 8.8]),
        inclination=np.radians([-28.2, 20.0]),
        edge_angle=np.radians([[30.4, -12.0], [3.0, 2.0]]),
        load=np.array([0.31, 1.12]),
    )
    assert words.plan_lines(plan) == [
        "Can be skied: 98 m in 13.5 s",
        "Speed 4.0 to 8.8 m/s",
        "Leans up to 28°, edges up to 30°",
        "Load 0.31 to 1.12 body weights",
    ]


def test_a_bake(words) -> None:
    result = SimpleNamespace(frame_first=1.0, frame_last=325.5, armature=SimpleNamespace(name="Skier"), note="")
    assert words.bake_lines(result) == ["Baked frames 1 to 325.5", "on Skier"]
