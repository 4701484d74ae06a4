"""What is tried: forces, bodies, directions, speeds and moments, as a person writes them and as single cases."""

from __future__ import annotations

import dataclasses
import itertools
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from ..spec import FieldInfo, find_field, row_kinds
from ..spec.fields import CHOICE, NUMBER
from ..spec.values import canonical, check, parse_text

TURN, TRANSITION = "turn", "transition"
MOMENTS = (TURN, TRANSITION)
"""When a push starts: at the apex of a turn, or where the track changes from one turn to the next."""


@dataclass(frozen=True)
class Row:
    """A line of the table: start `speed` [m/s], `moment`, `body` and `direction` of the push."""

    speed: float
    moment: str
    body: str
    direction: str


@dataclass(frozen=True)
class Case:
    """One run: a row of the table and the `force` [N] of the push."""

    row: Row
    force: float


@dataclass(frozen=True)
class PushTable:
    """All combinations of `forces` [N], `bodies`, `directions`, `speeds` [m/s] and `moments`; `duration` [s]."""

    forces: tuple[float, ...] = (50.0, 100.0, 150.0, 200.0)
    bodies: tuple[str, ...] = ("head", "ski.R", "abdomen", "shank.L")
    directions: tuple[str, ...] = ("left", "right", "forward", "back")
    speeds: tuple[float, ...] = (5.0, 9.0)
    moments: tuple[str, ...] = MOMENTS
    duration: float = 0.5

    @property
    def rows(self) -> tuple[Row, ...]:
        """The lines of the table, those of one speed after each other."""
        return tuple(
            Row(*values) for values in itertools.product(self.speeds, self.moments, self.bodies, self.directions)
        )

    @property
    def cases(self) -> tuple[Case, ...]:
        """All runs, those of one speed after each other."""
        return tuple(Case(row, force) for row in self.rows for force in self.forces)


def read_table(**written: str | None) -> PushTable:
    """Return a table from what a person wrote after `--forces` and so on: values with commas between them.

    What is None keeps its default. Raises `SpecError` naming the option.
    """
    values: dict[str, Any] = {}
    for name, text in written.items():
        if text is None:
            continue
        info = dataclasses.replace(_field(name), key=f"--{name}")
        if name == "duration":
            values[name] = _read(info, text)
            continue
        several = _without_repeats(_read(info, part) for part in text.split(","))
        values[name] = tuple(sorted(several)) if info.kind == NUMBER else several
    return PushTable(**values)


def _field(name: str) -> FieldInfo:
    push = {info.name: info for info in row_kinds()["push"].row_fields}
    if name == "moments":
        return FieldInfo("", CHOICE, TURN, "", choices=MOMENTS)
    if name == "speeds":
        return find_field("course.start_speed")
    singular = {"forces": "force", "bodies": "body", "directions": "direction", "duration": "duration"}
    return push[singular[name]]


def _read(info: FieldInfo, text: str) -> Any:
    value = parse_text(info, text)
    check(info, value)
    return canonical(info, value)


def _without_repeats(values: Iterable[Any]) -> tuple[Any, ...]:
    return tuple(dict.fromkeys(values))
