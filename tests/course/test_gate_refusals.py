"""Gates that cannot be passed: each is one line with the gate, the reason, and something that works when it is done."""

from __future__ import annotations

import re

import numpy as np
import pytest

from ski_addon.course import build_track
from ski_addon.errors import SpecError
from ski_addon.spec import RunSpec
from ski_addon.terrain import build_terrain
from tests.course.gate_courses import EVEN, generated, listed


def refused(spec: RunSpec, terrain: object = None) -> str:
    with pytest.raises(SpecError) as caught:
        build_track(spec, terrain or build_terrain(spec.slope))
    line = str(caught.value)
    assert "\n" not in line and len(line) < 300
    return line


def moved(index: int, x: float, y: float) -> list[tuple[float, float]]:
    return [*EVEN[:index], (x, y), *EVEN[index + 1 :]]


def test_gate_uphill_of_its_predecessor():
    line = refused(listed(moved(3, 30.0, -1.0)))
    assert line.startswith("gate 4 is 5.0 m uphill of gate 3 (x = 30.0, y = -1.0): ")
    assert "x of at least 37.0" in line


def test_gate_in_the_place_of_another():
    assert refused(listed(moved(3, *EVEN[2]))).startswith("gate 4 is in the place of gate 3: ")


def test_gate_beside_another():
    line = refused(listed(moved(3, 36.0, -4.0)))
    assert line.startswith("gate 4 is beside gate 3, only 1.0 m below it: ") and "x of at least 37.0" in line


def test_gate_off_the_terrain_with_the_nearest_place_on_it():
    class Strip:
        mean_angle, extent = 0.0, (-50.0, 200.0, -5.0, 5.0)

        def contains(self, x, y):
            return (np.abs(y) <= 5.0) & (x <= 200.0)

    line = refused(listed(moved(3, 45.0, -7.3)), Strip())
    assert line == "gate 4 is off the terrain (x = 45.0, y = -7.3): x = 45, y = -5 would work"


def test_gate_too_far_to_the_side_with_the_nearest_place_that_works():
    line = refused(listed(moved(3, 45.0, -14.0)))
    match = re.fullmatch(r"gate 4 is too far to one side .*: y = (-?[\d.]+) would work", line)
    assert match, line
    y = float(match[1])
    assert -14.0 < y < -3.0
    build = listed(moved(3, 45.0, y))
    build_track(build, build_terrain(build.slope))


def test_turn_tighter_than_three_metres_with_the_nearest_place_that_works():
    def close(y: float) -> RunSpec:
        return listed([*EVEN[:3], (39.0, y), (43.0, 1.0), (53.0, -1.0)])

    line = refused(close(-1.0))
    match = re.fullmatch(r"gate 4 needs a turn of [\d.]+ m radius, tighter than 3 m .*: y = ([\d.-]+) would work", line)
    assert match, line
    build_track(close(float(match[1])), build_terrain(close(0.0).slope))


def test_side_that_the_line_cannot_turn_to():
    line = refused(listed(changes={3: {"side": "right"}}))
    assert line.startswith("gate 4 cannot be passed turning right: ") and line.endswith('side = "left" would work')


def test_pole_on_the_wrong_side_of_the_line():
    line = refused(listed(moved(3, 45.0, 3.5)))
    assert line.startswith("gate 4 cannot be passed turning left: ")
    match = re.search(r"y = (-?[\d.]+) would work", line)
    assert match, line
    spec = listed(moved(3, 45.0, float(match[1])))
    build_track(spec, build_terrain(spec.slope))


@pytest.mark.parametrize("index", [0, 3])
def test_radius_larger_than_fits_with_the_largest_that_does(index):
    line = refused(listed(changes={index: {"radius": 40.0}}))
    match = re.fullmatch(rf"gate {index + 1}: radius = 40.0 is more than fits: .*: at most ([\d.]+) m would work", line)
    assert match, line
    spec = listed(changes={index: {"radius": float(match[1])}})
    build_track(spec, build_terrain(spec.slope))


def test_radius_of_all_gates_larger_than_fits():
    line = refused(generated(gate_count=5, gate_radius=30))
    match = re.fullmatch(
        r"course.gate_radius = 30.0 is more than fits: at gate \d .*: at most ([\d.]+) m would work", line
    )
    assert match, line
    spec = generated(gate_count=5, gate_radius=float(match[1]))
    build_track(spec, build_terrain(spec.slope))


@pytest.mark.parametrize(
    ("course", "pattern"),
    [
        (
            {"gate_offset": 12},
            r"course.gate_offset = 12.0 makes a course .*: gate \d .*: at most ([\d.]+) m would work",
        ),
        (
            {"gate_spacing": 3},
            r"course.gate_(?:offset|spacing) = .*: gate \d .*: at (?:most|least) ([\d.]+) m would work",
        ),
    ],
)
def test_set_of_gates_that_cannot_be_skied(course, pattern):
    line = refused(generated(gate_count=8, **course))
    match = re.fullmatch(pattern, line)
    assert match, line
    key = line.partition(" = ")[0].removeprefix("course.")
    spec = generated(gate_count=8, **{**course, key: float(match[1])})
    build_track(spec, build_terrain(spec.slope))


def test_list_without_gates():
    assert refused(listed([])) == (
        'course.gate_setting = "list" has no gates: add [[gate]] rows with x and y, or choose gate_setting = "slalom"'
    )
