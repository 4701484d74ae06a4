"""The task of baking a recording into a .blend file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from .. import results
from ..spec import RunSpec
from ..talk import Talk
from .keys import digest_file, spec_inputs, versions
from .task import Task

if TYPE_CHECKING:
    from ..simulation import Recording

LIBRARIES = ("numpy", "bpy")


@dataclass(frozen=True)
class Source:
    """What is baked: the run `spec` with its bake settings, and its recording, read or made when it is needed.

    `path` is the recording's file, if it has one.
    """

    spec: RunSpec
    recording: Callable[[], Recording]
    path: Path | None = None


def bake_into(source: Source, target: Path, talk: Talk, *, redo: bool = False) -> None:
    """Bake `source` into the file `target`, unless that is done; raises what baking does."""
    inputs = spec_inputs(source.spec)
    if source.path:
        inputs["recording"] = digest_file(source.path)
    task = Task("bake", target, inputs, versions(*LIBRARIES), seed=source.spec.simulation.seed)
    why = "asked for" if redo else task.unfinished((target.name,))
    if not why:
        task.say_up_to_date(talk)
        return
    task.say_why(talk, why)
    results.bake(source.recording(), source.spec, target)
    task.finish((target.name,), talk, spec_hash=source.spec.content_hash())
    talk.say(f"wrote {target}")
