"""Keys that a job varies."""

from __future__ import annotations

import pytest

from ski_addon.errors import SkiAddonError, SpecError
from ski_addon.farm.subjects import run_subject
from ski_addon.farm.variations import Variation, list_changes, read_variations
from ski_addon.spec import RunSpec, find_document

SPEC = RunSpec.from_toml(find_document("uneven_slalom"))
RUN = run_subject(SPEC)


@pytest.mark.parametrize(
    ("written", "kind", "values"),
    [
        ("course.turn_radius=10,15.5", "FLOAT", (10, 15.5)),
        ("simulation.seed=3,1-2", "INT", (3, 1, 2)),
        ("technique.angulation=auto,-0.5,0", "STRING", ("auto", "-0.5", "0")),
        ("course.first_turn=left,right", "STRING", ("left", "right")),
        ("course.half_first_turn=true,false", "STRING", ("true", "false")),
        ("skier.mass= 60 , 70 ,60.0", "FLOAT", (60, 70)),
    ],
)
def test_values_have_the_type_of_their_key(written, kind, values):
    (variation,) = read_variations([written], RUN)
    assert (variation.kind, variation.values) == (kind, values)
    assert variation.parameter == variation.key.replace(".", "_")
    for value in values:  # what a task gives to --set
        assert SPEC.with_overrides({variation.key: str(value)}) == SPEC.with_overrides({variation.key: value})


def gate_list(count):
    gates = [{"x": 10.0 * k, "y": 2.0 * (-1) ** k} for k in range(1, count + 1)]
    return run_subject(RunSpec()).changed({"course.kind": "gates", "course.gate_setting": "list", "gate": gates})


def test_values_of_rows_can_be_varied():
    (variation,) = read_variations(["gate.1.x=8,9"], gate_list(4))
    assert (variation.parameter, variation.values) == ("gate_1_x", (8, 9))


@pytest.mark.parametrize(
    ("written", "message"),
    [
        (["course.turn_radus=10"], "course.turn_radus is not a key of a run: did you mean course.turn_radius"),
        (["course=10"], "course is a section, not a key"),
        (["course.turn_radius"], "--vary course.turn_radius has no values"),
        (["course.turn_radius="], "--vary course.turn_radius= has an empty value"),
        (["course.turn_radius=10,,12"], "--vary course.turn_radius=10,,12 has an empty value"),
        (["course.turn_radius=10,1e9"], "course.turn_radius = 1000000000.0 is outside"),
        (["course.turn_radius=[1]"], "course.turn_radius = [1] is not a number"),
        (["course.turn_radius=wide"], 'course.turn_radius = "wide" is not a number'),
        (["course.first_turn=up"], 'course.first_turn = "up" is not one of'),
        (["simulation.seed=5-1"], "--vary simulation.seed"),
        (["simulation.seed=1-100000"], "is outside a range of 1..256 whole numbers"),
        (["slope.grid_file=a.npz,b.npz"], "--vary slope.grid_file is a text or a list"),
        (["name=a,b"], "--vary name is a text or a list"),
        (["gate.99.x=1"], "gate 99 is not there"),
        (["skier.mass=60", "skier.mass=70"], "--vary skier.mass is given twice"),
    ],
)
def test_bad_variations_are_one_line(written, message):
    with pytest.raises(SkiAddonError) as caught:
        read_variations(written, RUN)
    assert message in str(caught.value)
    assert caught.value.exit_code == 2


def test_each_value_goes_with_each():
    variations = [Variation("a", "INT", (1, 2)), Variation("b", "STRING", ("x", "y"))]
    assert list_changes(variations, pairs=False) == [
        {"a": 1, "b": "x"},
        {"a": 1, "b": "y"},
        {"a": 2, "b": "x"},
        {"a": 2, "b": "y"},
    ]
    assert list_changes(variations, pairs=True) == [{"a": 1, "b": "x"}, {"a": 2, "b": "y"}]
    assert list_changes([], pairs=False) == [{}]


def test_too_many_runs_are_refused_before_they_are_listed():
    variations = [Variation(name, "INT", tuple(range(200))) for name in "abcdefgh"]
    with pytest.raises(SpecError, match=f"--vary makes {200**8} runs, allowed are 256"):
        list_changes(variations, pairs=False)
    assert len(list_changes(variations, pairs=True)) == 200


def test_pairs_need_as_many_values_of_each():
    variations = [Variation("a", "INT", (1, 2)), Variation("b", "INT", (1,))]
    with pytest.raises(SpecError, match="--pairs needs as many values of each key, but a has 2, b has 1"):
        list_changes(variations, pairs=True)


def test_too_many_keys_are_refused():
    written = [f"gate.{k}.x={k}" for k in range(1, 17)]
    assert len(read_variations(written[:15], gate_list(20))) == 15
    with pytest.raises(SpecError, match=r"--vary = 16 is outside 1\.\.15 keys"):
        read_variations(written, gate_list(20))
