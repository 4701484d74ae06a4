"""Runs past gates: what their recordings and summaries say of them."""

from __future__ import annotations

import json

import numpy as np
import pytest

from ski_addon.course import Gates, course_gates
from ski_addon.pipeline import run_simulation
from ski_addon.simulation import Recording, recorded_gates, summarise
from ski_addon.simulation.clearance import gate_summary
from ski_addon.talk import json_text, summary_lines
from tests.ski_runs import COARSE, planned, simulated

SLALOM = {"course.gate_count": 3, "simulation.time_step": 0.002}
GATE_KEYS = {
    "gates",
    "gates_passed",
    "gates_missed",
    "gate_distances_m",
    "gate_clearances_m",
    "gate_clearance_min_m",
}


@pytest.fixture(scope="module")
def recording():
    return simulated("slalom", SLALOM)


def test_header_carries_the_gates_that_stand_on_the_terrain(recording):
    run = planned("slalom", SLALOM)
    asked = course_gates(run.spec, run.terrain)
    json.dumps(recording.header["gates"])  # lists of plain numbers
    carried = Gates.from_lists(recording.header["gates"])
    for name in ("position", "side", "distance"):
        np.testing.assert_array_equal(getattr(carried, name), getattr(asked, name))
        assert getattr(carried, name).dtype == getattr(asked, name).dtype


def test_courses_without_gates_carry_none():
    other = simulated("paper_main", COARSE)
    assert other.header["gates"] == {} and recorded_gates(other) is None
    assert not GATE_KEYS & set(summarise(other))


def test_gates_are_passed_and_the_summary_says_so(recording):
    summary = summarise(recording)
    assert set(summary) >= GATE_KEYS
    assert (summary["gates"], summary["gates_passed"], summary["gates_missed"]) == (3, 3, [])
    np.testing.assert_allclose(summary["gate_distances_m"], recording.header["gates"]["distance"], atol=0.05)
    assert summary["gate_clearance_min_m"] == min(summary["gate_clearances_m"])
    assert 0.0 < summary["gate_clearance_min_m"] < 0.5
    assert "3 of 3 passed" in summary_lines(summary)[-1]
    assert json.loads(json_text(summary))["gate_clearances_m"] == summary["gate_clearances_m"]


def test_gates_survive_the_way_to_disk_and_back(recording, tmp_path):
    loaded = Recording.load(recording.save(tmp_path / "run.npz"))
    assert gate_summary(recorded_gates(loaded)) == gate_summary(recorded_gates(recording))


def test_run_that_ends_early_reached_only_some_gates():
    told = []
    run = planned("slalom", SLALOM)
    whole = simulated("slalom", SLALOM)
    middle = np.hypot(*(whole.com[:, :2] - recorded_gates(whole).gates.position[1, :2]).T)
    chunks = int(0.002 * np.argmin(middle) / 0.1)  # cancelled beside the second gate
    begun, _ = run_simulation(run, lambda fraction, text: told.append(fraction) or len(told) < chunks)
    summary = summarise(begun)
    assert summary["status"] == "cancelled" and summary["gates_passed"] == 1 and summary["gates_missed"] == [2, 3]
    assert summary["gate_clearances_m"][1:] == [None, None]
    assert summary_lines(summary)[-1].endswith("not reached: 2, 3")


def test_pole_moved_to_the_other_side_is_missed(recording):
    header = json.loads(json.dumps(recording.header))
    header["gates"]["side"][1] *= -1
    passing = recorded_gates(Recording(header, **{k: v for k, v in vars(recording).items() if k != "header"}))
    summary = gate_summary(passing)
    assert summary["gates_missed"] == [2] and summary["gate_clearances_m"][1] < 0.0
