"""The paper's cases at reduced cost: fewer turns or longer steps, the same bounds. All of it: `full_matrix.py`."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.simulation import summarise
from tests.acceptance.bounds import BOUNDS, violations
from tests.acceptance.full_matrix import cases
from tests.ski_runs import COARSE, FAST, FRICTIONLESS, MAIN, simulated

CASES = {
    "main at 9": ("paper_main", MAIN),
    "main at 12": ("paper_main", FAST),
    "r10 at 9": ("paper_r10", {**COARSE, "course.start_speed": 9}),
    "fig15 frictionless at 2": (
        "paper_fig15",
        {**FRICTIONLESS, "course.start_speed": 2, "simulation.time_step": 0.004},
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_case_is_skied_within_the_bounds(case):
    recording = simulated(*CASES[case])
    assert violations(summarise(recording)) == []
    assert recording.duration > 3.0 and set(np.sign(recording.phase)) == {-1, 0, 1}


def test_cases_are_the_hard_ones():
    """Leans of 25 to 50 degrees, both sides."""
    lean = {case: np.rad2deg(simulated(*CASES[case]).inclination) for case in CASES}
    assert 25 < np.abs(lean["main at 9"]).max() < 30
    assert 35 < np.abs(lean["r10 at 9"]).max() < 45
    assert 40 < np.abs(lean["main at 12"]).max() < 45
    assert 45 < np.abs(lean["fig15 frictionless at 2"]).max() < 55
    assert all(angles.min() < -20 and angles.max() > 20 for angles in lean.values())


def test_bounds_can_be_missed():
    good = summarise(simulated(*CASES["main at 9"]))
    for key, bound in BOUNDS.items():
        assert any(key in words for words in violations({**good, key: 1.1 * bound + 1e-9})), key
        assert violations({**good, key: float("nan")}), key
    assert violations({**good, "joint_margin_min_deg": -0.1})
    assert "tipped" in violations({**good, "status": "fell", "status_detail": {"what": "tipped"}})[0]
    assert violations({**good, "ski_error_max_m": 9e-3}, factor=2.0) == []


def test_full_matrix_holds_every_case_that_is_promised():
    listed = [(case.preset, case.speed, case.friction) for case in cases()]
    for preset, fastest in (("paper_main", 12), ("paper_r10", 9), ("paper_r25", 12), ("paper_fig15", 12)):
        speeds = [speed for name, speed, friction in listed if name == preset and friction and speed]
        assert (min(speeds), max(speeds)) == (4, fastest)
    for preset, fastest in (("paper_main", 1.0), ("paper_r25", 3.0), ("paper_fig15", 3.0)):
        speeds = [speed for name, speed, friction in listed if name == preset and not friction]
        assert (min(speeds), max(speeds)) == (0.5, fastest)
    shipped = {case.preset for case in cases() if case.speed is None}
    assert shipped >= {"giant_slalom", "medium_carving", "short_turns", "beginner_turns"}
