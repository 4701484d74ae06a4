"""The task of simulating a run into a folder, with a checkpoint on the way, and its report."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import results
from ..errors import Cancelled
from ..simulation.checkpoint import Checkpoints
from ..spec import RunSpec
from ..talk import Talk
from .keys import digest_file, spec_inputs, versions
from .task import Task

if TYPE_CHECKING:
    from ..simulation import Recording

LIBRARIES = ("numpy", "scipy", "osqp", "mujoco")
RECORDING, SUMMARY, DOCUMENT, REPORT = "recording.npz", "summary.json", "spec.toml", "report.png"
CHECKPOINT = "checkpoint.npz"


@dataclass(frozen=True)
class Simulated:
    """A simulated run: its `summary`, its `recording`, read when it is needed, and whether it was there already."""

    summary: dict[str, Any]
    recording: Callable[[], Recording]
    kept: bool

    def raise_unless_finished(self) -> None:
        """Raise what happened to the skier, if the run was not skied to its end."""
        if self.summary["status"] != "finished":
            results.raise_unless_finished(self.recording())


def simulation_task(spec: RunSpec, folder: Path) -> Task:
    """Return the task of simulating `spec` into `folder`; raises `MissingInputError` for a ground that is not there."""
    seed = spec.simulation.seed
    return Task("simulate", folder / RECORDING, spec_inputs(spec), versions(*LIBRARIES), seed=seed)


def simulate_into(
    spec: RunSpec,
    folder: Path,
    talk: Talk,
    *,
    report: bool,
    redo: bool = False,
    progress: results.Progress | None = None,
) -> Simulated:
    """Simulate `spec` into `folder`, or go on where a killed run was, unless it is done.

    Writes spec.toml, recording.npz, summary.json and, if asked, report.png. A fall is no error here. `progress` is
    called in the place of the talk's own; when it returns False the run is interrupted. Raises what planning does,
    `OutputError`, and `Cancelled`, with a checkpoint left.
    """
    task = simulation_task(spec, folder)
    why = "asked for" if redo else task.unfinished((RECORDING, SUMMARY, DOCUMENT))
    if why:
        task.say_why(talk, why)
        checkpoints = Checkpoints(folder / CHECKPOINT, tell=talk.tell)
        if redo:
            checkpoints.remove()
        recording, summary = _simulate(spec, talk, checkpoints, progress)
        files = results.write_run(folder, spec, recording, summary, report=report, talk=talk)
        task.finish(files, talk, status=recording.header["status"], spec_hash=spec.content_hash())
        checkpoints.remove()
        return Simulated(summary, lambda: recording, kept=False)
    task.say_up_to_date(talk)
    summary = json.loads((folder / SUMMARY).read_text(encoding="utf-8"))
    if report and task.unfinished((REPORT,)):
        report_of(task.output, folder / REPORT, talk)
    return Simulated(summary, lambda: results.load_recording(task.output), kept=True)


def report_of(recording_path: Path, target: Path, talk: Talk, *, redo: bool = False) -> None:
    """Draw the report of a recording into `target`, unless that is done or matplotlib is missing."""
    if not results.can_draw(talk):
        return
    recording = results.load_recording(recording_path)
    inputs = {"recording": digest_file(recording_path)}
    task = Task("report", target, inputs, versions("numpy", "matplotlib"))
    why = "asked for" if redo else task.unfinished((target.name,))
    if not why:
        task.say_up_to_date(talk)
        return
    task.say_why(talk, why)
    results.draw_report(recording, target)
    task.finish((target.name,), talk)
    talk.say(f"wrote {target}")


def _simulate(
    spec: RunSpec, talk: Talk, checkpoints: Checkpoints, progress: results.Progress | None
) -> tuple[Recording, dict[str, Any]]:
    if progress is None:
        with talk.progress() as display:
            recording, summary = results.simulate_run(spec, display, checkpoints)
    else:
        recording, summary = results.simulate_run(spec, progress, checkpoints)
    if recording.header["status"] == "cancelled":
        saved = "the same command goes on from there" if checkpoints.path.exists() else "nothing was kept"
        raise Cancelled(f"interrupted at {len(recording.time) * spec.simulation.time_step:.2f} s of skiing: {saved}")
    return recording, summary
