"""Where recordings and the heights of slopes live: beside the .blend, or in the user's cache until that is saved.

Where neither can be written, a recording is held in memory: nobody shall lose a simulation to a full disk.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import bpy

from ..atomic import check_writable_folder
from ..errors import MissingInputError, OutputError, SkiAddonError
from .preferences import preferences, user_folder

if TYPE_CHECKING:
    from ..simulation.recording import Recording

FOLDER = "ski_cache"
_OWN = r"_[0-9a-f]{16}\.npz$"
KEPT = 10
"""Recordings of files that were never saved that are kept in the user's cache, newest first."""
HELD = "memory:"
"""What the path of a recording begins with that is held in memory."""
_held: dict[str, Recording] = {}


class Kept(NamedTuple):
    """Where something was kept, `path`, as Blender keeps paths (relative to a saved .blend), and a `note` for the user
    if that is not where it belongs.
    """

    path: str
    note: str = ""


def save_recording(recording: Recording, name: str) -> Kept:
    """Keep `recording` of the skier `name`; in memory, until Blender is closed, if no folder takes it."""
    alone = f"{_plain(name)}_{recording.header['spec_hash'][:16]}.npz"
    try:
        kept = _keep(f"{_plain(name)}.npz", alone, recording.save)
    except OutputError as error:
        advice = "bake it now, or make room and simulate again"
        return Kept(_hold(recording, alone), f"{error}; the recording is held until Blender is closed: {advice}")
    if not kept.path.startswith("//"):
        _forget_old(Path(kept.path).parent)
    return kept


def save_ground(name: str, write: Callable[[Path], Any]) -> Kept:
    """Keep the heights of the skier `name`'s slope by `write`; raises `OutputError` if no folder takes them."""
    own = f"{_plain(name)}_slope.npz"
    return _keep(own, own, write)


def load_recording(path: str) -> Recording:
    """Read the recording at `path` (as `save_recording` gave it); raises `MissingInputError` or `RecordingError`."""
    from ..simulation.recording import Recording

    if not path:
        raise MissingInputError("the recording", "there is none yet: press Simulate")
    if path in _held:
        return _held[path]
    if path.startswith(HELD):
        raise MissingInputError("the recording", "it was held in memory and is gone: press Simulate again")
    whole = Path(bpy.path.abspath(path))
    if not whole.is_file():
        raise MissingInputError(whole, "the recording is not there any more: press Simulate again")
    return Recording.load(whole)


def user_cache() -> Path:
    """Return the user's first folder for what belongs to files that are not saved; it may not be there yet."""
    return next(_user_folders())


def _user_folders() -> Iterator[Path]:
    """Yield the folder chosen in the preferences, if any, and the add-on's own."""
    known = preferences()
    if known is not None and known.cache_folder:
        yield Path(bpy.path.abspath(known.cache_folder))
    yield user_folder("cache")


def _keep(beside: str, alone: str, write: Callable[[Path], Any]) -> Kept:
    """Write a file, named `beside` (after the name of the .blend) or `alone`, into the first folder that takes it.

    Raises `OutputError`, the first one, if none does.
    """
    targets = [(folder / alone, "") for folder in _user_folders()]
    if bpy.data.filepath:
        blend = Path(bpy.data.filepath)
        target = blend.parent / FOLDER / f"{_plain(blend.stem)}_{beside}"
        targets.insert(0, (target, f"//{FOLDER}/{target.name}"))
    refused: list[SkiAddonError] = []
    for target, relative in targets:
        try:
            check_writable_folder(target.parent)
            write(target)
        except OutputError as error:
            refused.append(error)
        else:
            note = f"{refused[0]}; kept in {target.parent} instead" if refused else ""
            return Kept(relative or str(target), note)
    raise refused[0]


def _hold(recording: Recording, name: str) -> str:
    """Hold `recording` in memory in place of an earlier one of the same name."""
    _held[HELD + name] = recording
    return HELD + name


def _forget_old(folder: Path) -> None:
    """Remove the oldest recordings; the folder may be one where the user keeps other files, and slopes lie there."""
    own = [path for path in folder.glob("*.npz") if re.search(_OWN, path.name)]
    recordings = sorted(own, key=lambda path: path.stat().st_mtime, reverse=True)
    for path in recordings[KEPT:]:
        path.unlink(missing_ok=True)


def _plain(name: str) -> str:
    return re.sub(r"[^\w.-]+", "_", name) or "skier"
