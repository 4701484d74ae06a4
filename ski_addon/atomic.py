"""Writing files so that a reader never meets half of one: a temporary name beside the target, then a rename."""

from __future__ import annotations

import contextlib
import os
import tempfile
from collections.abc import Iterator
from pathlib import Path

from .errors import OutputError


@contextlib.contextmanager
def atomic_path(target: str | Path) -> Iterator[Path]:
    """Yield a temporary path beside `target` (same suffix) to write to; it replaces `target` when the block ends well.

    Whatever goes wrong, the temporary file is removed and `target` keeps what it held. Raises `OutputError`.
    """
    target = Path(target)
    if os.path.isdir(target):  # False for names that are too long, which Path.is_dir raises
        raise OutputError(target, "it is a folder")
    # The start of the name is enough: the whole one and more would be too long where the name itself just fits.
    temporary = target.with_name(f".{target.stem[:40]}.{os.getpid()}.tmp{target.suffix}")
    try:
        yield temporary
        os.replace(temporary, target)
    except OSError as error:
        raise OutputError(target, error.strerror or str(error)) from error
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink(missing_ok=True)


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
