"""Writing a bundle: a folder that holds all a job needs, whole or not at all, and only within itself."""

from __future__ import annotations

import os
import shutil
import stat
import tempfile
from collections.abc import Mapping
from pathlib import Path

from .. import atomic
from ..errors import MissingInputError, OutputError

MARKS = ("template.json", "template.yaml", "job.json")
"""Files by which a folder is known to be a bundle."""


def write_bundle(folder: Path, texts: Mapping[str, str], copies: Mapping[str, Path], *, kept: str = "") -> bool:
    """Write `texts` and copies of the files `copies`, by their paths in the bundle, into `folder`.

    A folder that holds exactly this already is left alone (what tasks put into its folder `kept` does not count), and
    False is returned. Raises `OutputError` for one that holds anything else or lies within another bundle, and
    `MissingInputError` for a file that cannot be copied. Links are followed, so a bundle holds plain files only.
    """
    check_outside_bundles(folder)
    with atomic.output_folder(folder), tempfile.TemporaryDirectory(prefix=".ski_addon.", dir=folder) as temporary:
        stage = Path(temporary)
        for name, text in texts.items():
            _place(stage, name).write_text(text, encoding="utf-8", newline="\n")
        for name, source in copies.items():
            copy_plain(source, _place(stage, name))
        there = _entries(folder, {stage.name, kept})
        if not there:
            atomic.move_all(stage, folder)
            return True
        if not _equal(folder, stage, there):
            raise OutputError(folder, "it holds something else than this job: name an empty or a new folder")
    return False


def check_outside_bundles(folder: Path) -> None:
    """Raise `OutputError` if `folder` lies within a bundle, whose files the tasks of that job read."""
    for parent in folder.resolve().parents:
        if any((parent / mark).is_file() for mark in MARKS):
            raise OutputError(folder, f"it lies within the bundle {parent}: name a folder outside of it")


def check_plain(source: Path) -> None:
    """Raise `MissingInputError` unless `source` is a file, or a link to one (reading a pipe would never end)."""
    try:
        mode = os.stat(source).st_mode
    except FileNotFoundError:
        raise MissingInputError(source) from None
    except (OSError, ValueError) as error:
        raise MissingInputError(source, getattr(error, "strerror", None) or str(error)) from None
    if not stat.S_ISREG(mode):
        raise MissingInputError(source, "it is not a file")


def copy_plain(source: Path, target: Path) -> None:
    """Copy what is in a file; raises `MissingInputError` if it is none or cannot be read."""
    check_plain(source)
    try:
        stream = source.open("rb")
    except OSError as error:
        raise MissingInputError(source, error.strerror or str(error)) from None
    with stream, target.open("wb") as copy:
        shutil.copyfileobj(stream, copy)


def _place(stage: Path, name: str) -> Path:
    path = stage / name
    path.parent.mkdir(parents=True, exist_ok=True)
    return path


def _entries(folder: Path, without: set[str]) -> dict[str, Path]:
    """Return every file, link and empty folder below `folder` by its path in it, without some at the top."""
    found = {}
    for path in sorted(folder.rglob("*")):
        relative = path.relative_to(folder)
        if relative.parts[0] not in without and (path.is_symlink() or not path.is_dir() or not any(path.iterdir())):
            found[relative.as_posix()] = path
    return found


def _equal(folder: Path, stage: Path, there: Mapping[str, Path]) -> bool:
    wanted = _entries(stage, set())
    return there.keys() == wanted.keys() and all(_same(path, wanted[name]) for name, path in there.items())


def _same(path: Path, wanted: Path) -> bool:
    if path.is_symlink() or not path.is_file() or path.stat().st_size != wanted.stat().st_size:
        return False
    return path.read_bytes() == wanted.read_bytes()
