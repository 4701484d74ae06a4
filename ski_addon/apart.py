"""Keeping Blender's module apart: its talk off our streams, and long pictures in a process that can be stopped.

While Cycles renders, Python's signal handlers wait for it to end, so that Ctrl+C would be minutes late; and Blender
writes straight to the process's streams. Inside Blender itself nothing of this is done.
"""

from __future__ import annotations

import contextlib
import os
import subprocess
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

from .errors import SkiAddonError, one_line

ROOT = Path(__file__).resolve().parent.parent
"""Folder that the library is imported from."""
VARIABLE = "SKI_ADDON_APART"
"""Environment variable of a process that `run_apart` started."""


def inside_blender() -> bool:
    """Return whether this Python runs in Blender, rather than Blender's module in this Python."""
    application = getattr(sys.modules.get("bpy"), "app", None)
    return application is not None and not getattr(application, "module", False)


def is_apart() -> bool:
    """Return whether this process was started by `run_apart`."""
    return VARIABLE in os.environ


@contextlib.contextmanager
def silenced() -> Iterator[None]:
    """Send what Blender writes to the process's stdout and stderr nowhere while the block runs."""
    if inside_blender():
        yield
        return
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [(number, os.dup(number)) for number in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for number, _ in kept:
            os.dup2(nowhere, number)
        yield
    finally:
        for number, copy in kept:
            os.dup2(copy, number)
            os.close(copy)
        os.close(nowhere)


def run_apart(arguments: Sequence[str], command: Sequence[str] | None = None) -> None:
    """Run one of our commands in a process of its own, stopped at once when this one is interrupted.

    Its last line on stderr and its exit code become a `SkiAddonError`. `command` is what to start (this Python with
    this package, if not given).
    """
    start = list(command or (sys.executable, "-m", __package__ or "ski_addon"))
    environment = os.environ | {VARIABLE: "1", "PYTHONPATH": python_path()}
    with subprocess.Popen(
        [*start, *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        env=environment,
        start_new_session=True,  # a terminal's Ctrl+C reaches us alone, and we stop it
        text=True,
        errors="replace",
    ) as process:
        try:
            _, said = process.communicate()
        except BaseException:
            process.kill()
            raise
    if process.returncode:
        raise _failure(said, process.returncode)


def _failure(said: str, exit_code: int) -> SkiAddonError:
    lines = [line for line in said.splitlines() if line.strip()]
    if exit_code < 0:
        error = SkiAddonError(f"Blender ended unexpectedly (signal {-exit_code})")
        error.exit_code = 7
    else:
        error = SkiAddonError(
            one_line(lines[-1]).removeprefix("ski_addon: ") if lines else "Blender ended unexpectedly"
        )
        error.exit_code = exit_code
    return error


def python_path() -> str:
    """Return the PYTHONPATH with which another process of this Python finds this library, and what we find."""
    given = [entry for entry in os.environ.get("PYTHONPATH", "").split(os.pathsep) if entry]
    return os.pathsep.join([str(ROOT), *given])
