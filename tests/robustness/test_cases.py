"""The table of pushes as a person writes it."""

from __future__ import annotations

import pytest

from ski_addon.errors import SpecError
from ski_addon.robustness import Case, PushTable, Row, read_table


def test_the_default_table_is_the_promised_one():
    table = PushTable()
    assert len(table.cases) == 256 and len(table.rows) == 64 and len(set(table.cases)) == 256
    assert {case.force for case in table.cases} == {50.0, 100.0, 150.0, 200.0}
    assert read_table(forces=None, bodies=None, duration=None) == table


def test_values_are_read_between_commas_without_repeats():
    table = read_table(forces=" 200, 50,2e2,.5", bodies="ski.L,head,ski.L", speeds="7", moments="turn", duration="0.25")
    assert table.forces == (0.5, 50.0, 200.0)
    assert table.bodies == ("ski.L", "head")
    assert (table.speeds, table.moments, table.duration) == ((7.0,), ("turn",), 0.25)
    assert table.directions == PushTable().directions


def test_cases_of_one_speed_come_after_each_other():
    speeds = [case.row.speed for case in PushTable().cases]
    assert speeds == sorted(speeds)
    assert PushTable().cases[1] == Case(Row(5.0, "turn", "head", "left"), 100.0)


@pytest.mark.parametrize(
    ("written", "words"),
    [
        ({"forces": "50,x"}, '--forces = "x" is not a number: give a number in 0..2000 N'),
        ({"forces": "50,3000"}, "--forces = 3000 is outside 0..2000 N"),
        ({"forces": "50,,100"}, "--forces has no value: give one of: 0..2000 N"),
        ({"forces": "nan"}, "--forces = nan is not a finite number"),
        ({"bodies": "head,pole.L"}, '--bodies = "pole.L" is not one of pelvis, abdomen'),
        ({"directions": "sideways"}, '--directions = "sideways" is not one of left, right, forward, back, up, down'),
        ({"speeds": "99"}, "--speeds = 99 is outside "),
        ({"moments": "jump"}, '--moments = "jump" is not one of turn, transition'),
        ({"duration": "0"}, "--duration = 0 is outside 0.01..10 s"),
        ({"duration": "1,2"}, '--duration = "1,2" is not a number'),
    ],
)
def test_a_bad_value_is_named_with_its_option(written, words):
    with pytest.raises(SpecError) as caught:
        read_table(**written)
    assert words in str(caught.value) and "\n" not in str(caught.value)
