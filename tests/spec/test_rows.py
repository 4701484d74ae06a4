"""Rows, the arrays of tables of a run document: read, written, changed, and refused by their number and line."""

from __future__ import annotations

import math
import random
import tomllib

import pytest

from ski_addon.body.skeleton import BODY_NAMES
from ski_addon.errors import SpecError
from ski_addon.spec import GateSpec, PointSpec, PushSpec, RunSpec, row_kinds, section_fields
from ski_addon.spec.document import SIZE_MAX, find_line
from ski_addon.spec.fields import NUMBER, TEXT
from ski_addon.spec.rows import BODIES
from tests.spec.random_documents import ROW_KEYS, misspelt, random_row

GATES = ({"x": 10, "y": 3}, {"x": 25.5, "y": -3, "side": "left", "radius": 12}, {"x": 40, "y": 2, "distance": 1})
PUSH = {"body": "ski.R", "direction": "up", "force": 100, "start": 4}
LEAVES = [(key, leaf) for key, rows in row_kinds().items() for leaf in rows.row_fields]
HEAD = """\
[slope]
angle_deg = 9

[course]
kind = "turns"
turn_count = 6
turn_duration = 1.2
transition_duration = 1.5
turn_radius = 15
"""


def refused(call) -> str:
    with pytest.raises(SpecError) as caught:
        call()
    line = str(caught.value)
    assert "\n" not in line and len(line) <= 400 and caught.value.exit_code == 2
    return line


def with_gates(*rows) -> RunSpec:
    return RunSpec.from_dict({"gate": list(rows)})


def test_rows_are_tuples_of_frozen_values_with_defaults_for_the_rest():
    spec = RunSpec.from_dict({"gate": GATES, "point": [{"x": 1, "y": 2}], "push": [PUSH]})
    assert spec.gate[1] == GateSpec(25.5, -3.0, "left", 12.0, "auto")
    assert spec.gate[0] == GateSpec(10.0, 3.0, "auto", "auto", "auto")
    assert spec.point == (PointSpec(1.0, 2.0),)
    assert spec.push == (PushSpec("ski.R", "up", 100.0, 4.0, 0.5),)
    assert isinstance(hash(spec), int)


def test_a_run_without_rows_is_written_as_before_there_were_any():
    assert set(RunSpec().to_dict()).isdisjoint(ROW_KEYS) and "[[" not in RunSpec().to_toml()
    empty = RunSpec.from_dict(dict.fromkeys(ROW_KEYS, []))
    assert empty == RunSpec() and empty.content_hash() == RunSpec().content_hash()


def test_every_body_but_the_poles_can_be_pushed():
    assert set(BODIES) == {name for name in BODY_NAMES if not name.startswith("pole")}


def test_keys_of_a_row_are_the_fields_of_its_section():
    assert [info.key for info in section_fields("gate")] == [
        f"gate.{name}" for name in ("x", "y", "side", "radius", "distance")
    ]
    assert [info.name for info in section_fields("push")] == ["body", "direction", "force", "start", "duration"]


def test_written_rows_are_arrays_of_tables_in_their_order():
    text = with_gates(*GATES).to_toml()
    assert text.count("\n[[gate]]\n") == 3 and text.index("[[gate]]") > text.index("[bake]")
    assert [row["x"] for row in tomllib.loads(text)["gate"]] == [10.0, 25.5, 40.0]


def test_order_of_rows_is_part_of_the_run_and_how_numbers_are_written_is_not():
    assert with_gates(*GATES).content_hash() != with_gates(*GATES[::-1]).content_hash()
    assert with_gates({"x": 1, "y": 0}).content_hash() == with_gates({"x": 1.0, "y": -0.0}).content_hash()
    assert RunSpec(gate=(GateSpec(1, 2),)).to_toml() == with_gates({"x": 1, "y": 2}).to_toml()


def test_rows_in_one_line_are_the_same_document():
    inline = RunSpec.from_text("gate = [{x = 10, y = 3}, {x = 25.5, y = -3}]\n" + HEAD)
    tables = RunSpec.from_text(HEAD + "[[gate]]\nx = 10\ny = 3\n[[gate]]\nx = 25.5\ny = -3\n")
    assert inline == tables and len(inline.gate) == 2


def test_the_most_rows_are_read_from_a_file_they_fit_in(tmp_path):
    rng = random.Random(3)
    content = {key: [random_row(info, rng) for _ in range(int(info.high))] for key, info in row_kinds().items()}
    spec = RunSpec.from_dict(content)
    path = tmp_path / "run.toml"
    path.write_text(spec.to_toml(), encoding="utf-8")
    assert path.stat().st_size < SIZE_MAX
    assert RunSpec.from_toml(path) == spec


@pytest.mark.parametrize(("key", "most"), [("gate", 500), ("point", 5000), ("push", 100)])
def test_more_rows_than_that_are_refused(key, most):
    row = random_row(row_kinds()[key], random.Random(1))
    assert len(getattr(RunSpec.from_dict({key: [row] * most}), key)) == most
    line = refused(lambda: RunSpec.from_dict({key: [row] * (most + 1)}))
    assert line == f"{key} has {most + 1} rows, allowed are at most {most} rows: take some out"


@pytest.mark.parametrize(
    ("key", "leaf"), [pair for pair in LEAVES if pair[1].kind != TEXT], ids=lambda value: getattr(value, "key", value)
)
def test_a_bad_value_is_named_by_the_number_of_its_row(key, leaf):
    good = [random_row(row_kinds()[key], random.Random(seed)) for seed in range(3)]
    bad = [math.nan, "⛷", True, None, [1], {"x": 1}, 10**400]
    bad += [math.nextafter(leaf.low, -math.inf), math.nextafter(leaf.high, math.inf)] if leaf.kind == NUMBER else [""]
    for value in bad:
        rows = [good[0], good[1], {**good[2], leaf.name: value}]
        line = refused(lambda rows=rows: RunSpec.from_dict({key: rows}))
        assert line.startswith(f"{key} 3: {leaf.name}") and leaf.allowed in line
    assert refused(lambda: with_gates(*GATES[:2], {**GATES[2], "radius": 1})) == (
        "gate 3: radius = 1 is outside 3..200 m or auto: give a number in that range"
    )


def test_bad_places_of_a_row_are_named():
    def obstacle(points):
        return lambda: RunSpec.from_dict({"obstacle": [{"kind": "line", "points": points}]})

    assert refused(obstacle([[1, 2, 3]])).startswith("obstacle 1: points = [1, 2, 3] has a place that is no pair of")
    assert refused(obstacle([[1, "a"]])).startswith('obstacle 1: points = "a" is not a number: give a number in')
    assert refused(obstacle([[1, 9e9]])).endswith("is outside -1000..5000 m: give a number in that range")
    assert "has 201 places, allowed are at most 200 pairs" in refused(obstacle([[1, 2]] * 201))


def test_places_are_tuples_of_floats_and_written_as_lists():
    row = {"kind": "line", "points": [[1, 2], [-0.0, 4.5]]}
    spec = RunSpec.from_dict({"obstacle": [row]})
    assert spec.obstacle[0].points == ((1.0, 2.0), (0.0, 4.5)) and isinstance(hash(spec), int)
    assert "points = [[1.0, 2.0], [0.0, 4.5]]" in spec.to_toml() and RunSpec.from_text(spec.to_toml()) == spec
    assert spec.with_overrides({"obstacle.1.points": "[[3, 4], [5, 6]]"}).obstacle[0].points[0] == (3.0, 4.0)


@pytest.mark.parametrize(
    ("key", "leaf"), [pair for pair in LEAVES if len(pair[1].name) > 1], ids=lambda value: getattr(value, "key", value)
)
def test_a_misspelt_key_of_a_row_names_the_right_one(key, leaf):
    rng = random.Random(leaf.key)
    for wrong in {misspelt(leaf.name, rng) for _ in range(8)} - {other.name for _, other in LEAVES}:
        row = random_row(row_kinds()[key], rng) | {wrong: 1}
        line = refused(lambda row=row: RunSpec.from_dict({key: [row]}))
        assert line == f"{key} 1: {wrong} is not a key of [[{key}]]: did you mean {leaf.name}?"


@pytest.mark.parametrize(
    ("key", "leaf"), [pair for pair in LEAVES if pair[1].required], ids=lambda value: getattr(value, "key", value)
)
def test_a_missing_key_of_a_row_is_named_with_what_to_write(key, leaf):
    row = random_row(row_kinds()[key], random.Random(2))
    del row[leaf.name]
    line = refused(lambda: RunSpec.from_dict({key: [row]}))
    assert line.startswith(f"{key} 1: {leaf.name} is missing: write {leaf.name} under [[{key}]]: ")
    assert line.endswith(f"({leaf.allowed})")


@pytest.mark.parametrize("value", [3, "x", {"x": 1, "y": 2}, True, None])
def test_what_is_no_list_of_tables_is_refused(value):
    line = refused(lambda: RunSpec.from_dict({"gate": value}))
    assert "is not a list of tables: write [[gate]] above the keys of each gate" in line
    assert line.startswith("gate")


@pytest.mark.parametrize("row", [3, "x", [1, 2], None, PointSpec()])
def test_a_row_that_is_no_table_is_refused(row):
    assert refused(lambda: with_gates(GATES[0], row)).startswith("gate 2")


def test_rows_built_by_hand_are_validated():
    assert "gate 2: radius = 1 is outside" in refused(RunSpec(gate=(GateSpec(), GateSpec(radius=1))).validate)
    for wrong in ([GateSpec()], (PointSpec(),), ({"x": 1},), 3):
        assert refused(RunSpec(gate=wrong).validate).startswith("gate = ")


def test_ready_made_rows_may_be_given_in_place_of_tables():
    assert RunSpec().with_overrides({"gate": (GateSpec(1, 2),)}) == with_gates({"x": 1, "y": 2})


ROWS_TEXT = "[[gate]]\nx = 1\ny = 2\n\n[[push]]\nforce = 3\n\n[[ gate ]]  # second\nx = 5\ny = 6\nradius = 1\n"


@pytest.mark.parametrize(
    ("key", "line"),
    [
        ("gate 1: x", 2),
        ("gate 2: x", 9),
        ("gate 2: radius", 11),
        ("gate 1: radius", 1),
        ("gate 2: side", 8),
        ("push 1: force", 6),
        ("gate 2", 8),
        ("gate 3: x", 1),
        ("gate", 1),
        ("point 1: x", None),
        ("course.x", None),
    ],
)
def test_line_of_a_key_in_a_row(key, line):
    assert find_line(ROWS_TEXT, key) == line


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (ROWS_TEXT.replace("[[push]]\nforce = 3\n", ""), "line 19: gate 2: radius = 1 is outside"),
        ("[[gate]]\ny = 2\n", "line 11: gate 1: x is missing"),
        ("[[gate]]\nx = 1\ny = 2\nsid = 1\n", "line 14: gate 1: sid is not a key of [[gate]]: did you mean side?"),
        ("[gate]\nx = 1\ny = 2\n", "line 11: gate = {'x': 1, 'y': 2} is not a list of tables"),
        ("[[gatte]]\nx = 1\n", "line 11: gatte is not a key of a run: did you mean gate?"),
        ("[gatte]\nx = 1\n", "line 11: [gatte] is not a section of a run: did you mean [[gate]]?"),
        ("[[course]]\nx = 1\n", "is not valid TOML"),
    ],
)
def test_errors_in_rows_of_a_file_name_the_line(tmp_path, rows, words):
    path = tmp_path / "run.toml"
    path.write_text(f"{HEAD}\n{rows}")
    assert f"{path} {words}" in refused(lambda: RunSpec.from_toml(path))


def test_one_value_of_a_row_can_be_changed():
    spec = with_gates(*GATES)
    changed = spec.with_overrides({"gate.2.radius": "auto", "gate.3.side": "right", "gate.1.x": " 11 "})
    assert [gate.radius for gate in changed.gate] == ["auto", "auto", "auto"]
    assert [gate.side for gate in changed.gate] == ["auto", "left", "right"]
    assert changed.gate[0].x == 11.0 and type(changed.gate[0].x) is float
    assert spec == with_gates(*GATES)
    assert spec.with_overrides({"gate.2.radius": 12}) == spec
    both = spec.with_overrides({"gate.1.x": 0, "gate": "[{x = 1, y = 2}]"})
    assert both == with_gates({"x": 0, "y": 2})
    assert spec.with_overrides({"gate": "[]"}) == RunSpec()


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("gate.4.x", "gate 4 is not there: there are 3; add [[gate]] to the run document first"),
        ("push.1.force", "push 1 is not there: there are none; add [[push]] to the run document first"),
        ("gate.999999999999.x", "gate 999999999 is not there"),
        ("gate.0.x", "gate.0.x names no row: write gate.1.x for the first, and so on"),
        ("gate.radius", "gate.radius names no row"),
        ("gate.-1.radius", "gate.-1.radius names no row"),
        ("gate.².radius", "names no row"),
        ("gate.2.radus", "gate.2.radus is not a key of a run: did you mean gate.2.radius?"),
        ("gate.2", "gate.2 is not a key of a run: did you mean gate.2."),
        ("gate.2.x.y", "gate.2.x.y is not a key of a run"),
        ("gatt.2.x", "gatt.2.x is not a key of a run"),
        ("gate.", "gate. is not a key of a run: did you mean gate?"),
        ("gate.2.x", "gate 2: x = 1e+99 is outside -50..5000 m: give a number in that range"),
        ("gate.2.side", "gate 2: side = 1e+99 is not one of left, right, auto"),
    ],
)
def test_a_change_of_no_row_is_refused(key, words):
    assert words in refused(lambda: with_gates(*GATES).with_overrides({key: "1e99"}))


def test_rows_of_a_part_take_the_place_of_the_runs(tmp_path):
    path = tmp_path / "gates.toml"
    path.write_text("[[gate]]\nx = 1\ny = 2\n")
    spec = RunSpec.from_dict({"gate": GATES, "push": [PUSH]})
    assert spec.with_part(path).gate == (GateSpec(1.0, 2.0),)
    assert spec.with_part(path).push == spec.push
