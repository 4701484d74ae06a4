"""Rows of a run document (gates, times of a rhythm, obstacles, pushes) as lists in Blender, there and back.

A row remembers the document's own text of its values: those that nobody changed come back as they were written, with
all the digits that Blender's single precision has no room for.
"""

from __future__ import annotations

import json
from typing import Any

import bpy

from ..errors import SpecError
from ..spec import FieldInfo, row_kinds
from ..spec.fields import NUMBER, PLACES
from .fields import Changed, make_properties, read_field, shortest, write_field

LISTED = ("gate", "rhythm", "obstacle", "push")
"""Kinds of rows that have lists; the points of a path come from a curve, for they are many."""
_SAME = 1e-6


def row_group(kind: str, changed: Changed) -> type:
    """Return a new property group of one row of a `kind`; `changed` is called after every change by hand."""
    annotations: dict[str, Any] = {"source": bpy.props.StringProperty(default="{}", options={"HIDDEN"})}
    for info in row_kinds()[kind].row_fields:
        if info.kind == PLACES:
            annotations[info.name] = bpy.props.StringProperty(
                name=info.label,
                description=f"{info.doc}, as in 12, 3; 14, 5",
                default="10, 0" if kind == "obstacle" else "",
                update=changed,
            )
        else:
            annotations |= make_properties(info, info.default, changed)
    group = type(f"SKI_PG_{kind}", (bpy.types.PropertyGroup,), {"__doc__": f"One [[{kind}]] of a run."})
    group.__annotations__ = annotations
    return group


def read_rows(settings: Any, kind: str) -> list[dict[str, Any]]:
    """Return the rows of a `kind` as plain tables; raises `SpecError` for places that are no numbers."""
    infos = row_kinds()[kind].row_fields
    rows = []
    for index, item in enumerate(getattr(settings, kind)):
        source = json.loads(item.source)
        rows.append({info.name: _value(item, info, source, f"{kind} {index + 1}") for info in infos})
    return rows


def write_rows(settings: Any, kind: str, rows: list[dict[str, Any]]) -> None:
    """Put `rows`, plain tables, in place of those of a `kind`."""
    items = getattr(settings, kind)
    items.clear()
    for row in rows:
        item = items.add()
        for info in row_kinds()[kind].row_fields:
            value = row.get(info.name, info.default)
            if info.kind == PLACES:
                setattr(item, info.name, written_places(value))
            else:
                write_field(item, info, value)
        item.source = json.dumps(row)


def _value(item: Any, info: FieldInfo, source: dict[str, Any], name: str) -> Any:
    """Return the value of one field, as its `source` has it if nobody changed it."""
    before = source.get(info.name, info.default)
    if info.kind == PLACES:
        text = getattr(item, info.name)
        return before if text == written_places(before) else read_places(text, f"{name}: {info.name}")
    value = read_field(item, info)
    if info.kind == NUMBER and not isinstance(value, str) and not isinstance(before, str):
        rounded = shortest(float(before), info)
        return before if abs(value - rounded) <= _SAME * max(1.0, abs(rounded)) else value
    return value


def written_places(places: Any) -> str:
    """Return pairs of numbers as one line: "12, 3; 14, 5"."""
    return "; ".join(f"{x:.9g}, {y:.9g}" for x, y in places)


def read_places(text: str, name: str) -> list[list[float]]:
    """Return the pairs of numbers that `text` has; raises `SpecError` with the `name` of the field."""
    pairs = []
    for pair in filter(str.strip, text.split(";")):
        try:
            x, y = (float(part) for part in pair.split(","))
        except ValueError:
            raise SpecError(name, text, "pairs of metres", "write them as in 12, 3; 14, 5", problem="is not") from None
        pairs.append([x, y])
    return pairs


STEP = {"gate": ("x", 10.0), "rhythm": ("time", 5.0), "push": ("start", 3.0)}
"""By how much a new row is further on than the one it follows."""


def duplicate_row(settings: Any, kind: str) -> None:
    """Add a row of a `kind` after the chosen one, like it but further on, and choose it."""
    rows, index = read_rows(settings, kind), getattr(settings, f"{kind}_index")
    if rows:
        index = min(max(index, 0), len(rows) - 1)
        row = dict(rows[index])
        if kind in STEP:
            name, step = STEP[kind]
            row[name] = min(row[name] + step, float(find_high(kind, name)))
        rows.insert(index + 1, row)
        index += 1
    else:
        rows, index = [{info.name: info.default for info in row_kinds()[kind].row_fields}], 0
        if kind == "obstacle":
            rows[0]["points"] = [[10.0, 0.0]]
    write_rows(settings, kind, rows)
    setattr(settings, f"{kind}_index", index)


def find_high(kind: str, name: str) -> float:
    """Return the largest value that a field of a row may have."""
    return next(info.high or 0.0 for info in row_kinds()[kind].row_fields if info.name == name)
