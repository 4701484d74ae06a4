"""Presets in Blender: the shipped ones and the user's own, TOML documents of whole runs or of parts of them."""

from __future__ import annotations

import functools
import re
from pathlib import Path

from ..atomic import write_text
from ..errors import MissingInputError, OutputError, SpecError
from ..spec import PRESET_KINDS, Preset, RunSpec, list_presets, row_kinds
from ..spec.document import parse_document, read_text, write_document
from .preferences import user_folder

OWN = "own/"
"""What the names of the user's own presets begin with, so that they never hide a shipped one."""
SECTIONS_OF = {
    "courses": ("course", "gate", "point", "rhythm", "obstacle"),
    "skiers": ("skier", "figure"),
    "snow": ("snow",),
    "styles": ("technique",),
}
"""Sections and rows of a run that the parts of a kind hold."""


def own_folder(kind: str) -> Path:
    """Return the folder of the user's own presets of a kind; it may not be there yet."""
    return user_folder("presets") / kind


def own_presets(kind: str) -> tuple[Preset, ...]:
    """Return the user's own presets of a kind; files that are none are left out."""
    found = []
    for path in sorted(own_folder(kind).glob("*.toml")):
        try:
            found.append(Preset(kind, OWN + path.stem, path, *_said(path, _age(path))))
        except SpecError:
            continue
    return tuple(found)


@functools.cache
def shipped_presets(kind: str) -> tuple[Preset, ...]:
    """Return the shipped presets of a kind; they are read once, for they are asked for at every redraw."""
    return list_presets(kind)


def all_presets(kind: str) -> tuple[Preset, ...]:
    """Return the shipped presets of a kind, then the user's own."""
    return (*shipped_presets(kind), *own_presets(kind))


def find_preset(kind: str, identifier: str) -> Preset:
    """Return a preset by its identifier; raises `MissingInputError`."""
    for preset in all_presets(kind):
        if preset.identifier == identifier:
            return preset
    raise MissingInputError(identifier, f"there is no such preset among the {kind}: choose one from the menu")


def laid_over(spec: RunSpec, kind: str, identifier: str) -> RunSpec:
    """Return the run of a preset, or `spec` with a part laid over it; raises `SkiAddonError`."""
    path = find_preset(kind, identifier).path
    return _run_of(path, _age(path)) if kind == "runs" else spec.with_part(path)


@functools.lru_cache(maxsize=64)
def _run_of(path: Path, _age: int) -> RunSpec:
    return RunSpec.from_toml(path)


def _age(path: Path) -> int:
    """Return when a file was changed last: what was read of it counts until then."""
    try:
        return path.stat().st_mtime_ns
    except OSError:
        return 0


def save_own(spec: RunSpec, kind: str, name: str) -> Preset:
    """Write the part of `spec` that presets of a `kind` hold as the user's own preset `name`.

    One of the same name is replaced. Raises `SpecError` for a name without letters and `OutputError` if it cannot be
    written.
    """
    stem = re.sub(r"[^\w-]+", "_", name.strip()).strip("_").lower()
    if kind not in PRESET_KINDS or not stem:
        raise SpecError(
            "name", name, "a name with letters or figures", "give the preset another name", problem="is not"
        )
    content = spec.to_dict()
    if kind != "runs":
        content = {key: content[key] for key in SECTIONS_OF[kind] if key in content}
    content = {**content, "name": name.strip(), "description": content.get("description", "")}
    rows = {key: content.pop(key) for key in row_kinds() if key in content}
    head = {key: content.pop(key) for key in ("name", "description")}
    target = own_folder(kind) / f"{stem}.toml"
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(target.parent, error.strerror or str(error)) from error
    write_text(target, write_document({**head, **content, **rows}))
    return Preset(kind, OWN + stem, target, name.strip(), "")


def remove_own(kind: str, identifier: str) -> None:
    """Delete one of the user's own presets; raises `SpecError` for a shipped one, `OutputError` if it stays."""
    if not identifier.startswith(OWN):
        raise SpecError("preset", identifier, hint="only your own presets can be removed", problem="is a shipped one")
    path = find_preset(kind, identifier).path
    try:
        path.unlink()
    except OSError as error:
        raise OutputError(path, error.strerror or str(error)) from error


@functools.lru_cache(maxsize=256)
def _said(path: Path, _age: int) -> tuple[str, str]:
    content = parse_document(read_text(path), str(path)).content
    return str(content.get("name", path.stem)), str(content.get("description", ""))
