"""docs/crowd.md: its tables are made from the fields, and its example is a crowd."""

from __future__ import annotations

import re

from ski_addon.crowd import field_table, read_crowd
from ski_addon.crowd.crowd_spec import ROWS
from ski_addon.crowd.reference import PAGE, with_tables, write_reference

TEXT = PAGE.read_text(encoding="utf-8")


def test_the_tables_are_up_to_date(tmp_path):
    assert with_tables(TEXT) == TEXT, "run: python -m ski_addon.crowd.reference"
    copy = tmp_path / "crowd.md"
    copy.write_text(re.sub(r"\| `count`.*\n", "", TEXT), encoding="utf-8")
    assert write_reference(copy).read_text(encoding="utf-8") == TEXT


def test_every_key_has_a_row():
    for name in [key.rpartition(".")[2] for key in field_table()] + [info.name for info in ROWS.row_fields]:
        assert f"| `{name}` |" in TEXT, name


def test_the_example_is_a_crowd(tmp_path):
    example = re.search(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    path = tmp_path / "example.toml"
    path.write_text(example.group(1), encoding="utf-8")
    crowd = read_crowd(path)
    assert crowd.crowd.count == 20 and [run.repeat for run in crowd.runs] == [2, 1]
    assert {run.spec.slope.angle_deg for run in crowd.runs} == {9.0}


def test_what_crowd_json_holds_is_told(tmp_path):
    from ski_addon.crowd.running import CrowdRun
    from ski_addon.crowd.summary import summarise
    from tests.crowd.crowds import crowd_of

    summary = summarise(CrowdRun(crowd_of(1), tmp_path, 1))
    for key in (*summary, *summary["members"][0]):
        assert f"`{key}`" in TEXT, key
