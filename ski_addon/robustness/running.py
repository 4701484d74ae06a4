"""Running pushed skiers: one, a row with growing force, or a whole table; each process plans once for each speed."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import Cancelled
from ..pipeline import start_simulation
from ..simulation import Recording
from ..spec import PushSpec, RunSpec
from ..workers import run_all, worker_pool
from .bound import push_bound
from .cases import Case, PushTable, Row
from .moments import HOLD, WATCH, Prepared, prepare
from .recovery import measure_deviation, recovery_time

RECOVERED, SURVIVED, FELL = "recovered", "survived", "fell"
"""What became of a run: back on the plan in time, still up but not back, or fallen."""
GROWTH = tuple(25.0 * i for i in range(1, 21))
"""Forces [N] that are tried, one after the other, to find the largest one survived."""
CHUNK = 100
"""Steps between two looks at whether to stop."""


@dataclass(frozen=True)
class RunResult:
    """One pushed run.

    `status` is "recovered", "survived" or "fell", `detail` why it fell; `start_s` of the push [s] and the planned
    `speed_at_push` [m/s]; `recovery_s` from the end of the push until back on the plan [s]; largest sideways distance
    of the skis from the track and of the centre of mass from the plan [m]; largest joint torque over its limit, least
    distance of a hinge from its range [deg], largest unbalanced force [N, N m]; and the row's capture bound [N].
    """

    case: Case
    status: str
    detail: str
    start_s: float
    speed_at_push: float
    recovery_s: float | None
    ski_offset_max_m: float
    com_offset_max_m: float
    torque_ratio_max: float
    joint_margin_min_deg: float
    root_residual_max: float
    bound_n: float | None


def run_case(spec: RunSpec, table: PushTable, case: Case, stop: Callable[[], bool] = lambda: False) -> RunResult:
    """Plan (if that is not done yet), push and simulate one case until the time to recover is over.

    Raises `SpecError` or `PlanInfeasible` for a run that cannot be planned, `Cancelled` when `stop` says so.
    """
    prepared = _prepared(spec, case.row.speed, table.duration, table.moments)
    start = prepared.start(case.row.moment)
    push = PushSpec(case.row.body, case.row.direction, case.force, start, table.duration)
    planned = prepared.planned
    simulation = start_simulation(dataclasses.replace(planned, spec=dataclasses.replace(planned.spec, push=(push,))))
    last = round((start + table.duration + WATCH + HOLD) / simulation.time_step)
    while simulation.step_done < last and simulation.advance(min(CHUNK, last - simulation.step_done)):
        if stop():
            raise Cancelled
    fall = simulation.fall
    detail = f"{fall.what} at {fall.time:.2f} s; {fall.why}" if fall else ""
    return _result(prepared, table, case, simulation.recording(), detail)


def run_table(
    spec: RunSpec, table: PushTable, jobs: int, progress: Callable[[float, str], Any], *, grow: bool = False
) -> list[RunResult]:
    """Run all cases of `table` in `jobs` processes; with `grow` also larger forces, row by row, until a fall.

    The results are in the order of the table whatever order they were found in. `progress(fraction, text)` is called
    after each. A failure or an interrupt stops the processes and is raised.
    """
    with worker_pool(jobs) as pool:
        results = run_all(pool, run_case, [(spec, table, case) for case in table.cases], progress, "pushing")
        if grow:
            known: dict[Row, dict[float, str]] = {row: {} for row in table.rows}
            for result in results:
                known[result.case.row][result.case.force] = result.status
            rows = [(spec, table, row, known[row]) for row in table.rows]
            found = run_all(pool, grow_row, rows, progress, "growing the force by rows")
            results += [result for row_results in found for result in row_results]
    order = {row: place for place, row in enumerate(table.rows)}
    return sorted(results, key=lambda result: (order[result.case.row], result.case.force))


def grow_row(
    spec: RunSpec, table: PushTable, row: Row, known: dict[float, str], stop: Callable[[], bool] = lambda: False
) -> list[RunResult]:
    """Try the forces of `GROWTH` between the largest one known to be survived and the least known fall, up to a fall.

    `known` is the status by force [N].
    """
    fallen = min((force for force, status in known.items() if status == FELL), default=np.inf)
    survived = max((force for force in known if force < fallen), default=0.0)
    results = []
    for force in GROWTH:
        if survived < force < fallen:
            results.append(run_case(spec, table, Case(row, force), stop))
            if results[-1].status == FELL:
                break
    return results


def _result(prepared: Prepared, table: PushTable, case: Case, recording: Recording, detail: str) -> RunResult:
    plan, model, row = prepared.planned.plan, prepared.planned.model, case.row
    start, place = prepared.start(row.moment), prepared.places[row.moment]
    first = min(round(start / prepared.planned.spec.simulation.time_step), len(recording.time) - 1)
    deviation = measure_deviation(recording, plan, model.skeleton, first)
    recovery = recovery_time(recording.time[first:], deviation.at_baseline, start + table.duration)
    status = FELL if detail else SURVIVED if recovery is None or recovery > WATCH else RECOVERED
    return RunResult(
        case=case,
        status=status,
        detail=detail,
        start_s=start,
        speed_at_push=float(plan.speed[place]),
        recovery_s=recovery if status == RECOVERED else None,
        ski_offset_max_m=float(np.abs(deviation.track_offset).max()),
        com_offset_max_m=float(np.abs(deviation.com_offset).max()),
        torque_ratio_max=float(recording.torque_ratio.max()),
        joint_margin_min_deg=float(np.rad2deg(recording.joint_margin.min())),
        root_residual_max=float(recording.root_residual.max()),
        bound_n=push_bound(plan, place, model.skeleton, row.body, row.direction, table.duration),
    )


@functools.lru_cache(maxsize=2)  # cases of one speed come after each other
def _prepared(spec: RunSpec, speed: float, duration: float, moments: tuple[str, ...]) -> Prepared:
    return prepare(spec, speed, duration, moments)
