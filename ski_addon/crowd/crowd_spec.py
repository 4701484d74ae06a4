"""`CrowdSpec`: the whole request for a crowd, as data, and its table of keys."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any

from ..errors import SpecError, show_value
from ..spec import FieldInfo, RunSpec
from ..spec.fields import field_infos
from ..spec.values import canonical, check, parse_text
from .sections import MemberRunSpec, SpreadSpec, StartSpec

SECTIONS: Mapping[str, type] = MappingProxyType({"crowd": StartSpec, "spread": SpreadSpec})
"""Section name -> its dataclass, in document order."""
ROWS = FieldInfo("run", "rows", (), "Runs that the members ski", label="Runs", high=200, row=MemberRunSpec)
"""The rows `[[run]]` of a crowd document."""
EVERYWHERE = "all"
"""Table of a crowd document with what is laid over every run: `[all.simulation]` and so on."""
SHIFTED = ("plane", "bumps")
"""Grounds that are the same some metres to the side, so that a run can lie there."""


@dataclass(frozen=True)
class MemberRun:
    """A run that members ski: `spec`, how many `repeat` it in a row, and its `offset` [m] to the left."""

    spec: RunSpec
    repeat: int = 1
    offset: float = 0.0


@dataclass(frozen=True)
class CrowdSpec:
    """A crowd: `crowd` says how many and when, `spread` how they differ, `runs` what they ski, in turns."""

    runs: tuple[MemberRun, ...]
    name: str = "Crowd"
    description: str = ""
    crowd: StartSpec = field(default_factory=StartSpec)
    spread: SpreadSpec = field(default_factory=SpreadSpec)

    def validate(self) -> CrowdSpec:
        """Raise `SpecError` if a value lies outside its range, or lines lie where they cannot; return the spec."""
        for key, info in field_table().items():
            check(info, functools.reduce(getattr, key.split("."), self))
        if not self.runs:
            raise SpecError("run", problem="is missing", hint="write [[run]] with a spec for what the members ski")
        for number, run in enumerate(self.runs, start=1):
            run.spec.validate().check_physics()
            self._check_line(number, run)
            self._check_ground(number, run)
        return self

    def with_values(self, changes: Mapping[str, Any]) -> CrowdSpec:
        """Return a checked copy with dotted keys of `field_table` replaced; strings are read as TOML values."""
        made = self
        for key, written in changes.items():
            info = find_field(key)
            value = parse_text(info, written)
            check(info, value)
            section = replace(getattr(made, info.section), **{info.name: canonical(info, value)})
            made = replace(made, **{info.section: section})
        return made.validate()

    def run_of(self, index: int) -> MemberRun:
        """Return the run of the member `index` (from 0), the same whatever the count."""
        place = index % sum(run.repeat for run in self.runs)
        for run in self.runs:
            if place < run.repeat:
                return run
            place -= run.repeat
        raise IndexError(index)

    def section(self, name: str) -> dict[str, Any]:
        """Return the values of a section by name, numbers as float or int by their field."""
        group = getattr(self, name)
        return {info.name: canonical(info, getattr(group, info.name)) for info in section_fields(name)}

    def _check_line(self, number: int, run: MemberRun) -> None:
        kind = run.spec.slope.kind
        if kind not in SHIFTED and (self.spread.offset or run.offset):
            key = "spread.offset" if self.spread.offset else f"run {number}: offset"
            hint = f"set it to 0 for a slope of kind {kind}, or ski on a plane"
            value = self.spread.offset or run.offset
            raise SpecError(key, value, problem="moves a line off the ground it is made for", hint=hint)
        if run.spec.course.kind in ("gates", "follow") and self.spread.offset:
            hint = "set it to 0, or give rows [[run]] an offset for courses side by side"
            thing = "the gates" if run.spec.course.kind == "gates" else "what they go round"
            problem = f"moves lines away from {thing} of run {number}"
            raise SpecError("spread.offset", self.spread.offset, problem=problem, hint=hint)

    def _check_ground(self, number: int, run: MemberRun) -> None:
        """All ski on one slope: that of the first run."""
        first = self.runs[0].spec.slope
        for name in vars(first):
            mine, here = getattr(first, name), getattr(run.spec.slope, name)
            if mine != here:
                hint = f"give all runs the same slope, for instance under [{EVERYWHERE}.slope]"
                problem = f"is not that of run 1 ({show_value(mine)}), and a crowd skis on one slope"
                raise SpecError(f"run {number}: slope.{name}", here, hint=hint, problem=problem)


@functools.cache
def field_table() -> Mapping[str, FieldInfo]:
    """Return every key of the sections, in document order, with its `FieldInfo`."""
    infos = [info for section in SECTIONS for info in section_fields(section)]
    return MappingProxyType({info.key: info for info in infos})


def section_fields(section: str) -> tuple[FieldInfo, ...]:
    """Return the fields of one section."""
    return field_infos(f"{section}.", SECTIONS[section])


def is_crowd_key(key: str) -> bool:
    """Return whether a dotted key is one of a crowd, not of the runs in it."""
    return key.partition(".")[0] in SECTIONS


def find_field(key: str) -> FieldInfo:
    """Return the field of a dotted key; an unknown one raises `SpecError` with the nearest valid key."""
    import difflib

    info = field_table().get(key)
    if info is None:
        near = difflib.get_close_matches(key[:100], field_table(), n=1, cutoff=0.0)[0]
        raise SpecError(key, problem="is not a key of a crowd", hint=f"did you mean {near}?")
    return info
