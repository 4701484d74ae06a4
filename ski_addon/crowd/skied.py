"""A crowd's folder read again: who was skied, when each starts and on which line."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..errors import MissingInputError
from .summary import NO_ROOM, SUMMARY


@dataclass(frozen=True)
class SkiedMember:
    """A member with a recording: its `number` from 1, the file, its `start` [s] and `offset` to the left [m]."""

    number: int
    path: Path
    start: float
    offset: float


@dataclass(frozen=True)
class SkiedCrowd:
    """What a folder of a crowd holds; `linger` is how long those who have finished stay [s]."""

    name: str
    linger: float
    members: tuple[SkiedMember, ...]
    summary: dict[str, Any]


def is_crowd_folder(folder: Path) -> bool:
    """Return whether a crowd was simulated into `folder`."""
    return (folder / SUMMARY).is_file()


def read_skied(folder: Path) -> SkiedCrowd:
    """Return what the folder of a crowd holds; raises `MissingInputError` if there is nothing that could be shown."""
    path = folder / SUMMARY
    try:
        summary = json.loads(path.read_text(encoding="utf-8"))
        members = tuple(
            SkiedMember(int(entry["member"]), folder / entry["file"], float(entry["start_s"]), float(entry["offset_m"]))
            for entry in summary["members"]
            if entry["file"] and entry["start_s"] is not None and entry["status"] != NO_ROOM
        )
        found = SkiedCrowd(str(summary["name"]), float(summary["linger_s"]), members, summary)
    except FileNotFoundError:
        raise MissingInputError(path, "there is no crowd there: simulate it first") from None
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise MissingInputError(path, f"it is damaged ({error}): simulate the crowd again") from None
    if not members:
        raise MissingInputError(path, "nobody in it was skied: simulate the crowd again")
    return found
