"""Keys of a run that a job varies: read from `--vary KEY=VALUE,VALUE`, and every run that comes of them."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from ..errors import SpecError
from ..spec.fields import CHOICE, FLAG, NUMBER, WHOLE, FieldInfo
from ..spec.values import parse_text
from ..sweep.written import read_written

if TYPE_CHECKING:
    from .subjects import Subject

RUNS_MAX = 256
"""The most runs of one job."""
KEYS_MAX = 15
"""The most keys that can be varied: Open Job Description has 16 task parameters, and one is for the frames."""
VARIED = (NUMBER, WHOLE, FLAG, CHOICE)
"""Kinds of keys that can be varied; texts and lists cannot be told apart in a name of a folder."""


@dataclass(frozen=True)
class Variation:
    """A varied key: its `values`, all of one `kind` of task parameter ("FLOAT", "INT" or "STRING")."""

    key: str
    kind: str
    values: tuple[int | float | str, ...]

    @property
    def parameter(self) -> str:
        """Name of the task parameter: the key, with letters that a name may have."""
        return self.key.replace(".", "_")


def read_variations(written: Sequence[str], subject: Subject) -> tuple[Variation, ...]:
    """Return what `--vary` asks for; raises `SpecError` naming the key, or the option."""
    table = read_written(written, subject.find_key, RUNS_MAX)
    if len(table) > KEYS_MAX:
        raise SpecError("--vary", len(table), f"1..{KEYS_MAX} keys", "vary fewer keys")
    return tuple(_variation(key, info, texts, subject) for key, (info, texts) in table.items())


def list_changes(variations: Sequence[Variation], *, pairs: bool) -> list[dict[str, int | float | str]]:
    """Return the changes of every run: each value with each, or with `pairs` the first ones together and so on.

    Without variations that is one run with no change. Raises `SpecError`.
    """
    columns = [variation.values for variation in variations]
    if pairs and len({len(column) for column in columns}) > 1:
        counts = ", ".join(f"{variation.key} has {len(variation.values)}" for variation in variations)
        raise SpecError("--pairs", problem=f"needs as many values of each key, but {counts}", hint="even them up")
    count = len(columns[0]) if pairs and columns else math.prod(map(len, columns))
    if count > RUNS_MAX:
        raise SpecError("--vary", problem=f"makes {count} runs, allowed are {RUNS_MAX}", hint="name fewer values")
    keys = [variation.key for variation in variations]
    rows = zip(*columns, strict=True) if pairs and columns else itertools.product(*columns)
    return [dict(zip(keys, row, strict=True)) for row in rows]


def _variation(key: str, info: FieldInfo, texts: Sequence[str], subject: Subject) -> Variation:
    if info.kind not in VARIED:
        hint = "vary a number, a switch or a choice, or write several run documents"
        raise SpecError(f"--vary {key}", problem="is a text or a list, which cannot be varied", hint=hint)
    read = [parse_text(info, text) for text in texts]
    for value in read:
        subject.changed({key: value})  # says what is wrong with one that is not allowed
    return Variation(key, *_typed(info, list(dict.fromkeys(read))))  # 10 and 10.0 are one


def _typed(info: FieldInfo, read: list[object]) -> tuple[str, tuple[int | float | str, ...]]:
    """Return the kind of task parameter that holds the values, and the values as it writes them."""
    if info.kind == FLAG:
        return "STRING", tuple("true" if value else "false" for value in read)
    if info.kind == CHOICE or any(isinstance(value, str) for value in read):
        return "STRING", tuple(value if isinstance(value, str) else _number_text(value) for value in read)
    if info.kind == WHOLE:
        return "INT", tuple(int(value) for value in read)  # type: ignore[call-overload]
    return "FLOAT", tuple(_shortest(value) for value in read)


def _shortest(value: object) -> int | float:
    number = float(value)  # type: ignore[arg-type]
    return int(number) if number == int(number) else number


def _number_text(value: object) -> str:
    return repr(_shortest(value))
