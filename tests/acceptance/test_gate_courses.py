"""Shipped gate courses, simulated: nobody falls and every gate is passed as asked."""

from __future__ import annotations

import numpy as np
import pytest
from ski_addon.report.clearance import gate_summary

from ski_addon.course import course_gates
from tests.ski_runs import planned, simulated


@pytest.mark.slow
@pytest.mark.parametrize(("name", "count"), [("slalom", 20), ("giant_slalom_race", 15), ("uneven_slalom", 20)])
def test_every_gate_is_passed_on_its_side_at_its_distance(name, count):
    run, recording = planned(name), simulated(name)
    gates = course_gates(run.spec, run.terrain)
    assert recording.status == "finished" and recording.ski_error.max() <= 0.010
    summary = gate_summary(run.model.skeleton, recording.qpos, gates.position, gates.side)
    assert summary["gates"] == summary["gates_passed"] == count
    np.testing.assert_allclose(summary["gate_distance_m"], gates.distance, atol=0.05)
