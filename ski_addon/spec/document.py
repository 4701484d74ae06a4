"""Reading and writing the TOML document of a run: a few keys, then sections of keys."""

from __future__ import annotations

import contextlib
import json
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from ..errors import MissingInputError, SpecError, show_path
from .records import record

SIZE_MAX = 1_000_000
"""A run document larger than this [bytes] is not one."""
WANTED = "give a run document, for instance one of presets/runs"
_MANY_DOTS = r"""(?<![\w"'-])(?:["']?[\w-]++["']?\.){30}"""
"""A key of more than 30 parts: reading thousands of them would take Python's reader minutes."""
_HEADER = r"\s*(\[\[?)\s*([\w.-]+)\s*\]"
_WRITTEN = r"\s*([\w.-]+)\s*="


@record(frozen=True)
class SourceDocument:
    """A TOML document: the name of its source, its text and the nested tables in it."""

    source: str
    text: str
    content: Mapping[str, Any]

    @contextlib.contextmanager
    def errors_named(self) -> Iterator[None]:
        """Give every `SpecError` raised inside the source, and the line of its key if the text has it."""
        try:
            yield
        except SpecError as error:
            line = find_line(self.text, error.field)
            source = show_path(self.source)
            raise error.in_source(f"{source} line {line}" if line else source) from None


def read_text(path: Path) -> str:
    """Return the text of a document; raises `MissingInputError` if it cannot be read, `SpecError` if it is no text."""
    try:
        with path.open("rb") as stream:
            raw = stream.read(SIZE_MAX + 1)
    except FileNotFoundError:
        raise MissingInputError(path) from None
    except IsADirectoryError:
        raise MissingInputError(path, "it is a folder, not a run document") from None
    except (OSError, ValueError) as error:
        raise MissingInputError(path, getattr(error, "strerror", None) or str(error)) from None
    if len(raw) > SIZE_MAX:
        raise SpecError(show_path(path), problem="is too large to be a run document", hint=WANTED)
    try:
        return raw.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError:
        raise SpecError(show_path(path), problem="is not a text file", hint=WANTED) from None


def parse_document(text: str, source: str) -> SourceDocument:
    """Parse TOML text; raises `SpecError` naming the source and the line if it is not TOML."""
    import tomllib

    if re.search(_MANY_DOTS, text):
        raise SpecError(show_path(source), problem="has a key of more than 30 parts", hint=WANTED)
    try:
        return SourceDocument(source, text, tomllib.loads(text))
    except (ValueError, RecursionError) as error:
        raise SpecError(show_path(source), problem="is not valid TOML", hint=str(error)) from None


def write_document(content: Mapping[str, Any]) -> str:
    """Return nested tables (keys, then one level of sections and arrays of tables) as TOML text."""
    lines = _toml_lines({key: value for key, value in content.items() if not isinstance(value, Mapping | list)})
    for section, value in content.items():
        if isinstance(value, Mapping):
            lines += ["", f"[{section}]", *_toml_lines(value)]
        elif isinstance(value, list):
            for row in value:
                lines += ["", f"[[{section}]]", *_toml_lines(row)]
    return "\n".join(lines) + "\n"


def find_line(text: str, key: str) -> int | None:
    """Return the line number (from 1) on which a key stands in a document, or None.

    A key is dotted, "[section]", or in a row "gate 3: radius"; of what is not written down, the row or rows are found.
    """
    in_row = re.fullmatch(r"(\w+) (\d+)(?:: (.*))?", key, re.DOTALL)
    if in_row:
        return _find_row_line(text, in_row[1], int(in_row[2]), in_row[3] or "") or find_line(text, in_row[1])
    section, _, name = key.rpartition(".")
    here = ""
    for count, line in enumerate(text.split("\n"), start=1):
        header = re.match(_HEADER, line)
        here = header[2] if header else here
        if header and key in (f"[{here}]", here):
            return count
        written = re.match(_WRITTEN, line)
        if written and written.group(1) in ((name,) if here == section else (key,)):
            return count
    return None


def _find_row_line(text: str, rows: str, number: int, name: str) -> int | None:
    """Return the line of `name`, or else of the header, in the row `[[rows]]` of that number (from 1)."""
    found, head, inside = 0, None, False
    for count, line in enumerate(text.split("\n"), start=1):
        header = re.match(_HEADER, line)
        if header:
            found += header[1] == "[[" and header[2] == rows
            inside = header[1] == "[[" and header[2] == rows and found == number
            head = count if inside else head
        written = re.match(_WRITTEN, line)
        if inside and written and written[1] == name:
            return count
    return head


def _toml_lines(values: Mapping[str, Any]) -> list[str]:
    return [f"{key} = {_toml_value(value)}" for key, value in values.items()]


def _toml_value(value: bool | int | float | str | list) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return f"[{', '.join(map(_toml_value, value))}]"
    return repr(value)
