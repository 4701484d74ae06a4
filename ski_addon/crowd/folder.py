"""The folder that a crowd is simulated into: what may lie there already, and what must not be lost."""

from __future__ import annotations

import dataclasses
import shutil
from pathlib import Path
from typing import Any

from ..errors import MissingInputError, OutputError, SpecError
from ..spec.estimate import show_bytes
from .crowd_spec import CrowdSpec
from .documents import DOCUMENT, read_crowd
from .expected import disk_bytes
from .sections import StartSpec
from .skiing import recordings_in

SHARED = ("count", "start_interval", "start_variation", "apart", "delay_max", "linger")
"""Keys of [crowd] that change no member: another value keeps the recordings that are there."""


def check_folder(crowd: CrowdSpec, folder: Path, source: Path) -> None:
    """Raise `SpecError` if simulating `crowd`, read from `source`, into `folder` would replace what somebody needs.

    That is the document itself, or the recordings of another crowd.
    """
    there = _crowd_in(folder)
    if (folder / DOCUMENT).exists() and source.resolve() == (folder / DOCUMENT).resolve() and there != crowd:
        hint = "choose another folder, or write the changes into the document"
        raise SpecError("--output", str(folder), hint=hint, problem=f"holds {source.name}, which would be replaced")
    count = len(recordings_in(folder))
    if count and (there is None or _members(there) != _members(crowd)):
        problem = f"holds {count} recording{'s' if count > 1 else ''} of another crowd"
        raise SpecError("--output", str(folder), hint="choose another folder, or add --force", problem=problem)


def check_space(crowd: CrowdSpec, folder: Path) -> None:
    """Raise `OutputError` if the recordings of `crowd` would not fit on the disk of `folder`."""
    there = sum(path.stat().st_size for path in recordings_in(folder))  # kept, or replaced
    wanted, free = disk_bytes(crowd) - there, shutil.disk_usage(folder).free
    if wanted > free:
        hint = "ask for fewer skiers or a shorter run, or add --force"
        raise OutputError(folder, f"the crowd would take {show_bytes(wanted)} of {show_bytes(free)} there: {hint}")


def _crowd_in(folder: Path) -> CrowdSpec | None:
    """Return the crowd that the document in `folder` asks for, if there is one that can be read."""
    try:
        return read_crowd(folder / DOCUMENT)
    except (SpecError, MissingInputError):
        return None


def _members(crowd: CrowdSpec) -> CrowdSpec:
    """Return `crowd` without what changes no member."""
    usual: dict[str, Any] = {name: getattr(StartSpec, name) for name in SHARED}
    return dataclasses.replace(crowd, name="", description="", crowd=dataclasses.replace(crowd.crowd, **usual))
