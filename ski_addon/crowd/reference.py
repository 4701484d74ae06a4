"""The tables of keys in docs/crowd.md, made from the fields: `python -m ski_addon.crowd.reference`."""

from __future__ import annotations

from pathlib import Path

from .. import atomic
from ..spec.reference import key_table
from .crowd_spec import ROWS, SECTIONS, section_fields

PAGE = Path(__file__).resolve().parents[2] / "docs" / "crowd.md"
BEGIN, END = "<!-- keys -->\n", "<!-- end of the keys -->\n"
"""Lines of the page between which the tables stand."""


def key_tables() -> str:
    """Return the tables of all keys of a crowd document as Markdown."""
    sections = [key_table(f"[{name}]", section_fields(name), cls.__doc__ or "") for name, cls in SECTIONS.items()]
    rows = key_table(f"[[{ROWS.key}]]", ROWS.row_fields, ROWS.row.__doc__ or "" if ROWS.row else "")
    return "\n".join((*sections, rows)).replace("\n## ", "\n### ").replace("## [", "### [", 1)


def with_tables(page: str) -> str:
    """Return the text of the page with its tables made anew."""
    before, rest = page.split(BEGIN)
    return f"{before}{BEGIN}\n{key_tables()}\n{END}{rest.split(END)[1]}"


def write_reference(path: Path = PAGE) -> Path:
    """Make the tables of the page anew, and return where."""
    atomic.write_text(path, with_tables(path.read_text(encoding="utf-8")))
    return path


if __name__ == "__main__":
    write_reference()
