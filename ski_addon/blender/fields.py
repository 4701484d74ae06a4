"""Blender properties made from the one table of a run document's keys, and values moved between the two.

Blender keeps numbers in single precision and angles in radians; values are read back as the shortest decimal number
that has the same single-precision bits, so that 0.071 stays 0.071 and the run document's hash stays the same.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import bpy
import numpy as np

from ..spec import FieldInfo
from ..spec.fields import CHOICE, FLAG, TEXT, WHOLE

UNITS = {"m": "LENGTH", "m/s": "VELOCITY", "s": "TIME_ABSOLUTE", "kg": "MASS", "deg": "ROTATION"}
"""Blender's unit by the table's; others are shown as plain numbers."""
WORD_SUFFIX = "_word"
"""Ending of the switch that stands for a field's word ("auto", "unlimited")."""
FILE_SUFFIX = "_file"
"""Ending of the fields that name a file."""
Changed = Callable[[Any, Any], None]
"""What Blender calls after a property was changed, with its group and the context."""


def make_properties(info: FieldInfo, value: Any, changed: Changed | None = None) -> dict[str, Any]:
    """Return the Blender properties of one field by name, with the default `value` of the run document.

    `changed` is called after every change.
    """
    common: dict[str, Any] = {"name": info.label or info.name, "description": info.doc, "update": changed}
    if info.kind == FLAG:
        return {info.name: bpy.props.BoolProperty(default=value, **common)}
    if info.kind == CHOICE:
        items = [(choice, choice.replace("_", " ").capitalize(), "") for choice in info.choices]
        return {info.name: bpy.props.EnumProperty(items=items, default=value, **common)}
    if info.kind == TEXT:
        if info.name.endswith(FILE_SUFFIX):
            common |= {"subtype": "FILE_PATH", "options": {"ANIMATABLE", "PATH_SUPPORTS_BLEND_RELATIVE"}}
        return {info.name: bpy.props.StringProperty(default=value, maxlen=int(info.high or 0), **common)}
    if info.kind == WHOLE:
        low, high = int(info.low or 0), int(info.high or 2**31 - 1)
        return {info.name: bpy.props.IntProperty(default=value, min=low, max=high, **common)}
    return _number_properties(info, value, common)


def _number_properties(info: FieldInfo, value: Any, common: dict[str, Any]) -> dict[str, Any]:
    made: dict[str, Any] = {}
    number = value
    if info.word:
        switch = f"{common['description']}: {info.word}"
        made[info.name + WORD_SUFFIX] = bpy.props.BoolProperty(
            name=info.word.capitalize(), description=switch, default=value == info.word, update=common["update"]
        )
        number = _some_number(info) if value == info.word else value
    scale = math.radians(1.0) if info.unit == "deg" else 1.0
    span = float((info.high or 0.0) - (info.low or 0.0))
    made[info.name] = bpy.props.FloatProperty(
        default=number * scale,
        min=float(info.low or 0.0) * scale,
        max=float(info.high or 0.0) * scale,
        unit=UNITS.get(info.unit, "NONE"),
        subtype="ANGLE" if info.unit == "deg" else "NONE",
        precision=3 if info.unit in UNITS or span < 0.1 else 2,  # a number with a unit is shown without zeros behind it
        step=100 if span > 20 else 10 if span > 2 else 1,
        **common,
    )
    return made


def _some_number(info: FieldInfo) -> float:
    """Return a number to start from for a field that has a word now."""
    low, high = float(info.low or 0.0), float(info.high or 1.0)
    return round(math.sqrt(low * high) if low > 0.0 else low + 0.4 * (high - low), 2)


def read_field(group: Any, info: FieldInfo) -> Any:
    """Return the run document's value of a field from its property group."""
    if info.word and getattr(group, info.name + WORD_SUFFIX):
        return info.word
    value = getattr(group, info.name)
    if info.name.endswith(FILE_SUFFIX) and value.startswith("//"):
        return bpy.path.abspath(value)  # Blender writes paths relative to its own file so
    if info.kind in (FLAG, CHOICE, TEXT, WHOLE):
        return value
    return shortest(math.degrees(value) if info.unit == "deg" else value, info)


def shortest(value: float, info: FieldInfo) -> float:
    """Return the shortest decimal number that single precision cannot tell from `value`, within the field's range."""
    number = float(f"{value:.6g}") if info.unit == "deg" else float(str(np.float32(value)))
    low, high = info.low, info.high
    if low is not None and number < low and math.isclose(number, low, rel_tol=1e-6, abs_tol=1e-9):
        return float(low)
    if high is not None and number > high and math.isclose(number, high, rel_tol=1e-6):
        return float(high)
    return number


def write_field(group: Any, info: FieldInfo, value: Any) -> None:
    """Set a field's properties in its group to the run document's `value`."""
    if info.word:
        setattr(group, info.name + WORD_SUFFIX, value == info.word)
        if value == info.word:
            return
    setattr(group, info.name, math.radians(value) if info.unit == "deg" else value)
