"""Keys that are for some kinds of course only."""

from __future__ import annotations

import math

import pytest

from ski_addon.errors import SpecError
from ski_addon.spec import RunSpec, estimate, field_table
from ski_addon.spec.gate_defaults import gate_defaults
from ski_addon.spec.reference import key_reference

HEAD = "[slope]\nangle_deg = 12\n\n[course]\n"


def test_kinds_of_keys_are_choices_of_their_section():
    for info in field_table().values():
        if info.kinds:
            assert set(info.kinds) <= set(field_table()[f"{info.section}.kind"].choices), info.key


@pytest.mark.parametrize("kind", ["gates", "path", "bumps"])
def test_keys_of_turns_are_not_required_of_other_courses(kind):
    assert RunSpec.from_text(f'{HEAD}kind = "{kind}"\n').course.kind == kind


def test_keys_of_turns_are_required_of_turns():
    with pytest.raises(SpecError, match="course.turn_count is missing"):
        RunSpec.from_text(f'{HEAD}kind = "turns"\n')


def test_kind_of_a_course_is_required_first():
    with pytest.raises(SpecError, match="course.kind is missing"):
        RunSpec.from_text(HEAD)


def test_kind_that_is_no_word_is_refused_in_one_line():
    with pytest.raises(SpecError, match="course.kind"):
        RunSpec.from_text(f"{HEAD}kind = 3\n")


def test_reference_says_which_kind_a_key_is_for():
    page = key_reference()
    assert "| `turn_count` | *required* | 1..500 turns | `turns`: Number of turns |" in page
    assert "`gates`, `bumps`: Distance from the start" in page


def test_given_spacing_and_offset_come_before_usual_ones():
    spec = RunSpec.from_dict({"course": {"kind": "gates", "gate_setting": "giant_slalom", "gate_offset": 7}})
    usual = gate_defaults(spec.course)
    assert (usual.spacing, usual.offset, usual.distance) == (24.0, 7.0, 1.0)


@pytest.mark.parametrize(
    ("content", "way"),
    [
        ({"course": {"kind": "gates", "gate_count": 10, "gate_spacing": 12, "gate_offset": 5}}, 156.0),
        ({"course": {"kind": "gates", "gate_setting": "list"}, "gate": [{"x": 0, "y": 0}, {"x": 30, "y": 40}]}, 50.0),
        ({"course": {"kind": "path"}, "point": [{"x": 0, "y": 0}, {"x": 3, "y": 4}, {"x": 15, "y": 9}]}, 18.0),
        ({"course": {"kind": "bumps", "run_length": 80}}, 80.0),
        ({"course": {"kind": "bumps"}, "slope": {"kind": "bumps", "bump_count": 5, "bump_width": 8}}, 117.0),
        ({"course": {"kind": "bumps"}, "slope": {"kind": "moguls", "mogul_count": 8, "mogul_spacing": 3.5}}, 46.25),
    ],
)
def test_estimate_of_other_courses_is_their_way_at_the_speed_to_hold(content, way):
    """A line over bumps leads half a wave more than one past the last crest, as one past gates does, and 3 m on."""
    content["course"]["target_speed"] = 4
    assert estimate(RunSpec.from_dict(content)).simulated_seconds == pytest.approx(way / 4.0)


def test_estimate_of_a_run_from_rest_is_the_time_of_free_gliding():
    content = {"course": {"kind": "bumps", "run_length": 60, "start_speed": 0}, "slope": {"angle_deg": 10}}
    gain = 9.81 * (math.sin(math.radians(10)) - 0.08 * math.cos(math.radians(10)))
    seconds = estimate(RunSpec.from_dict(content)).simulated_seconds
    assert math.sqrt(2 * 60 / gain) < seconds < 1.15 * math.sqrt(2 * 60 / gain), "a little more, for drag"


@pytest.mark.parametrize("angle", [0, 2])
def test_estimate_of_a_run_from_rest_that_friction_would_hold_is_finite(angle):
    content = {"course": {"kind": "bumps", "run_length": 60, "start_speed": 0}, "slope": {"angle_deg": angle}}
    assert 60.0 < estimate(RunSpec.from_dict(content)).simulated_seconds < 200.0
