"""Reading and writing crowd documents: TOML of [crowd], [spread], [[run]], and [all] that is laid over all runs."""

from __future__ import annotations

import contextlib
import difflib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from .. import atomic
from ..errors import SkiAddonError, SpecError
from ..spec import PART_KINDS, FieldInfo, RunSpec, find_document
from ..spec.document import SourceDocument, parse_document, read_text, write_document
from ..spec.row_values import check_rows, read_rows
from ..spec.values import check
from .crowd_spec import EVERYWHERE, ROWS, SECTIONS, CrowdSpec, MemberRun, find_field
from .sections import MemberRunSpec

CROWD_KIND = "crowds"
"""Folder of the shipped crowds in presets/."""
DOCUMENT = "crowd.toml"
"""Name of a crowd's document in the folder of its recordings."""
KEYS = ("name", "description", *SECTIONS, ROWS.key, EVERYWHERE)
TEXTS = {"name": 120, "description": 2000}


def find_crowd(name: str) -> Path:
    """Return the path of a crowd or run given as a path, or as the name of a preset in presets/crowds or runs."""
    return find_document(name, (CROWD_KIND, "runs"))


def read_crowd(path: str | Path, parts: Sequence[Path] = (), changes: Mapping[str, Any] | None = None) -> CrowdSpec:
    """Read a crowd document, or a run document as a crowd of that run with the usual spread.

    `parts` are laid over every run, then `changes` by dotted key: those of the crowd, others of every run.
    Raises `MissingInputError`, and `SpecError` naming file, line, field and what is allowed.
    """
    path = Path(path)
    source = parse_document(read_text(path), str(path))
    changes = changes or {}
    own = {key: value for key, value in changes.items() if key.partition(".")[0] in SECTIONS}
    runs = {key: value for key, value in changes.items() if key not in own}

    def finished(spec: RunSpec) -> RunSpec:
        for part in parts:
            spec = spec.with_part(part)
        return spec.with_overrides(runs)

    if not _is_crowd(source.content):
        spec = finished(RunSpec.from_toml(path))
        return CrowdSpec((MemberRun(spec),), spec.name, spec.description).with_values(own)
    with source.errors_named():
        made = _read(source, path.parent).validate()
    # what follows is not the document's fault
    skied = tuple(MemberRun(finished(run.spec), run.repeat, run.offset) for run in made.runs)
    return CrowdSpec(skied, made.name, made.description, made.crowd, made.spread).validate().with_values(own)


def write_crowd(crowd: CrowdSpec, folder: Path, name: str = DOCUMENT) -> Path:
    """Write `crowd` into `folder`, each run as a document of its own beside it; returns the crowd's path.

    A document there that asks for the very same crowd is left as it is, with its comments.
    """
    with contextlib.suppress(SkiAddonError):
        if read_crowd(folder / name) == crowd:
            return folder / name
    rows = []
    for number, run in enumerate(crowd.runs, start=1):
        document = f"run_{number}.toml"
        atomic.write_text(folder / document, run.spec.to_toml())
        rows.append({"spec": document, "repeat": run.repeat, "offset": float(run.offset)})
    content: dict[str, Any] = {"name": crowd.name, "description": crowd.description}
    content |= {section: crowd.section(section) for section in SECTIONS}
    atomic.write_text(folder / name, write_document({**content, ROWS.key: rows}))
    return folder / name


def _is_crowd(content: Mapping[str, Any]) -> bool:
    return any(key in content for key in (*SECTIONS, ROWS.key))


def _read(source: SourceDocument, folder: Path) -> CrowdSpec:
    content = source.content
    for key in content:
        if key not in KEYS:
            near = difflib.get_close_matches(key[:100], KEYS, n=1, cutoff=0.0)[0]
            raise SpecError(key, problem="is not a key of a crowd", hint=f"did you mean {near}?")
    values: dict[str, Any] = {}
    for section in SECTIONS:
        table = content.get(section, {})
        if not isinstance(table, Mapping):
            raise SpecError(section, table, problem="is not a table", hint=f"write its keys under [{section}]")
        values |= {f"{section}.{key}": value for key, value in table.items()}
    for key, value in values.items():  # words such as "keep" are read as they are
        check(find_field(key), value)
    rows = read_rows(ROWS, content.get(ROWS.key, []))
    check_rows(ROWS, rows, check)
    everywhere = content.get(EVERYWHERE, {})
    if not isinstance(everywhere, Mapping):
        hint = f"write [{EVERYWHERE}.simulation] and so on"
        raise SpecError(EVERYWHERE, everywhere, problem="is not a table", hint=hint)
    runs = tuple(_read_run(number, row, folder, everywhere) for number, row in enumerate(rows, start=1))
    name, description = (_text(key, content.get(key, "")) for key in TEXTS)
    return CrowdSpec(runs, name or CrowdSpec.name, description).with_values(values)


def _read_run(number: int, row: MemberRunSpec, folder: Path, everywhere: Mapping[str, Any]) -> MemberRun:
    if not row.spec:
        hint = "name a run document beside this one, or a preset in presets/runs"
        raise SpecError(f"run {number}: spec", problem="is missing", hint=hint)
    spec = RunSpec.from_toml(_beside(row.spec, folder, ("runs",)))
    for part in (row.skier, row.style):
        if part:
            spec = spec.with_part(_beside(part, folder, PART_KINDS))
    if everywhere:
        try:
            spec = spec.with_tables(everywhere)
        except SpecError as error:
            key = f"{EVERYWHERE}.{error.field}"
            raise SpecError(key, error.value, error.allowed, error.hint, problem=error.problem) from None
    return MemberRun(spec, row.repeat, float(row.offset))


def _beside(name: str, folder: Path, kinds: tuple[str, ...]) -> Path:
    return folder / name if Path(name).suffix else find_document(name, kinds)


def _text(key: str, value: object) -> str:
    check(FieldInfo(key, "text", "", "", high=TEXTS[key]), value)
    return str(value)
