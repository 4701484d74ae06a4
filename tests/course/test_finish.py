"""Run-outs: out of the last turn into the fall line, with room to stop, and refused where the ground ends."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from ski_addon.course import Track, build_track, speed_to_hold
from ski_addon.course.finish import FIRM_TURN, LEANING, MARGIN, TIGHTEST, coasting_speed, with_run_out
from ski_addon.errors import SpecError
from ski_addon.spec import RunSpec
from ski_addon.terrain import build_terrain
from tests.ski_runs import preset

SHORT = {"course.turn_count": 2}
CASES = {
    "held turns": ("steep", {"course.turn_count": 3}),
    "ends straight": ("paper_main", {**SHORT, "course.entry": "straight"}),
    "ends in its turn": ("paper_main", SHORT),
    "the other way": ("paper_main", {**SHORT, "course.first_turn": "left"}),
    "gates": ("slalom", {"course.gate_count": 4}),
    "path": ("s_curve", {}),
    "rolling ground": ("rolling_slalom", {"course.gate_count": 4}),
}
PLANE = [name for name in CASES if name != "rolling ground"]


def tracks(case: str, changes: dict[str, object] | None = None) -> tuple[RunSpec, Track, Track]:
    """The document, its track that glides out, and the one that stops."""
    spec = preset(*CASES[case]).with_overrides(changes or {})
    terrain = build_terrain(spec.slope)
    glide = build_track(spec.with_overrides({"course.finish": "glide"}), terrain)
    return spec, glide, build_track(spec.with_overrides({"course.finish": "stop"}), terrain)


@pytest.mark.parametrize("case", CASES)
def test_track_up_to_its_run_out_is_the_one_that_glides(case):
    _, glide, stop = tracks(case)
    assert glide.stop_from == math.inf and glide.length < stop.stop_from < stop.length
    there = np.stack([np.interp(glide.arc_length, stop.arc_length, axis) for axis in stop.position.T], axis=1)
    np.testing.assert_allclose(there, glide.position, atol=2e-3)
    added = stop.arc_length > glide.length + 0.1
    assert not stop.phase[added].any() and np.all(stop.turn[added] == glide.turn[-1])
    assert stop.start_speed == glide.start_speed


@pytest.mark.parametrize("case", CASES)
def test_run_out_ends_straight_down_the_fall_line(case):
    _, _, stop = tracks(case)
    straight = stop.arc_length >= stop.stop_from
    np.testing.assert_allclose(stop.tangent[straight, 1], 0.0, atol=1e-6)
    assert np.all(stop.tangent[straight, 0] > 0) and np.abs(stop.curvature[straight]).max() < 1e-3


@pytest.mark.parametrize("case", CASES)
def test_curvature_is_continuous_where_the_run_out_begins(case):
    """From place to place, 5 cm apart, it changes by no more than 0.05 /m^2, also out of a turn of 15 m."""
    _, glide, stop = tracks(case)
    around = (stop.arc_length > glide.length - 0.5) & (stop.arc_length < stop.stop_from)
    rate = np.diff(stop.curvature[around]) / np.diff(stop.arc_length[around])
    assert np.abs(rate).max() < 0.05


@pytest.mark.parametrize("lean", [20.0, 55.0])
def test_turn_into_the_fall_line_is_firm_but_within_the_lean_allowed(lean):
    spec, glide, stop = tracks("held turns", {"technique.inclination_max_deg": lean})
    added = stop.arc_length > glide.length + 0.1
    speed = coasting_speed(glide, spec)
    firm = min(FIRM_TURN, LEANING * math.tan(math.radians(lean)))
    most = min(firm * 9.81 / speed**2, TIGHTEST)
    assert 0.5 * most < np.abs(stop.curvature[added]).max() <= 1.001 * most


def test_mirrored_course_has_the_mirrored_run_out():
    right, left = tracks("ends in its turn")[2], tracks("the other way")[2]
    np.testing.assert_allclose(right.position * [1, -1, 1], left.position, atol=1e-9)
    assert right.stop_from == pytest.approx(left.stop_from, abs=1e-9)


@pytest.mark.parametrize("deceleration", [2.0, 5.0])
@pytest.mark.parametrize("case", ["held turns", "gates"])
def test_there_is_room_to_stop(case, deceleration):
    """More than v^2 / 2a and what is left over, at the speed to hold; a softer stop has more."""
    name, changes = CASES[case]
    asked = {"course.finish": "stop", "technique.stop_deceleration": deceleration}
    spec = preset(name, {**changes, **asked})
    stop = build_track(spec, build_terrain(spec.slope))
    assert stop.length - stop.stop_from > 0.5 * speed_to_hold(spec) ** 2 / deceleration + MARGIN


def test_run_out_past_the_end_of_the_ground_is_refused_with_what_is_missing():
    spec, _, whole = tracks("rolling ground")
    terrain = build_terrain(spec.slope)

    class Shorter:
        mean_angle, height, normal = terrain.mean_angle, staticmethod(terrain.height), staticmethod(terrain.normal)

        @staticmethod
        def contains(x, y):
            return terrain.contains(x, y) & (np.asarray(x) < whole.position[-1, 0] - 10.0)

    glide = tracks("rolling ground")[1]
    with pytest.raises(SpecError) as caught:
        with_run_out(glide, spec, Shorter())
    said = re.fullmatch(
        r"course.finish = \"stop\" does not fit on the slope: the ground ends (\d+) m too early for a stop: "
        r"shorten the course, or let it glide",
        str(caught.value),
    )
    assert said, caught.value
    assert float(said[1]) == pytest.approx(10.0 / math.cos(terrain.mean_angle), abs=1.5)
    shorter = preset(CASES["rolling ground"][0], {"course.gate_count": 2, "course.finish": "stop"})
    build_track(shorter, terrain)


def test_coasting_speed_is_that_of_energy_and_of_the_speed_to_hold():
    free = {"snow.friction": 0, "snow.friction_per_speed": 0, "skier.drag_area": 0}
    spec = preset("paper_main", {**SHORT, **free})
    track = build_track(spec, build_terrain(spec.slope))
    drop = track.position[0, 2] - track.position[-1, 2]
    assert coasting_speed(track, spec) == pytest.approx(math.sqrt(81 + 2 * 9.81 * drop), rel=1e-3)
    held = spec.with_overrides({"technique.speed_limit": 6.0})
    assert coasting_speed(track, held) == pytest.approx(6.6) and coasting_speed(track, held, 1.0) == pytest.approx(6.0)
