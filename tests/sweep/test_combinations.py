"""What a sweep runs, from what was written after --vary."""

from __future__ import annotations

import pytest

from ski_addon.errors import SpecError
from ski_addon.spec import RunSpec
from ski_addon.sweep import read_variations

SPEC = RunSpec(name="Run")
MANY = ",".join(map(str, range(30, 131)))


def test_every_combination_is_a_run_with_a_folder_named_by_its_values():
    found = read_variations(SPEC, ["course.turn_radius=10, 12", "snow.friction=0.02,0.05"])
    assert [each.name for each in found] == [
        "turn_radius=10,friction=0.02",
        "turn_radius=10,friction=0.05",
        "turn_radius=12,friction=0.02",
        "turn_radius=12,friction=0.05",
    ]
    assert found[2].spec == SPEC.with_overrides({"course.turn_radius": 12, "snow.friction": 0.02})


def test_names_stay_when_values_join_and_keys_that_look_alike_are_told_apart():
    few, more = (read_variations(SPEC, [f"skier.mass={values}"]) for values in ("60,80", "50,60,80"))
    assert {each.name for each in few} < {each.name for each in more}
    alike = read_variations(SPEC, ["bake.fps=24", "skier.mass=60"])[0].name
    assert alike == "fps=24,mass=60"


def test_the_same_run_twice_is_one():
    assert [each.values for each in read_variations(SPEC, ["skier.mass=60,60.0,60"])] == [{"skier.mass": "60"}]


def test_whole_numbers_can_be_a_range():
    assert [each.spec.simulation.seed for each in read_variations(SPEC, ["simulation.seed=3-5,9"])] == [3, 4, 5, 9]
    with pytest.raises(SpecError, match=r"is outside a range of 1\.\.10000 whole numbers"):
        read_variations(SPEC, ["simulation.seed=5-3"])


def test_values_of_rows_can_vary():
    gates = [{"x": 10.0 * k, "y": 2.0 * (-1) ** k} for k in range(1, 5)]
    spec = SPEC.with_tables({"course": {"kind": "gates", "gate_setting": "list"}, "gate": gates})
    assert [each.spec.gate[0].x for each in read_variations(spec, ["gate.1.x=8,9"])] == [8.0, 9.0]


def test_words_and_values_with_commas_are_taken():
    found = read_variations(SPEC, ["technique.angulation=auto,-0.1"])
    assert [each.spec.technique.angulation for each in found] == ["auto", -0.1]
    names = read_variations(SPEC, ["name=a/../b;x, y"])
    assert [each.spec.name for each in names] == ["a/../b", "x, y"]
    assert [each.name for each in names] == ["name=a-..-b", "name=x,-y"] and not any("/" in each.name for each in names)
    long = read_variations(SPEC, [f"name={'x' * 60}{'y' * 60}"])[0].name
    assert len(long) <= 80


@pytest.mark.parametrize(
    ("written", "words"),
    [
        (["course.turn_radius"], "has no values: write for instance --vary course.turn_radius=10,15,20"),
        (["course.turn_radius="], "has an empty value"),
        (["course.turn_radius=1,,2"], "has an empty value"),
        (["course.turn_radus=10"], "did you mean course.turn_radius?"),
        (["course.turn_radius=10,1"], r"course.turn_radius = 1 is outside 3..200 m"),
        (["skier.mass=60", "skier.mass=70"], "--vary skier.mass is given twice"),
        ([f"skier.mass={MANY}", f"skier.strength={MANY}"], "--vary = 10201 is outside 1..10000 runs"),
    ],
)  # fmt: skip
def test_wrong_values_are_named(written, words):
    with pytest.raises(SpecError, match=words.replace("?", r"\?")):
        read_variations(SPEC, written)
