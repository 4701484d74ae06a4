"""The page of all keys is made from the table and up to date."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest

from ski_addon.spec import RunSpec, field_table
from ski_addon.spec.fields import show_number
from ski_addon.spec.reference import HEAD, key_reference, write_reference

PAGE = Path(__file__).resolve().parents[1] / "docs" / "run_spec.md"


def test_the_page_in_the_repository_is_up_to_date():
    assert PAGE.read_text(encoding="utf-8") == key_reference(), "run: python -m ski_addon.spec.reference"


def test_every_key_has_a_row_under_its_section():
    page = key_reference()
    for key in field_table():
        section, _, name = key.rpartition(".")
        part = page.split(f"## [{section}]\n" if section else "## Document\n")[1].split("\n## ")[0]
        assert f"| `{name}` |" in part, key


def test_the_example_on_the_page_is_a_run():
    example = re.search(r"```toml\n(.*?)```", HEAD, re.DOTALL)
    assert example
    RunSpec.from_text(example.group(1))
    assert tomllib.loads(example.group(1))["course"]["turn_count"] == 6


def test_the_page_is_written_where_asked(tmp_path):
    assert write_reference(tmp_path / "keys.md").read_text(encoding="utf-8") == key_reference()


@pytest.mark.parametrize(
    ("value", "shown"),
    [(3, "3"), (0.0005, "0.0005"), (9e10, "9e10"), (1.2e8, "1.2e8"), (2147483647, "2147483647"), (1e-7, "1e-7")],
)
def test_numbers_are_shown_as_people_write_them(value, shown):
    assert show_number(value) == shown
    assert float(shown) == value
