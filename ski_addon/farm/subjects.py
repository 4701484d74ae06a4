"""What a job simulates: a run, or a crowd, with the documents of its bundle."""

from __future__ import annotations

import dataclasses
import re
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..crowd import CrowdSpec, is_crowd_key, read_crowd, write_crowd
from ..crowd import crowd_spec as crowd_keys
from ..errors import SpecError
from ..spec import FieldInfo, RunSpec, estimate, find_key
from ..spec.presets import find_ground
from ..spec.sections import SlopeSpec
from . import bundle

RUN_DOCUMENT, CROWD_DOCUMENT = "spec.toml", "crowd.toml"
_OTHER_LETTERS = re.compile(r"[^A-Za-z0-9._-]+")


@dataclass(frozen=True)
class Subject:
    """What a job simulates: `command` simulates the `document` of the bundle, named `name`, at `fps` frames a second.

    `runs` are those that are skied, and `skiers` how many ski. `changed` returns the same with other values of dotted
    keys, checked; `find_key` the field of a dotted key; `documents` the texts of all documents by name, given the path
    of the heights beside them, or "". All three raise `SpecError`.
    """

    command: str
    document: str
    name: str
    fps: float
    runs: tuple[RunSpec, ...]
    skiers: int
    changed: Callable[[Mapping[str, Any]], Subject]
    find_key: Callable[[str], FieldInfo]
    documents: Callable[[str], dict[str, str]]

    @property
    def wall_seconds(self) -> float:
        """About how long simulating takes on one core [s]."""
        return self.skiers * max(estimate(run).wall_seconds for run in self.runs)


def run_subject(spec: RunSpec) -> Subject:
    """Return one run as what a job simulates."""
    return Subject(
        command="simulate",
        document=RUN_DOCUMENT,
        name=spec.name,
        fps=spec.bake.fps,
        runs=(spec,),
        skiers=1,
        changed=lambda changes: run_subject(spec.with_overrides(changes)),
        find_key=find_key,
        documents=lambda ground: {RUN_DOCUMENT: with_ground(spec, ground).to_toml()},
    )


def crowd_subject(path: Path, parts: Sequence[Path], changes: Mapping[str, Any]) -> Subject:
    """Return a crowd, or a run that all ski, read as `read_crowd` does, as what a job simulates; raises as that."""
    crowd = read_crowd(path, parts, changes)
    return Subject(
        command="crowd",
        document=CROWD_DOCUMENT,
        name=crowd.name,
        fps=crowd.runs[0].spec.bake.fps,
        runs=tuple(run.spec for run in crowd.runs),
        skiers=crowd.crowd.count,
        changed=lambda more: crowd_subject(path, parts, {**changes, **more}),
        find_key=lambda key: crowd_keys.find_field(key) if is_crowd_key(key) else find_key(key),
        documents=lambda ground: _crowd_documents(crowd, ground),
    )


def _crowd_documents(crowd: CrowdSpec, ground: str) -> dict[str, str]:
    if ground:
        hint = "use a plane, bumps, moguls or a shipped ground"
        raise SpecError("slope.grid_file", problem="cannot be taken along by the job of a crowd", hint=hint)
    runs = tuple(dataclasses.replace(run, spec=with_ground(run.spec, "")) for run in crowd.runs)
    with tempfile.TemporaryDirectory() as folder:
        write_crowd(dataclasses.replace(crowd, runs=runs), Path(folder), CROWD_DOCUMENT)
        return {path.name: path.read_text(encoding="utf-8") for path in sorted(Path(folder).iterdir())}


def find_heights(slopes: Sequence[SlopeSpec]) -> Path | None:
    """Return the file of heights that one of `slopes` needs, or None; shipped grounds are on every worker.

    Raises `MissingInputError` for one that is not there, or is no file.
    """
    for slope in slopes:
        if slope.kind == "grid" and slope.grid_file:
            path = find_ground(slope.grid_file)
            if str(path) == slope.grid_file:
                bundle.check_plain(path)
                return path
    return None


def plain_name(path: Path) -> str:
    """Return a file name that means nothing to a template, a shell or another system."""
    stem = _OTHER_LETTERS.sub("_", path.stem).strip(".") or "heights"
    return stem[:60] + path.suffix.lower()


def with_ground(spec: RunSpec, ground: str) -> RunSpec:
    """Return `spec` with its heights at `ground`; without, its file is named only if it is a shipped ground in use."""
    shipped = spec.slope.grid_file if spec.slope.kind == "grid" else ""
    return dataclasses.replace(spec, slope=dataclasses.replace(spec.slope, grid_file=ground or shipped))
