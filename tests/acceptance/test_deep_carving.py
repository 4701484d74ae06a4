"""Deep lean: 55 to 60 degrees of inclination, held through racing turns of 16 m."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.course import TRANSITION
from tests.ski_runs import planned, simulated

RADIUS = 16.0


def held(inclination: np.ndarray, step: np.ndarray | float) -> float:
    """Longest time [s] that a lean (n,) [rad] stays within 3 degrees of its deepest and beyond 55; `step` [s]."""
    lean = np.degrees(np.abs(inclination))
    best = time = 0.0
    for deep, width in zip(lean >= max(55.0, lean.max() - 3.0), np.broadcast_to(step, lean.shape), strict=True):
        time = time + float(width) if deep else 0.0
        best = max(best, time)
    return best


@pytest.mark.slow
def test_planned_lean_is_held_in_every_turn():
    plan = planned("deep_carving").plan
    step = np.gradient(plan.time)
    lean = np.degrees(np.abs(plan.inclination))
    assert 55.0 < lean.max() < 60.0
    for turn in range(1, 9):
        inside = (plan.turn == turn) & (plan.phase != TRANSITION)
        assert held(plan.inclination[inside], step[inside]) >= 0.3


@pytest.mark.slow
def test_skied_lean_is_held_in_every_turn_at_fourteen_to_sixteen_metres_a_second():
    recording = simulated("deep_carving")
    assert recording.status == "finished" and np.degrees(np.abs(recording.inclination)).max() < 60.0
    for turn in range(1, 9):
        inside = (recording.turn == turn) & (recording.phase != TRANSITION)
        assert np.abs(recording.curvature[inside]).max() == pytest.approx(1.0 / RADIUS, rel=1e-3)
        assert recording.speed[inside].min() >= 14.0 and recording.speed[inside].max() <= 16.0
        assert held(recording.inclination[inside], recording.header["time_step"]) >= 0.3


@pytest.mark.slow
def test_deep_turns_are_carved_within_what_a_racer_can():
    recording = simulated("deep_carving")
    assert recording.torque_ratio.max() <= 1.0 and recording.joint_margin.min() >= 0.0
    assert np.all(recording.solver_status == 0) and recording.ski_error.max() <= 0.010
    load = np.linalg.norm(recording.snow_force.sum(axis=1), axis=1) / (recording.header["mass"] * 9.81)
    assert load.min() > 0.4
    assert load.max() == pytest.approx(1.0 / np.cos(np.abs(recording.inclination).max()), rel=0.1)
    deep = np.abs(recording.inclination) > np.radians(50.0)
    edge = np.degrees(np.abs(recording.edge_angle[deep]) - np.abs(recording.inclination[deep, None]))
    assert edge.min() > -1.0 and edge.max() < 12.0, "skis are edged as far as the body leans, or a little more"


def test_held_is_the_longest_stretch_near_the_deepest_lean():
    lean = np.radians([50, 56, 57, 50, 56, 57, 58, 40, 56])
    assert held(lean, 0.1) == pytest.approx(0.3)
    assert held(-lean, 0.1) == pytest.approx(0.3)
    assert held(np.radians([54.0, 54.9]), 0.1) == 0.0
    assert held(np.radians([55.5, 59.5, 56.0]), 0.2) == pytest.approx(0.2)
