"""`blender --command ski ...`: the command line inside Blender, with the same commands as `python -m ski_addon`."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from typing import Any

import bpy

from ..apart import ROOT

NAME = "ski"
OUTSIDE = ("crowd", "robustness", "sweep")
"""Commands that share their work out among processes: those cannot have Blender's own modules, and need none."""

_handle: Any = None


def run(words: Sequence[str]) -> int:
    """Run one command and return its exit code."""
    if words and words[0] in OUTSIDE:
        return _run_outside(words)
    from ..cli import main

    return main(words, prog=f"blender --command {NAME}")


def _run_outside(words: Sequence[str]) -> int:
    """Run a command by Blender's Python without Blender, which finds everything that can be imported here."""
    known = [entry for entry in sys.path if entry and os.path.isdir(entry)]
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(dict.fromkeys([str(ROOT), *known]))}
    with subprocess.Popen([sys.executable, "-m", "ski_addon", *words], env=environment) as process:
        while True:
            try:
                return process.wait()
            except KeyboardInterrupt:  # it was interrupted as well, and is about to end
                continue


def register() -> None:
    """Add the command to Blender."""
    global _handle
    _handle = bpy.utils.register_cli_command(NAME, run)


def unregister() -> None:
    """Take the command away."""
    global _handle
    if _handle is not None:
        bpy.utils.unregister_cli_command(_handle)
        _handle = None
