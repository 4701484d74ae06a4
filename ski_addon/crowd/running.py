"""Running a crowd: plan everybody, find the starts, ski in processes, and say how it went, also when it is stopped."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from .. import atomic
from ..errors import Cancelled, SkiAddonError
from ..workers import run_all, worker_pool
from .crowd_spec import CrowdSpec
from .documents import write_crowd
from .planning import MemberPlan, load_plans, plan_member, save_plans
from .skiing import Outcome, clean_up, kept_outcome, ski_member
from .starts import NoRoom, Start, find_starts
from .summary import SUMMARY, summarise

Progress = Callable[[float, str], Any]
HERE = 0
"""Number of processes that means: in this one."""


@dataclass
class CrowdRun:
    """A crowd on its way: what is known so far of each member, by index.

    `planning_s` and `skiing_s` are waiting times [s]; `stopped` says that it was interrupted.
    """

    spec: CrowdSpec
    folder: Path
    jobs: int
    plans: dict[int, MemberPlan] = field(default_factory=dict)
    starts: dict[int, Start | NoRoom] = field(default_factory=dict)
    outcomes: dict[int, Outcome] = field(default_factory=dict)
    planning_s: float = 0.0
    skiing_s: float = 0.0
    stopped: bool = False


def run_crowd(spec: CrowdSpec, folder: Path, jobs: int, progress: Progress) -> dict[str, Any]:
    """Plan and ski the crowd `spec` in `jobs` processes (0: in this one); returns what is in crowd.json.

    Into `folder` go crowd.toml with its runs, each member's recording as soon as it is finished, and crowd.json.
    Members that were skied there before are kept. What is done when it is interrupted stays, crowd.json says what, and
    `Cancelled` is raised; the same call goes on from there.
    """
    run = CrowdRun(spec, folder, jobs)
    clean_up(folder)
    write_crowd(spec, folder)
    try:
        with _pool(jobs) as pool:
            _plan(run, pool, progress)
            run.starts = find_starts(spec, _ways(run.plans), frame_rate(spec))
            _ski(run, pool, progress)
            _settle(run)
    except (KeyboardInterrupt, Cancelled):
        run.stopped = True
        write_summary(run)
        raise Cancelled(_stopped_words(run)) from None
    return write_summary(run)


def frame_rate(spec: CrowdSpec) -> float:
    """Return the frame rate [1/s] that starts are whole frames of."""
    return spec.runs[0].spec.bake.fps


def write_summary(run: CrowdRun) -> dict[str, Any]:
    """Write crowd.json and return what is in it."""
    from ..talk import json_text

    summary = summarise(run)
    atomic.write_text(run.folder / SUMMARY, json_text(summary))
    return summary


def steps_here(spec: CrowdSpec, folder: Path) -> Iterator[tuple[float, str]]:
    """Run a crowd in this process a member at a time, as (fraction, text) to show; to stop, do not go on.

    For where no processes can be started; see `run_crowd`.
    """
    run = CrowdRun(spec, folder, HERE)
    clean_up(folder)
    write_crowd(spec, folder)
    run.plans = load_plans(folder, spec)
    for index in range(spec.crowd.count):
        yield 0.1 * index / spec.crowd.count, f"planning: {index} of {spec.crowd.count}"
        if index not in run.plans:
            run.plans[index] = plan_member(spec, index)
    save_plans(folder, spec, run.plans)
    run.starts = find_starts(spec, _ways(run.plans), frame_rate(spec))
    placed = _placed(run)
    for done, index in enumerate(placed):
        yield 0.1 + 0.9 * done / len(placed), f"skiing: {done} of {len(placed)}"
        run.outcomes[index] = ski_member(run.plans[index].member, folder)
        write_summary(run)
    _settle(run)
    write_summary(run)


def _plan(run: CrowdRun, pool: ProcessPoolExecutor | None, progress: Progress) -> None:
    begin = time.perf_counter()
    run.plans = load_plans(run.folder, run.spec)
    missing = [(run.spec, index) for index in range(run.spec.crowd.count) if index not in run.plans]

    def keep(plan: MemberPlan) -> None:
        run.plans[plan.member.index] = plan

    try:
        _each(pool, plan_member, missing, progress, "planning", keep)
    finally:
        run.plans = dict(sorted(run.plans.items()))
        run.planning_s = time.perf_counter() - begin
        if missing:
            save_plans(run.folder, run.spec, run.plans)


def _ski(run: CrowdRun, pool: ProcessPoolExecutor | None, progress: Progress) -> None:
    begin = time.perf_counter()
    for index in _placed(run):
        kept = kept_outcome(run.plans[index].member, run.folder)
        if kept is not None:
            run.outcomes[index] = kept
    tasks = [(run.plans[index].member, run.folder) for index in _placed(run) if index not in run.outcomes]

    def keep(outcome: Outcome) -> None:
        run.outcomes[outcome.index] = outcome

    try:
        _each(pool, ski_member, tasks, progress, "skiing", keep)
    finally:
        run.outcomes = dict(sorted(run.outcomes.items()))
        run.skiing_s = time.perf_counter() - begin


def _settle(run: CrowdRun) -> None:
    """Find the starts anew from the ways that were skied, which differ a little from the plans.

    Nothing has to be skied again for it: when somebody starts changes nothing in how he skis.
    """
    run.starts |= find_starts(run.spec, {i: outcome.way for i, outcome in run.outcomes.items()}, frame_rate(run.spec))


def _each(
    pool: ProcessPoolExecutor | None,
    work: Callable[..., Any],
    tasks: list[tuple[Any, ...]],
    progress: Progress,
    what: str,
    keep: Callable[[Any], None],
) -> None:
    """Do every task, in the pool or here, and keep each result as soon as it is there."""
    if pool is not None:
        if tasks:
            progress(0.0, f"{what}: 0 of {len(tasks)}")
            run_all(pool, work, tasks, progress, what, keep)
        return
    for done, task in enumerate(tasks):
        progress(done / len(tasks), f"{what}: {done} of {len(tasks)}")
        keep(work(*task))


@contextlib.contextmanager
def _pool(jobs: int) -> Iterator[ProcessPoolExecutor | None]:
    if jobs == HERE:
        yield None
        return
    with worker_pool(jobs) as pool:
        yield pool


def _ways(plans: dict[int, MemberPlan]) -> dict[int, Any]:
    return {index: plan.way for index, plan in plans.items() if plan.way is not None}


def _placed(run: CrowdRun) -> list[int]:
    return [index for index, start in run.starts.items() if isinstance(start, Start)]


def _stopped_words(run: CrowdRun) -> str:
    done, count = len(run.outcomes), run.spec.crowd.count
    return f"interrupted: {done} of {count} members are skied and kept; the same command goes on with the rest"


def raise_shortfall(summary: dict[str, Any]) -> None:
    """Raise `SkiAddonError` with the exit code of the first kind of shortfall: no plan or place 2, a fall 5."""
    for statuses, exit_code, words in (
        (("infeasible", "no room"), 2, "could not be placed"),
        (("fell", "diverged"), 5, "fell"),
    ):
        numbers = [entry["member"] for entry in summary["members"] if entry["status"] in statuses]
        if numbers:
            error = SkiAddonError(f"{len(numbers)} of {summary['count']} members {words}; the others are done")
            error.exit_code = exit_code
            raise error
