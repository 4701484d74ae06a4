"""Shipped presets: whole runs and parts (skiers, snow, styles), TOML files beside the library."""

from __future__ import annotations

import difflib
from dataclasses import dataclass
from pathlib import Path

from ..errors import MissingInputError
from .document import read_document

PRESET_KINDS = ("runs", "skiers", "snow", "styles")
"""Folders of presets: whole runs, and parts to lay over a run with `RunSpec.with_part`."""


@dataclass(frozen=True)
class Preset:
    """One preset: its folder, the name of its file, its path, and the name and description in it."""

    kind: str
    identifier: str
    path: Path
    name: str
    description: str


def preset_folder(kind: str) -> Path:
    """Return the folder of the shipped presets of one kind."""
    return Path(__file__).resolve().parent.parent.parent / "presets" / kind


def list_presets(kind: str, folder: Path | None = None) -> tuple[Preset, ...]:
    """Return the presets of one kind, in order of their file names (shipped ones, or those of another folder)."""
    paths = sorted((folder or preset_folder(kind)).glob("*.toml"))
    return tuple(_read_preset(kind, path) for path in paths)


def find_preset(kind: str, identifier: str) -> Path:
    """Return the path of a shipped preset by the name of its file; an unknown one names the nearest."""
    path = preset_folder(kind) / f"{identifier}.toml"
    if path.is_file():
        return path
    known = sorted(entry.stem for entry in preset_folder(kind).glob("*.toml"))
    near = difflib.get_close_matches(identifier, known, n=1)
    hint = f"did you mean {near[0]}?" if near else f"presets are {', '.join(known)}"
    raise MissingInputError(identifier, f"there is no such file or preset: {hint}")


def _read_preset(kind: str, path: Path) -> Preset:
    content = read_document(path).content
    return Preset(kind, path.stem, path, str(content.get("name", path.stem)), str(content.get("description", "")))
