"""Writing files so that a reader never meets half of one: a temporary name beside the target, then a rename."""

from __future__ import annotations

import contextlib
import os
import platform
import re
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

from .errors import OutputError

STAGE = ".ski_addon."
"""How the names of folders begin in which files are collected until all of them are whole."""


@contextlib.contextmanager
def atomic_path(target: str | Path) -> Iterator[Path]:
    """Yield a temporary path beside `target` (same suffix) to write to; it replaces `target` when the block ends well.

    Whatever goes wrong, the temporary file is removed and `target` keeps what it held; what a killed process left of
    the same target is removed too. Raises `OutputError`.
    """
    target = Path(target)
    if os.path.isdir(target):  # False for names that are too long, which Path.is_dir raises
        raise OutputError(target, "it is a folder")
    # The start of the name is enough: the whole one and more would be too long where the name itself just fits.
    start, end = f".{target.stem[:40]}.", f".tmp{target.suffix}"
    remove_left(target.parent, start, end)
    temporary = target.with_name(f"{start}{_owner()}{end}")
    try:
        yield temporary
        os.replace(temporary, target)
    except OSError as error:
        raise OutputError(target, error.strerror or str(error)) from error
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)


@contextlib.contextmanager
def staging_folder(folder: Path) -> Iterator[Path]:
    """Yield a new folder within `folder` to collect files in, removed at the end.

    What a killed process left of its own is removed, too.
    """
    remove_left(folder, STAGE, "")
    with tempfile.TemporaryDirectory(prefix=f"{STAGE}{_owner()}.", dir=folder) as temporary:
        yield Path(temporary)


def remove_left(folder: Path, start: str, end: str) -> None:
    """Remove files and folders in `folder` that a process of this computer which is no more left half-written.

    Their names are `start`, computer, process, and `end`; Blender writes to that name with an @ first.
    """
    pattern = re.compile(rf"{re.escape(start + _computer())}\.(\d+)(\.\w+)?{re.escape(end)}@?")
    with contextlib.suppress(OSError):
        for name in os.listdir(folder):
            found = pattern.fullmatch(name)
            if found and not _runs(int(found[1])):
                _remove(Path(folder, name))


def remove_own(folder: Path, start: str) -> None:
    """Remove the half-written files of this process in `folder` whose names begin with `start`."""
    for path in folder.glob(f"{start}*.{_owner()}.tmp*"):
        _remove(path)


def _remove(path: Path) -> None:
    if path.is_dir() and not path.is_symlink():
        shutil.rmtree(path, ignore_errors=True)
    else:
        with contextlib.suppress(OSError):
            path.unlink(missing_ok=True)


def _owner() -> str:
    return f"{_computer()}.{os.getpid()}"


def _computer() -> str:
    return re.sub(r"[^A-Za-z0-9]", "", platform.node())[:20] or "computer"


def _runs(process: int) -> bool:
    """Return whether a process runs; where the system cannot be asked without harm, say it does."""
    if os.name != "posix":
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return True


def write_text(target: str | Path, text: str) -> None:
    """Write a UTF-8 text file in one step."""
    with atomic_path(target) as temporary:
        temporary.write_text(text, encoding="utf-8", newline="\n")


def check_writable_folder(folder: str | Path) -> None:
    """Raise `OutputError` unless files can be made in `folder` (made itself if it is missing)."""
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except FileExistsError:
        raise OutputError(folder, "it is a file, not a folder") from None
    except (OSError, ValueError) as error:
        raise OutputError(folder, getattr(error, "strerror", None) or str(error)) from None


def check_appendable(path: str | Path) -> None:
    """Raise `OutputError` unless lines can be added to the file `path`."""
    try:
        with open(path, "a", encoding="utf-8"):
            pass
    except (OSError, ValueError) as error:
        raise OutputError(path, getattr(error, "strerror", None) or str(error)) from None


@contextlib.contextmanager
def output_folder(folder: str | Path) -> Iterator[Path]:
    """Yield `folder`, checked to be writable; folders made for it are removed again if nothing was put in them."""
    folder = Path(folder)
    made = [parent for parent in (folder, *folder.parents) if not os.path.exists(parent)]
    try:
        check_writable_folder(folder)
        yield folder
    finally:
        for parent in made:  # innermost first; rmdir refuses a folder that holds anything
            with contextlib.suppress(OSError):
                parent.rmdir()


def move_all(stage: Path, folder: Path) -> None:
    """Move every file of `stage` (on the same disk) into `folder`, replacing files of the same names."""
    try:
        for path in sorted(stage.iterdir()):
            os.replace(path, folder / path.name)
    except OSError as error:
        raise OutputError(error.filename2 or folder, error.strerror or str(error)) from error
