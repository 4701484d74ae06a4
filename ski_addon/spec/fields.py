"""What one key of a run document is: kind, unit, range, choices and meaning, kept as dataclass field metadata.

Validation, the key reference in `docs/run_spec.md` and Blender's properties are all made from this one table.
"""

from __future__ import annotations

import functools
import re
from dataclasses import field, fields
from typing import Any

from .records import record

NUMBER, WHOLE, FLAG, CHOICE, TEXT = "number", "whole", "flag", "choice", "text"
PLACES, ROWS = "places", "rows"


@record(frozen=True)
class FieldInfo:
    """One key of a run document.

    `kind` is "number", "whole", "flag", "choice", "text", "places" or "rows"; `low` and `high` bound numbers (`high` is
    the most characters of a text and the most rows of rows, `most` the most places); `choices` are the words a choice
    may have; `word` is the one word ("auto", "unlimited") a number may be replaced with, or "". `unit` is SI, except
    degrees in keys ending in `_deg`.
    A key with `kinds` matters (and may be required) only where its section's `kind` is one of them.
    The value of "rows" is a tuple of instances of the frozen dataclass `row`, in a document an array of tables.
    """

    key: str
    kind: str
    default: Any
    doc: str
    label: str = ""
    unit: str = ""
    low: float | None = None
    high: float | None = None
    choices: tuple[str, ...] = ()
    word: str = ""
    advanced: bool = False
    required: bool = False
    kinds: tuple[str, ...] = ()
    row: type | None = None
    most: int = 0

    @property
    def row_fields(self) -> tuple[FieldInfo, ...]:
        """Fields of one row, with keys as "gate.radius"; () for a field that is not rows."""
        return field_infos(f"{self.key}.", self.row) if self.row else ()

    @property
    def section(self) -> str:
        """Section of the key ("course"), or "" for a key of the document itself."""
        return self.key.rpartition(".")[0]

    @property
    def name(self) -> str:
        """Key within its section ("turn_radius")."""
        return self.key.rpartition(".")[2]

    @property
    def allowed(self) -> str:
        """The allowed values as a person reads them ("3..200 m", "right, left")."""
        if self.kind == FLAG:
            return "true, false"
        if self.kind == CHOICE:
            return ", ".join(self.choices)
        if self.kind == TEXT:
            return f"at most {self.high:g} characters"
        if self.kind == ROWS:
            return f"at most {self.high:g} rows"
        if self.kind == PLACES:
            return f"at most {self.most} pairs of {show_number(self.low)}..{show_number(self.high)} {self.unit}"
        span = f"{show_number(self.low)}..{show_number(self.high)}{' ' + self.unit if self.unit else ''}"
        return f"{span} or {self.word}" if self.word else span


@functools.cache
def field_infos(prefix: str, cls: type) -> tuple[FieldInfo, ...]:
    """Return the fields declared in a dataclass, in order; `prefix` comes before their names in the keys."""
    leaves = [leaf for leaf in fields(cls) if "kind" in leaf.metadata]
    return tuple(FieldInfo(key=prefix + leaf.name, default=leaf.default, **leaf.metadata) for leaf in leaves)


def show_number(value: float | None) -> str:
    """Return a number as people write it: 0.25, 15, 1.2e8."""
    if value is None:
        return "any"
    if value == int(value) and (abs(value) < 1e6 or value % 1e6):
        return str(int(value))
    return re.sub(r"e([+-])0*", lambda sign: "e" + sign[1].replace("+", ""), f"{value:g}")


def _leaf(default: Any, **metadata: Any) -> Any:
    return field(default=default, metadata=metadata)


def number(default: float | str, low: float, high: float, unit: str, label: str, doc: str, **more: Any) -> Any:
    """Declare a float in `low`..`high` [`unit`]; `word="auto"` also allows that word."""
    return _leaf(default, kind=NUMBER, low=low, high=high, unit=unit, label=label, doc=doc, **more)


def whole(default: int, low: int, high: int, unit: str, label: str, doc: str, **more: Any) -> Any:
    """Declare a whole number in `low`..`high`."""
    return _leaf(default, kind=WHOLE, low=low, high=high, unit=unit, label=label, doc=doc, **more)


def flag(default: bool, label: str, doc: str, **more: Any) -> Any:
    """Declare a true or false switch."""
    return _leaf(default, kind=FLAG, label=label, doc=doc, **more)


def choice(default: str, choices: tuple[str, ...], label: str, doc: str, **more: Any) -> Any:
    """Declare one word out of `choices`."""
    return _leaf(default, kind=CHOICE, choices=choices, label=label, doc=doc, **more)


def text(default: str, most: int, label: str, doc: str, **more: Any) -> Any:
    """Declare free text of at most `most` characters."""
    return _leaf(default, kind=TEXT, high=most, label=label, doc=doc, **more)


def places(most: int, low: float, high: float, unit: str, label: str, doc: str, **more: Any) -> Any:
    """Declare places, pairs of numbers in `low`..`high` [`unit`], at most `most` of them."""
    return _leaf((), kind=PLACES, most=most, low=low, high=high, unit=unit, label=label, doc=doc, **more)


def rows(row: type, most: int, label: str, doc: str) -> Any:
    """Declare an array of at most `most` tables, each one a frozen dataclass `row` of fields declared as here."""
    return _leaf((), kind=ROWS, row=row, high=most, label=label, doc=doc)
