"""Running a sweep: every combination is a task of its own, in a folder of its own, in parallel processes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import atomic
from ..errors import PlanInfeasible, SpecError, TerrainError
from ..spec import RunSpec
from ..talk import Talk
from ..workers import run_all, worker_pool
from .combinations import Combination
from .summary import sweep_summary, write_summary

IMPOSSIBLE = (PlanInfeasible, SpecError, TerrainError)
"""What a combination may be without ending the sweep: that it cannot be skied is an answer, too."""


@dataclass(frozen=True)
class Outcome:
    """What became of a run: its `summary`, or the `error` for which it cannot be skied; `kept` if it was there."""

    summary: dict[str, Any] | None
    error: str
    kept: bool


def run_sweep(
    combinations: Sequence[Combination], folder: Path, jobs: int, talk: Talk, *, report: bool, redo: bool
) -> dict[str, Any]:
    """Simulate all `combinations` into folders within `folder`, `jobs` at a time; return the summary of all.

    Those that are finished are kept, killed ones go on where they were. Writes sweep.json and sweep.csv, too. A run
    that falls or cannot be skied is a row like any other; any other failure, and an interrupt, is raised.
    """
    tasks = [(each.spec, folder / each.name, report, redo) for each in combinations]
    with talk.progress() as progress:
        if jobs == 1:
            outcomes = _one_by_one(tasks, progress)
        else:
            with worker_pool(jobs) as pool:
                outcomes = run_all(pool, ski, tasks, progress, "simulating")
    summary = sweep_summary(combinations, outcomes)
    write_summary(folder, summary)
    return summary


def ski(spec: RunSpec, folder: Path, report: bool, redo: bool, stop: Callable[[], bool] = lambda: False) -> Outcome:
    """Simulate one run into its folder. Raises `Cancelled`, with a checkpoint left, when `stop` says so."""
    from ..tasks.simulating import simulate_into

    try:
        with atomic.output_folder(folder):
            simulated = simulate_into(
                spec, folder, Talk(quiet=True), report=report, redo=redo, progress=lambda *_: not stop()
            )
    except IMPOSSIBLE as error:
        return Outcome(None, str(error), kept=False)
    return Outcome(simulated.summary, "", simulated.kept)


def _one_by_one(tasks: Sequence[tuple[Any, ...]], progress: Callable[[float, str], Any]) -> list[Outcome]:
    """Run all tasks in this process: where it is one, and inside Blender."""
    outcomes = []
    for done, task in enumerate(tasks, start=1):
        outcomes.append(ski(*task))
        progress(done / len(tasks), f"simulating: {done} of {len(tasks)}")
    return outcomes
