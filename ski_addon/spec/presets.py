"""Shipped presets: whole runs and parts (courses, skiers, snow, styles), TOML files beside the library."""

from __future__ import annotations

import os
from pathlib import Path

from ..errors import MissingInputError
from .document import parse_document, read_text
from .records import record

PART_KINDS = ("courses", "skiers", "snow", "styles")
"""Folders of parts, documents of some sections (and rows) to lay over a run with `RunSpec.with_part`."""
PRESET_KINDS = ("runs", *PART_KINDS)
"""Folders of presets: whole runs, and parts."""


@record(frozen=True)
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


def ground_beside(name: str, folder: Path) -> str:
    """Return a `slope.grid_file` that was written in `folder` so that it can be found from anywhere.

    The name of a shipped ground (without an ending) and whole paths stay as they are.
    """
    if not name or _is_shipped_ground(name) or os.path.isabs(name):
        return name
    return os.path.abspath(folder / name)


def find_ground(name: str) -> Path:
    """Return the path of a file of heights, or of a shipped ground by its name; raises `MissingInputError`."""
    if not _is_shipped_ground(name):
        return Path(name)
    known = {path.stem: path for path in sorted(preset_folder("terrain").glob("*.np[yz]"))}
    if name not in known:
        hint = f"there is no such ground (shipped are {', '.join(known)}), and files of heights have an ending"
        raise MissingInputError(name, hint)
    return known[name]


def _is_shipped_ground(name: str) -> bool:
    return not Path(name).suffix and Path(name).name == name


def find_document(name: str, kinds: tuple[str, ...] = ("runs",)) -> Path:
    """Return the path of a document given as a path, or as the name of a preset of one of `kinds`.

    A part whose name is in several folders is named with its folder ("snow/paper"). An unknown name raises
    `MissingInputError` with the nearest one.
    """
    path = Path(name)
    if path.suffix or os.path.isfile(path):  # which also knows names that are too long for a file
        return path  # reading it says what is wrong with it
    known = {preset.stem: preset for preset in _preset_paths(kinds)}
    known |= {f"{preset.parent.name}/{preset.stem}": preset for preset in _preset_paths(kinds)}
    clashes = [key for key, preset in known.items() if "/" in key and preset.stem == name]
    if name in known and len(clashes) == 1:
        return known[name]
    if "/" in name and name in known:
        return known[name]
    if clashes:
        raise MissingInputError(name, f"there are several presets of that name: say {' or '.join(clashes)}")
    if os.path.exists(path):
        return path
    import difflib

    near = difflib.get_close_matches(name[:100], known, n=1)
    hint = f"did you mean {near[0]}?" if near else f"presets are {', '.join(sorted(k for k in known if '/' not in k))}"
    raise MissingInputError(name, f"there is no such file or preset: {hint}")


def _preset_paths(kinds: tuple[str, ...]) -> list[Path]:
    return [path for kind in kinds for path in sorted(preset_folder(kind).glob("*.toml"))]


def _read_preset(kind: str, path: Path) -> Preset:
    content = parse_document(read_text(path), str(path)).content
    return Preset(kind, path.stem, path, str(content.get("name", path.stem)), str(content.get("description", "")))
