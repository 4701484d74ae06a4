"""Reading, checking and changing rows, the arrays of tables of a run document."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from ..errors import SpecError, show_value
from .fields import FieldInfo
from .records import record
from .table import find_field, row_kinds

if TYPE_CHECKING:
    from .run_spec import RunSpec


@record(frozen=True)
class RowPlace:
    """One value in a row: the field of the rows, the number of the row (from 1) and the field within it."""

    rows: FieldInfo
    number: int
    field: FieldInfo


def read_rows(info: FieldInfo, value: object) -> tuple[Any, ...]:
    """Return rows given as tables (or ready-made ones); the values in them are not checked yet.

    Raises `SpecError` for what is no list of tables, and for unknown and missing keys.
    """
    if not isinstance(value, list | tuple):
        hint = f"write [[{info.key}]] above the keys of each {info.key}"
        raise SpecError(info.key, value, problem="is not a list of tables", hint=hint)
    return tuple(_read_row(info, number, row) for number, row in enumerate(value, start=1))


def check_rows(info: FieldInfo, value: Any, check: Callable[[FieldInfo, object], None]) -> None:
    """Raise `SpecError` unless `value` is a tuple of at most `info.high` rows whose values pass `check`."""
    row_type = info.row or object
    if not isinstance(value, tuple) or not all(isinstance(row, row_type) for row in value):
        hint = f"give a tuple of {row_type.__name__}"
        raise SpecError(info.key, value, problem="is not a tuple of rows", hint=hint)
    if len(value) > (info.high or 0):
        raise SpecError(info.key, None, info.allowed, "take some out", problem=f"has {len(value)} rows, allowed are")
    for number, row in enumerate(value, start=1):
        for field in info.row_fields:
            try:
                check(field, getattr(row, field.name))
            except SpecError as error:
                name = row_key(info, number, field.name)
                raise SpecError(name, error.value, error.allowed, error.hint, problem=error.problem) from None


def map_rows(info: FieldInfo, rows: tuple[Any, ...], change: Callable[[FieldInfo, Any], Any]) -> tuple[Any, ...]:
    """Return rows with `change` applied to every value."""
    fields = info.row_fields
    return tuple(type(row)(**{field.name: change(field, getattr(row, field.name)) for field in fields}) for row in rows)


def plain_rows(rows: tuple[Any, ...]) -> list[dict[str, Any]]:
    """Return rows as tables with all their keys, places as lists."""
    return [{name: _plain(value) for name, value in vars(row).items()} for row in rows]


def _plain(value: Any) -> Any:
    return [list(place) for place in value] if isinstance(value, tuple) else value


def row_key(info: FieldInfo, number: int, name: str) -> str:
    """Return how a message names a value in a row: "gate 3: radius"."""
    return f"{info.key} {number}: {name}"


def find_place(key: str) -> RowPlace | None:
    """Return the value in a row that `gate.2.radius` names, or None for a key that names no row.

    Raises `SpecError` for a number that is none and for an unknown key.
    """
    head, _, rest = key.partition(".")
    info = row_kinds().get(head)
    if info is None or not rest:
        return None
    number, _, name = rest.partition(".")
    fields = {field.name: field for field in info.row_fields}
    if not (number.isascii() and number.isdigit() and int(number[:9]) > 0):
        example = f"{head}.1.{rest if rest in fields else info.row_fields[0].name}"
        raise SpecError(key, problem="names no row", hint=f"write {example} for the first, and so on")
    if name not in fields:
        nearest = f"{head}.{number[:9]}.{_nearest(info, name)}"
        raise SpecError(key, problem="is not a key of a run", hint=f"did you mean {nearest}?")
    return RowPlace(info, int(number[:9]), fields[name])


def find_key(key: str) -> FieldInfo:
    """Return the field of a dotted key of a run, also one of a row ("gate.2.radius"); raises `SpecError`."""
    place = find_place(key)
    return place.field if place else find_field(key)


def with_places(spec: RunSpec, changes: Mapping[RowPlace, object]) -> dict[str, Any]:
    """Return the rows of `spec` with single values changed, as nested tables; a missing row raises `SpecError`."""
    content: dict[str, Any] = {}
    for place, value in changes.items():
        rows = content.setdefault(place.rows.key, list(getattr(spec, place.rows.key)))
        if place.number > len(rows):
            there = f"there are {len(rows)}" if rows else "there are none"
            hint = f"{there}; add [[{place.rows.key}]] to the run document first"
            raise SpecError(f"{place.rows.key} {place.number}", problem="is not there", hint=hint)
        row = rows[place.number - 1]
        rows[place.number - 1] = dataclasses.replace(row, **{place.field.name: value})
    return content


def _read_row(info: FieldInfo, number: int, value: object) -> Any:
    if info.row is not None and isinstance(value, info.row):
        return value
    if info.row is None or not isinstance(value, Mapping):
        name, hint = f"{info.key} {number}", f"write its keys under [[{info.key}]]"
        raise SpecError(name, value, problem="is not a table", hint=hint)
    names = {field.name for field in info.row_fields}
    for name in value:
        if name not in names:
            hint = f"did you mean {_nearest(info, str(name))}?"
            shown = row_key(info, number, show_value(name).strip('"'))
            raise SpecError(shown, problem=f"is not a key of [[{info.key}]]", hint=hint)
    for field in info.row_fields:
        if field.required and field.name not in value:
            meaning = f"{field.doc[0].lower()}{field.doc[1:]} ({field.allowed})"
            hint = f"write {field.name} under [[{info.key}]]: {meaning}"
            raise SpecError(row_key(info, number, field.name), problem="is missing", hint=hint)
    return info.row(**value)


def _nearest(info: FieldInfo, name: str) -> str:
    import difflib

    return difflib.get_close_matches(name[:100], [field.name for field in info.row_fields], n=1, cutoff=0.0)[0]
