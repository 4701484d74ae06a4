"""The page of claims: every claim has its row, and the tests it names are there."""

from __future__ import annotations

import re
from pathlib import Path

from ski_addon.spec import field_table

ROOT = Path(__file__).resolve().parents[1]
PAGE = (ROOT / "docs" / "claims.md").read_text(encoding="utf-8")
ROWS = [[cell.strip() for cell in line.split(" | ")] for line in PAGE.splitlines() if re.match(r"\| \d+ \|", line)]


def functions() -> set[str]:
    """The names of all tests."""
    texts = (path.read_text(encoding="utf-8") for path in (ROOT / "tests").rglob("test_*.py"))
    return {name for text in texts for name in re.findall(r"^def (test_\w+)\(", text, re.MULTILINE)}


def test_every_claim_has_a_row_with_a_finding():
    assert {int(row[0].strip("| ")) for row in ROWS} >= set(range(1, 31))
    assert all(len(row) == 5 and row[1] and row[3] and row[4].strip("| ") for row in ROWS)


def test_every_test_that_the_page_names_is_there():
    named = set(re.findall(r"`(test_\w+)`", PAGE))
    assert len(named) > 30 and named - functions() == set()


def test_every_test_of_these_claims_is_on_the_page():
    of_claims = {name for name in functions() if re.match(r"test_claim_(\d|1\d|2\d)_", name)}
    assert of_claims - set(re.findall(r"`(test_\w+)`", PAGE)) == set()


def test_every_choice_to_compare_with_is_explained():
    for key in ("technique.controller", "technique.equations"):
        assert all(f'| `"{word}"` |' in PAGE for word in field_table()[key].choices)


def test_letters_of_readings_in_tests_are_on_the_page():
    used = set()
    for path in (ROOT / "tests").rglob("*.py"):
        used |= set(re.findall(r"\[(?:reading|claim) ([a-z])\]", path.read_text(encoding="utf-8")))
    assert used and all(f"\n| {letter} |" in PAGE for letter in used)
