"""Checking and reading single values of a run document."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ..errors import SpecError
from . import row_values
from .fields import CHOICE, FLAG, NUMBER, PLACES, ROWS, TEXT, WHOLE, FieldInfo

if TYPE_CHECKING:
    from .run_spec import RunSpec


def check(info: FieldInfo, value: object, spec: RunSpec | None = None) -> None:
    """Raise `SpecError` unless `value` is one the field may have; `spec` lets the message say more."""
    if info.kind == FLAG:
        if not isinstance(value, bool):
            raise SpecError(info.key, value, problem="is not true or false", hint="write true or false without quotes")
    elif info.kind == CHOICE:
        if value not in info.choices:
            raise SpecError(info.key, value, info.allowed, "choose one of these", problem="is not one of")
    elif info.kind == TEXT:
        _check_text(info, value)
    elif info.kind == ROWS:
        row_values.check_rows(info, value, check)
    elif info.kind == PLACES:
        _check_places(info, value)
    elif not (info.word and isinstance(value, str) and value == info.word):
        _check_number(info, value, spec)


def canonical(info: FieldInfo, value: Any) -> Any:
    """Return a checked value in the type of its field (2 -> 2.0 for a number, 6.0 -> 6 for a whole one)."""
    if info.kind == ROWS:
        return row_values.map_rows(info, value, canonical)
    if info.kind == PLACES:
        return tuple((float(x) + 0.0, float(y) + 0.0) for x, y in value)
    if info.kind == NUMBER and not isinstance(value, str):
        return float(value) + 0.0  # no negative zero
    return int(value) if info.kind == WHOLE else value


def parse_text(info: FieldInfo, value: object) -> object:
    """Read what a person wrote after `key=`: a TOML value, a bare word, or plain text for a text field.

    Values that are not strings are returned as they are.
    """
    if not isinstance(value, str):
        return value
    stripped = value.strip()
    if not stripped:
        if info.kind == TEXT:
            return ""
        raise SpecError(info.key, problem="has no value", hint=f"give one of: {info.allowed}")
    if info.kind == TEXT and stripped[0] not in "\"'":
        return value
    import tomllib

    try:
        parsed = tomllib.loads(f"value = {stripped}")
    except (ValueError, RecursionError):
        return _number_or_word(stripped)
    return parsed["value"] if parsed.keys() == {"value"} else stripped


def _number_or_word(written: str) -> float | str:
    try:
        return float(written)  # ".5" and "5." are numbers to people, though not to TOML
    except ValueError:
        return written


def _check_text(info: FieldInfo, value: object) -> None:
    if not isinstance(value, str):
        raise SpecError(info.key, value, problem="is not text", hint='write it in quotes, for instance "Giant slalom"')
    if len(value) > (info.high or 0):
        problem = f"has {len(value)} characters, allowed are"
        raise SpecError(info.key, value, info.allowed, "shorten it", problem=problem)
    import unicodedata

    if any(unicodedata.category(letter) in ("Cc", "Cs") for letter in value if letter not in "\n\t"):
        raise SpecError(info.key, value, problem="has control characters", hint="remove them")


def _check_places(info: FieldInfo, value: Any) -> None:
    example = f"write pairs of numbers, for instance [[3, 1.5], [8, 2]], {info.allowed}"
    if not isinstance(value, list | tuple):
        raise SpecError(info.key, value, problem="is not a list of places", hint=example)
    if len(value) > info.most:
        problem = f"has {len(value)} places, allowed are"
        raise SpecError(info.key, None, info.allowed, "take some out", problem=problem)
    for place in value:
        if not isinstance(place, list | tuple) or len(place) != 2:
            raise SpecError(info.key, place, problem="has a place that is no pair of numbers", hint=example)
        for number in place:
            _check_number(replace(info, kind=NUMBER), number, None)


def _check_number(info: FieldInfo, value: Any, spec: RunSpec | None) -> None:
    named = "a whole number" if info.kind == WHOLE else "a number"
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise SpecError(info.key, value, problem=f"is not {named}", hint=f"give {named} in {info.allowed}")
    if isinstance(value, float) and not math.isfinite(value):
        raise SpecError(info.key, value, problem="is not a finite number", hint=f"give {named} in {info.allowed}")
    if info.kind == WHOLE and value != int(value):
        raise SpecError(info.key, value, problem=f"is not {named}", hint=f"give {named} in {info.allowed}")
    if info.low is not None and value < info.low or info.high is not None and value > info.high:
        raise SpecError(info.key, value, info.allowed, f"give {named} in that range{_cost(info, value, spec)}")


def _cost(info: FieldInfo, value: float, spec: RunSpec | None) -> str:
    """Say what a huge number of turns would take, if the rest of the course is known."""
    if spec is None or info.key != "course.turn_count" or value <= (info.high or 0):
        return ""
    from .estimate import estimate_turns  # estimate.py describes RunSpec, which checks its values here

    try:
        return f" ({estimate_turns(spec, int(value)).described})"
    except (TypeError, ValueError, OverflowError, ZeroDivisionError):
        return ""  # another value of the course is wrong too
