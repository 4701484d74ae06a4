"""Random values and documents made from the table of keys, for tests that hold for every key."""

from __future__ import annotations

import dataclasses
import random
import string
from typing import Any

from ski_addon.spec import FieldInfo, RunSpec, field_table
from ski_addon.spec.fields import CHOICE, FLAG, NUMBER, PLACES, ROWS, TEXT, WHOLE
from ski_addon.spec.table import get_value

ROW_KEYS = tuple(key for key, info in field_table().items() if info.kind == ROWS)
KEYS = tuple(key for key in field_table() if key not in ROW_KEYS)
"""Keys of one value each."""
NUMBERS = tuple(key for key, info in field_table().items() if info.kind in (NUMBER, WHOLE))
LETTERS = string.printable[:95] + "\n\tÄéßñ雪⛷\u00a0\u2028\\\"'"
"""Letters that a text may have, those among them that TOML and JSON must escape."""


def random_value(info: FieldInfo, rng: random.Random) -> Any:
    """A value that the field may have; often one of its bounds, its word, or a whole number for a float."""
    if info.kind == FLAG:
        return rng.random() < 0.5
    if info.kind == CHOICE:
        return rng.choice(info.choices)
    if info.kind == TEXT:
        written = "".join(rng.choices(LETTERS, k=rng.choice((0, 1, 20, int(info.high)))))
        return f"/{written}"[: int(info.high)] if info.key.endswith("_file") else written  # a whole path stays as it is
    if info.kind == ROWS:
        return [random_row(info, rng) for _ in range(rng.choice((1, 2, 5)))]
    if info.kind == PLACES:
        return [[rng.uniform(info.low, info.high) for _ in "xy"] for _ in range(rng.choice((1, 2, 5)))]
    if info.word and rng.random() < 0.2:
        return info.word
    if info.kind == WHOLE:
        return rng.choice((info.low, info.high, rng.randint(info.low, info.high)))
    drawn = rng.choice((info.low, info.high, rng.uniform(info.low, info.high), rng.uniform(info.low, info.high)))
    rounded = round(drawn)
    return rounded if info.low <= rounded <= info.high and rng.random() < 0.2 else drawn


def random_row(info: FieldInfo, rng: random.Random) -> dict[str, Any]:
    """A row with all its keys."""
    return {field.name: random_value(field, rng) for field in info.row_fields}


def held(spec: RunSpec, key: str) -> Any:
    """The value of a key as a document has it: rows as tables."""
    value = get_value(spec, key)
    return [_as_written(dataclasses.asdict(row)) for row in value] if key in ROW_KEYS else value


def _as_written(row: dict[str, Any]) -> dict[str, Any]:
    """A row with its places as the lists that a document has."""
    return {
        name: [list(place) for place in value] if isinstance(value, tuple) else value for name, value in row.items()
    }


def random_flat(rng: random.Random, share: float = 1.0) -> dict[str, Any]:
    """Valid dotted keys with values: each key of the table with probability `share`, in any order."""
    table = [info for info in field_table().values() if rng.random() < share]
    rng.shuffle(table)
    return {info.key: random_value(info, rng) for info in table}


def nested(flat: dict[str, Any]) -> dict[str, Any]:
    """Dotted keys as nested tables, built without the library."""
    content: dict[str, Any] = {}
    for key, value in flat.items():
        section, _, name = key.rpartition(".")
        if section:
            content.setdefault(section, {})[name] = value
        else:
            content[key] = value
    return content


def misspelt(word: str, rng: random.Random) -> str:
    """The word with one letter left out, doubled by another, replaced, or swapped with its neighbour."""
    at, letter = rng.randrange(len(word)), rng.choice(string.ascii_lowercase + "_")
    return rng.choice(
        (
            word[:at] + word[at + 1 :],
            word[:at] + letter + word[at:],
            word[:at] + letter + word[at + 1 :],
            word[:at] + word[at + 1 : at + 2] + word[at] + word[at + 2 :],
        )
    )
