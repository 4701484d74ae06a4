"""Where a recording lives between Simulate and Bake: beside the .blend, or in the user's cache until that is saved."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ..atomic import check_writable_folder
from ..errors import MissingInputError, OutputError
from .preferences import preferences, user_folder

if TYPE_CHECKING:
    from ..simulation.recording import Recording

FOLDER = "ski_cache"
_OWN = r"_[0-9a-f]{16}\.npz$"
KEPT = 10
"""Recordings of files that were never saved that are kept in the user's cache, newest first."""


def save_recording(recording: Recording, name: str) -> str:
    """Write `recording` of the skier `name` and return its path as Blender keeps it (relative to a saved .blend)."""
    if bpy.data.filepath:
        blend = Path(bpy.data.filepath)
        target = blend.parent / FOLDER / f"{_plain(blend.stem)}_{_plain(name)}.npz"
        try:
            target.parent.mkdir(exist_ok=True)
            recording.save(target)
        except (OSError, OutputError):
            pass  # the .blend lies where nothing may be written
        else:
            return f"//{FOLDER}/{target.name}"
    folder = user_cache()
    target = folder / f"{_plain(name)}_{recording.header['spec_hash'][:16]}.npz"
    recording.save(target)
    _forget_old(folder)
    return str(target)


def ground_path(name: str) -> Path:
    """Return where the heights of the skier `name`'s slope are kept; the folder is there and can be written to."""
    if bpy.data.filepath:
        folder = Path(bpy.data.filepath).parent / FOLDER
        try:
            check_writable_folder(folder)
        except OutputError:
            pass  # the .blend lies where nothing may be written
        else:
            return folder / f"{_plain(Path(bpy.data.filepath).stem)}_{_plain(name)}_slope.npz"
    return user_cache() / f"{_plain(name)}_slope.npz"


def load_recording(path: str) -> Recording:
    """Read the recording at `path` (as `save_recording` gave it); raises `MissingInputError` or `RecordingError`."""
    from ..simulation.recording import Recording

    if not path:
        raise MissingInputError("the recording", "there is none yet: press Simulate")
    whole = Path(bpy.path.abspath(path))
    if not whole.is_file():
        raise MissingInputError(whole, "the recording is not there any more: press Simulate again")
    return Recording.load(whole)


def user_cache() -> Path:
    """Return the user's folder for recordings of files that are not saved, made if it is missing."""
    known = preferences()
    if known is not None and known.cache_folder:
        folder = Path(bpy.path.abspath(known.cache_folder))
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OutputError(folder, f"{error.strerror}: choose another folder in the add-on's preferences") from error
        return folder
    folder = user_folder("cache")
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _forget_old(folder: Path) -> None:
    """Remove the oldest recordings; the folder may be one where the user keeps other files, and slopes lie there."""
    own = [path for path in folder.glob("*.npz") if re.search(_OWN, path.name)]
    recordings = sorted(own, key=lambda path: path.stat().st_mtime, reverse=True)
    for path in recordings[KEPT:]:
        path.unlink(missing_ok=True)


def _plain(name: str) -> str:
    return re.sub(r"[^\w.-]+", "_", name) or "skier"
