"""Random run documents, made from the table of keys: a new key is tried without anybody thinking of it."""

from __future__ import annotations

import random
from typing import Any

from ski_addon.errors import SkiAddonError
from ski_addon.spec import FieldInfo, RunSpec, field_table, list_presets
from ski_addon.spec.fields import CHOICE, FLAG, PLACES, ROWS, TEXT, WHOLE

FIXED = ("slope.grid_file", "name", "description")
"""Keys that random values say nothing about: files, which have tests of their own, and words for people."""
SHORT = {"course.turn_count": 4, "course.turn_duration": 4.0}
"""Keys whose random values stay below this, so that thousands of runs can be planned."""
MOST_ROWS = 5


def random_value(info: FieldInfo, chance: random.Random) -> Any:
    """Return a value within the range of a key: anywhere, at its ends, or near its default."""
    if info.kind == FLAG:
        return chance.random() < 0.5
    if info.kind == CHOICE:
        return chance.choice(info.choices)
    if info.kind == TEXT:
        return "".join(chance.choice("abc é/.\\\"'\n=[]{}%~\t") for _ in range(chance.randint(0, 12)))
    if info.kind == PLACES:
        return [[random_number(info, chance), random_number(info, chance)] for _ in range(chance.randint(0, MOST_ROWS))]
    if info.kind == ROWS:
        return [
            {field.name: random_value(field, chance) for field in info.row_fields}
            for _ in range(chance.randint(0, MOST_ROWS))
        ]
    if info.word and chance.random() < 0.3:
        return info.word
    value = random_number(info, chance)
    return round(value) if info.kind == WHOLE else value


def random_number(info: FieldInfo, chance: random.Random) -> float:
    """Return a number within the range of a key."""
    low, high = float(info.low or 0.0), float(info.high or 0.0)
    high = min(high, SHORT.get(info.key, high))
    how = chance.random()
    if how < 0.1:
        return low
    if how < 0.2:
        return high
    if how < 0.6 and isinstance(info.default, int | float):
        near = float(info.default) * chance.uniform(0.5, 1.6) + chance.uniform(-0.01, 0.01)
        return min(max(near, low), high)
    if low > 0.0 and high / low > 1e3:
        return low * (high / low) ** chance.random()
    return chance.uniform(low, high)


def random_spec(seed: int) -> RunSpec | None:
    """Return a valid run: a shipped one, shortened, with some keys changed; None if no such change was valid."""
    chance = random.Random(seed)
    start = RunSpec.from_toml(chance.choice(list_presets("runs")).path)
    start = start.with_overrides({"course.turn_count": min(start.course.turn_count, 3)})
    fields = [info for key, info in sorted(field_table().items()) if key not in FIXED]
    for _ in range(20):
        some = chance.sample(fields, chance.choice((1, 2, 3, 5, 8, 15, len(fields))))
        try:
            return start.with_overrides({info.key: random_value(info, chance) for info in some}).validate()
        except SkiAddonError:  # keys that contradict each other: said in one line, and tried again
            continue
    return None
