"""The pages of the documentation: all in the index, links to headings lead somewhere, keys and commands exist."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest

from ski_addon.parser import build_parser
from ski_addon.spec import SECTIONS, field_table

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
NAMES = [str(page.relative_to(ROOT)) for page in PAGES]


def anchors(page: Path) -> set[str]:
    """The names of a page's headings, as GitHub makes them."""
    headings = re.findall(r"^#+ (.+)$", re.sub(r"```.*?```", "", page.read_text(), flags=re.DOTALL), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_links_to_headings_lead_somewhere(page):
    for target, heading in re.findall(r"\]\((?!https?:)([^)#]*)#([^)]+)\)", page.read_text(encoding="utf-8")):
        there = (page.parent / target) if target else page
        assert heading in anchors(there), f"{page.name} links to {target}#{heading}"


def test_every_page_is_in_the_index():
    index = (ROOT / "docs" / "README.md").read_text(encoding="utf-8")
    for page in (ROOT / "docs").glob("*.md"):
        assert page.name == "README.md" or f"({page.name})" in index, page.name


def test_every_picture_is_on_a_page():
    text = "".join(page.read_text(encoding="utf-8") for page in PAGES)
    assert {path.name for path in (ROOT / "docs" / "images").iterdir()} <= set(re.findall(r"images/([\w.]+)", text))


NO_KEYS = {"skier.blend", "snow.penetration_depth"}
"""Names of a file and of a function that look like keys."""


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_keys_on_pages_are_keys_of_a_run(page):
    sections = "|".join(SECTIONS)
    for key in re.findall(rf"`(?:--set )?((?:{sections})\.[a-z_]+)(?![\w.(])", page.read_text(encoding="utf-8")):
        key = key.removesuffix("_word")  # how Blender calls the word that a number may be
        assert key in field_table() or key in NO_KEYS, f"{page.name} names {key}"


COMMAND = re.compile(r"^    (?:\S*python -m ski_addon|ski|blender --command ski) (.*?)(?:  .*|#.*)?$", re.MULTILINE)
"""A command, which a remark may follow."""


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_commands_on_pages_can_be_said(page):
    for written in COMMAND.findall(page.read_text(encoding="utf-8")):
        if re.search(r"\.\.\.|\[|--help|[A-Z]{3}", written):
            continue  # a pattern, not a command
        words = shlex.split(written)
        assert build_parser().parse_args(words), written
