"""Environment variables that the command line reads."""

from __future__ import annotations

import os

OPENJD = "SKI_ADDON_OPENJD"
LOG = "SKI_ADDON_LOG"
CHECKPOINT_SECONDS = "SKI_ADDON_CHECKPOINT_SECONDS"
TRACEBACK = "SKI_ADDON_TRACEBACK"

VARIABLES = {
    OPENJD: "1: say progress and failures as --openjd does",
    LOG: "a file: add what --log adds to it, from every command",
    CHECKPOINT_SECONDS: "wall time between two checkpoints of a simulation (10)",
    TRACEBACK: "1: show the details of an unexpected failure",
}
"""What each variable does, in the order of the help."""


def is_on(variable: str) -> bool:
    """Return whether a switch is on: set to anything but nothing, 0, no, false or off."""
    return os.environ.get(variable, "").strip().lower() not in ("", "0", "no", "false", "off")
