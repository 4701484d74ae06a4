"""Members: ordinary runs, drawn from numbers of their own."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.crowd import find_crowd, read_crowd
from ski_addon.crowd.members import draw_member, wanted_offsets, wanted_start
from tests.crowd.crowds import crowd_of

NONE = dict.fromkeys(
    (f"spread.{n}" for n in ("height", "mass", "strength", "speed", "radius", "rhythm", "knee_bend_deg", "mirrored")), 0
)


def test_a_member_is_the_same_whatever_the_count_and_the_order():
    few, many = crowd_of(2), crowd_of(50)
    assert [draw_member(few, index) for index in (1, 0)] == [draw_member(many, index) for index in (1, 0)]
    assert wanted_start(few, 1) == wanted_start(many, 1)


def test_members_differ_from_each_other_by_seed_and_by_try():
    crowd = crowd_of(5)
    specs = [draw_member(crowd, index).spec for index in range(5)] + [draw_member(crowd, 0, 2).spec]
    specs.append(draw_member(crowd_of(5, {"crowd.seed": 1}), 0).spec)
    assert len({spec.content_hash() for spec in specs}) == len({spec.skier.height for spec in specs}) == 7


def test_without_spread_everybody_is_the_run_itself():
    crowd = crowd_of(3, NONE)
    base, spec = crowd.runs[0].spec, draw_member(crowd, 2).spec
    assert (spec.skier, spec.course, spec.technique) == (base.skier, base.course, base.technique)
    assert spec.name == "Paper, main case, member 3"


def test_one_spread_changes_nothing_else():
    narrow, wide = (draw_member(crowd_of(3, {"spread.height": value}), 1).spec for value in (0.02, 0.1))
    assert narrow.skier.height != wide.skier.height
    assert (narrow.course, narrow.technique, narrow.skier.strength) == (
        wide.course,
        wide.technique,
        wide.skier.strength,
    )


def test_spreads_are_standard_deviations_cut_at_two():
    crowd = crowd_of(400, {"spread.height": 0.05, "spread.mass": 0, "spread.speed": 0.1, "spread.women": 0.25})
    specs = [draw_member(crowd, index).spec for index in range(400)]
    base = crowd.runs[0].spec
    away = np.array([spec.skier.height for spec in specs]) - base.skier.height
    assert np.abs(away).max() <= 0.1 + 1e-3
    assert away.std() == pytest.approx(0.88 * 0.05, rel=0.1) and abs(away.mean()) < 0.01  # a normal one cut at two
    speed = np.array([spec.course.start_speed for spec in specs])
    assert speed.std() == pytest.approx(0.088 * base.course.start_speed, rel=0.1)
    mass = np.array([spec.skier.mass / spec.skier.height**2 for spec in specs])
    assert mass == pytest.approx(base.skier.mass / base.skier.height**2, rel=0.01)
    assert np.mean([spec.skier.sex == "female" for spec in specs]) == pytest.approx(0.25, abs=0.06)
    assert np.mean([spec.course.first_turn == "left" for spec in specs]) == pytest.approx(0.5, abs=0.08)


def test_racers_pass_the_same_gates_nearer_or_wider():
    crowd = read_crowd(find_crowd("pursuit_race"))
    courses = [draw_member(crowd, index).spec.course for index in range(6)]
    assert len({course.gate_distance for course in courses}) == 6
    assert (
        len({(course.gate_count, course.gate_spacing, course.gate_offset, course.first_turn) for course in courses})
        == 1
    )


def test_lines_lie_within_the_width_the_favourite_first():
    crowd = crowd_of(3, {"spread.offset": 4})
    lines = wanted_offsets(crowd, 1)
    assert len(lines) == 8 and np.abs(lines).max() <= 4 and np.ptp(lines) > 1
    assert wanted_offsets(crowd_of(3), 1).tolist() == [0.0]


def test_starts_follow_each_other():
    crowd = crowd_of(20, {"crowd.start_interval": 2, "crowd.start_variation": 0.5})
    wanted = [wanted_start(crowd, index) for index in range(20)]
    assert wanted[0] == 0.0 and np.diff(wanted).min() >= 1.0 and np.diff(wanted).max() <= 3.0
    even = crowd_of(3, {"crowd.start_interval": 30, "crowd.start_variation": 0})
    assert [wanted_start(even, index) for index in range(3)] == [0.0, 30.0, 60.0]
