"""The runs of a sweep: every combination of the values that were written after `--vary`."""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ..errors import SpecError, one_line
from ..spec import RunSpec, find_key
from ..tasks.keys import digest
from .written import read_written

MOST = 10_000
"""Most runs of one sweep."""
LONGEST = 80
"""Most letters of a folder's name."""


@dataclass(frozen=True)
class Combination:
    """One run of a sweep: the `values` that were written for its keys, its whole `spec`, and the `name` of its folder,
    which does not change when others join the sweep.
    """

    values: dict[str, str]
    spec: RunSpec
    name: str


def read_variations(spec: RunSpec, written: Sequence[str]) -> list[Combination]:
    """Return the combinations of `written` (`KEY=VALUE,VALUE,...` each), the last key changing first.

    See `read_written`. Raises `SpecError` for a wrong key or value.
    """
    return combine(spec, {key: texts for key, (_, texts) in read_written(written, find_key, MOST).items()})


def combine(spec: RunSpec, values: Mapping[str, Sequence[str]]) -> list[Combination]:
    """Return every combination of the `values` of dotted keys, texts as after `--set`, the last key changing first.

    Raises `SpecError` for a wrong key or value, and for more than `MOST` runs.
    """
    table = {key: list(dict.fromkeys(texts)) for key, texts in values.items()}
    for key, texts in table.items():
        if not texts:
            raise SpecError(key, problem="has no values", hint="give one or more, or leave the key out")
    count = math.prod(len(texts) for texts in table.values())
    if count > MOST:
        raise SpecError("--vary", count, f"1..{MOST} runs", "vary fewer keys, or with fewer values")
    return _without_repeats([_combination(spec, dict(zip(table, row, strict=True))) for row in _rows(table)])


def _rows(table: dict[str, list[str]]) -> list[tuple[str, ...]]:
    return list(itertools.product(*table.values()))


def _combination(spec: RunSpec, values: dict[str, str]) -> Combination:
    return Combination(values, spec.with_overrides(values), _folder_name(values))


def _without_repeats(combinations: list[Combination]) -> list[Combination]:
    """Return the combinations with each run once: `10` and `10.0` are one."""
    return list({combination.spec.content_hash(): combination for combination in reversed(combinations)}.values())[::-1]


def _folder_name(values: dict[str, str]) -> str:
    """Return a name that any file system takes: `turn_radius=10,friction=0.05`."""
    short = [key.rpartition(".")[2] for key in values]
    labels = short if len(set(short)) == len(short) else list(values)
    words = ",".join(f"{label}={value}" for label, value in zip(labels, values.values(), strict=True))
    name = re.sub(r"[^A-Za-z0-9_=,.+-]+", "-", one_line(words)) or "as_it_is"
    return name if len(name) <= LONGEST else f"{name[: LONGEST - 9]}-{digest(values)[:8]}"
