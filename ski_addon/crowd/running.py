"""Running a crowd: plan everybody, find the starts, ski in processes, and say how it went, also when it is stopped."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Callable, Generator, Iterator
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

SAVE_SECONDS, SAVE_SHARE = 20.0, 0.02
"""Least time between two writings of crowd.json on the way [s], and the largest share of the time that they take."""


@dataclass
class CrowdRun:
    """A crowd on its way: what is known so far of each member, by index.

    `planning_s` and `skiing_s` are waiting times [s]; `stopped` says that it is not at its end.
    """

    spec: CrowdSpec
    folder: Path
    jobs: int
    plans: dict[int, MemberPlan] = field(default_factory=dict)
    starts: dict[int, Start | NoRoom] = field(default_factory=dict)
    outcomes: dict[int, Outcome] = field(default_factory=dict)
    planning_s: float = 0.0
    skiing_s: float = 0.0
    stopped: bool = True


def run_crowd(spec: CrowdSpec, folder: Path, jobs: int, progress: Progress) -> dict[str, Any]:
    """Plan and ski the crowd `spec` in `jobs` processes (0: in this one); returns what is in crowd.json.

    Into `folder` go crowd.toml with its runs, each member's recording as soon as it is finished, and crowd.json.
    Members that were skied there before are kept. What is done when it is interrupted or fails stays, crowd.json says
    what, and `Cancelled` or the failure is raised; the same call goes on from there.
    """
    run = begin(spec, folder, jobs)
    try:
        with _pool(jobs) as pool:
            _plan(run, pool, progress)
            run.starts = find_starts(spec, _ways(run.plans), frame_rate(spec))
            _ski(run, pool, progress)
        _settle(run)
    except (KeyboardInterrupt, Cancelled):
        write_summary(run)
        raise Cancelled(_stopped_words(run)) from None
    except SkiAddonError:  # of a disk that is full, a process that was killed
        with contextlib.suppress(SkiAddonError):
            write_summary(run)
        raise
    return write_summary(run)


def begin(spec: CrowdSpec, folder: Path, jobs: int) -> CrowdRun:
    """Return the crowd `spec` before anything is known of its members, its documents written into `folder`.

    What an earlier crowd said of itself there goes: its starts would be wrong for other members.
    """
    clean_up(folder)
    write_crowd(spec, folder)
    (folder / SUMMARY).unlink(missing_ok=True)
    return CrowdRun(spec, folder, jobs)


def frame_rate(spec: CrowdSpec) -> float:
    """Return the frame rate [1/s] that starts are whole frames of."""
    return spec.runs[0].spec.bake.fps


def write_summary(run: CrowdRun) -> dict[str, Any]:
    """Write crowd.json and return what is in it."""
    from ..talk import json_text

    summary = summarise(run)
    atomic.write_text(run.folder / SUMMARY, json_text(summary))
    return summary


def steps_here(spec: CrowdSpec, folder: Path) -> Generator[tuple[float, str], None, None]:
    """Run a crowd in this process a member at a time, as (fraction, text) to show; to stop, do not go on.

    For where no processes can be started; see `run_crowd`.
    """
    run = begin(spec, folder, HERE)
    run.plans = load_plans(folder, spec)
    for index in range(spec.crowd.count):
        yield 0.1 * index / spec.crowd.count, f"planning: {index} of {spec.crowd.count}"
        if index not in run.plans:
            run.plans[index] = plan_member(spec, index)
    save_plans(folder, spec, run.plans)
    run.starts = find_starts(spec, _ways(run.plans), frame_rate(spec))
    placed = _placed(run)
    try:
        for done, index in enumerate(placed):
            yield 0.1 + 0.9 * done / len(placed), f"skiing: {done} of {len(placed)}"
            run.outcomes[index] = ski_member(run.plans[index].member, folder)
    except (GeneratorExit, SkiAddonError):
        with contextlib.suppress(SkiAddonError):
            write_summary(run)
        raise
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

    now_and_then = _Seldom(lambda: write_summary(run))

    def keep(outcome: Outcome) -> None:
        run.outcomes[outcome.index] = outcome
        now_and_then()

    try:
        _each(pool, ski_member, tasks, progress, "skiing", keep)
    finally:
        run.outcomes = dict(sorted(run.outcomes.items()))
        run.skiing_s = time.perf_counter() - begin


class _Seldom:
    """Does `work` when called, but neither at once nor so often that it takes more than a small share of the time.

    So that somebody who is killed leaves a crowd.json of nearly all that was done.
    """

    def __init__(self, work: Callable[[], Any]) -> None:
        self._work = work
        self._next = time.perf_counter() + SAVE_SECONDS

    def __call__(self) -> None:
        """Do it if it is time."""
        begin = time.perf_counter()
        if begin >= self._next:
            self._work()
            end = time.perf_counter()
            self._next = end + max(SAVE_SECONDS, (end - begin) / SAVE_SHARE)


def _settle(run: CrowdRun) -> None:
    """Find the starts anew from the ways that were skied, which differ a little from the plans.

    Nothing has to be skied again for it: when somebody starts changes nothing in how he skis.
    """
    run.stopped = False
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
