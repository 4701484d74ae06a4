"""What became of a crowd: as plain data, and as lines for a screen."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..spec.estimate import show_bytes, show_duration
from .members import Member
from .skiing import Outcome, peak_memory, recording_name
from .starts import Nearest, NoRoom, Start, least, real_nearest

if TYPE_CHECKING:
    from .running import CrowdRun

SUMMARY = "crowd.json"
INFEASIBLE, NO_ROOM, WAITING = "infeasible", "no room", "waiting"
"""Status of a member without a plan, without a start, and of one that is not skied yet."""


def summarise(run: CrowdRun) -> dict[str, Any]:
    """Return what is in crowd.json."""
    starts = {index: start for index, start in run.starts.items() if isinstance(start, Start)}
    ways = {index: plan.way for index, plan in run.plans.items() if plan.way is not None and index in starts}
    linger = run.spec.crowd.linger
    planned = real_nearest(ways, starts, linger)
    skied_ways = {index: outcome.way for index, outcome in run.outcomes.items() if index in starts}
    real = real_nearest(skied_ways, starts, linger)
    members = [_member(run, index, planned.get(index), real.get(index)) for index in range(run.spec.crowd.count)]
    skied = [outcome for outcome in run.outcomes.values() if not outcome.kept]
    wall = run.skiing_s
    return {
        "name": run.spec.name,
        "count": run.spec.crowd.count,
        "finished": sum(member["status"] == "finished" for member in members),
        "stopped": run.stopped,
        "seed": run.spec.crowd.seed,
        "apart_m": run.spec.crowd.apart,
        "linger_s": linger,
        "least_distance_planned_m": _distance(least(list(planned.values()))),
        "least_distance_m": _distance(least(list(real.values()))),
        "duration_s": max((start.time + _end(run, index) for index, start in starts.items()), default=0.0),
        "simulated_s": sum(outcome.simulated_s for outcome in run.outcomes.values()),
        "kept": sum(outcome.kept for outcome in run.outcomes.values()),
        "jobs": run.jobs,
        "planning_s": run.planning_s,
        "skiing_s": wall,
        "throughput": sum(outcome.simulated_s for outcome in skied) / wall if skied and wall else None,
        "recordings_bytes": sum(outcome.recording_bytes for outcome in run.outcomes.values()),
        "worker_memory_bytes": _worker_memory(skied),
        "main_memory_bytes": peak_memory(),
        "members": members,
    }


def summary_lines(summary: Mapping[str, Any]) -> list[str]:
    """Return the summary for a screen: a table, a line for each member that has something to say, and the totals."""
    lines = [
        f"{'member':>6} {'start':>9} {'later':>7} {'beside':>8} {'height':>7} {'mass':>6} {'skied':>8} {'nearest':>17}"
    ]
    lines += [_row(member) for member in summary["members"]]
    for member in summary["members"]:
        if member["problem"]:
            lines.append(f"member {member['member']}: {member['problem']}")
    kept = f", {summary['kept']} of them kept from before" if summary["kept"] else ""
    lines.append(f"{summary['finished']} of {summary['count']} finished{kept}")
    if summary["least_distance_m"] is not None:
        planned, asked = summary["least_distance_planned_m"], summary["apart_m"]
        words = f"least distance {summary['least_distance_m']:.2f} m"
        lines.append(f"{words} (planned {planned:.2f} m, asked {asked:g} m)")
    if summary["throughput"]:
        rate = f"{summary['throughput']:.2f} s of skiing a second in {summary['jobs'] or 'this'} process"
        rate += "es" if summary["jobs"] > 1 else ""
        waited = f"{show_duration(summary['planning_s'])} of planning, {show_duration(summary['skiing_s'])} of skiing"
        lines.append(f"{waited}: {rate}")
    memory = summary["worker_memory_bytes"]
    if memory:
        most = show_bytes(max(memory.values()))
        size = show_bytes(summary["recordings_bytes"])
        lines.append(f"at most {most} of memory in a process; {size} of recordings")
    return lines


def _row(member: Mapping[str, Any]) -> str:
    started = member["start_s"] is not None
    start = f"{member['start_s']:.2f} s" if started else "-"
    later = f"{member['delay_s']:.1f} s" if started else "-"
    offset = f"{member['offset_m']:+.1f} m" if started else "-"
    skied = f"{member['simulated_s']:.1f} s" if member["simulated_s"] else member["status"]
    nearest = "-"
    if member["nearest_m"] is not None:
        nearest = f"{member['nearest_m']:.2f} m to {member['nearest_member']}"
    if member["status"] in ("fell", "diverged"):
        skied = member["status"]
    person = f"{member['height_m']:5.2f} m {member['mass_kg']:3.0f} kg"
    return f"{member['member']:>6} {start:>9} {later:>7} {offset:>8} {person} {skied:>8} {nearest:>17}"


def _member(run: CrowdRun, index: int, planned: Nearest | None, real: Nearest | None) -> dict[str, Any]:
    from .members import draw_member

    plan, start, outcome = run.plans.get(index), run.starts.get(index), run.outcomes.get(index)
    member = plan.member if plan else draw_member(run.spec, index)
    here = start if isinstance(start, Start) else None
    return {
        "member": member.number,
        "status": _status(run, index),
        "problem": _problem(run, index),
        "file": recording_name(index) if outcome else None,
        "spec_hash": member.spec.content_hash(),
        "attempt": member.attempt,
        "start_s": here.time if here else None,
        "delay_s": here.delay if here else None,
        "offset_m": here.offset if here else None,
        **_person(member),
        "planned_s": plan.way.duration if plan and plan.way else None,
        "nearest_planned_m": _distance(planned),
        "nearest_m": _distance(real),
        "nearest_member": real.index + 1 if real else None,
        "nearest_time_s": real.time if real else None,
        **_took(outcome),
    }


def _took(outcome: Outcome | None) -> dict[str, Any]:
    return {
        "simulated_s": outcome.simulated_s if outcome else None,
        "kept": bool(outcome and outcome.kept),
        "wall_s": outcome.wall_s if outcome else None,
        "recording_bytes": outcome.recording_bytes if outcome else None,
        "process": outcome.process if outcome and not outcome.kept else None,
        "memory_bytes": outcome.memory_bytes if outcome else None,
    }


def _person(member: Member) -> dict[str, Any]:
    spec = member.spec
    return {
        "run": spec.name.rpartition(", member ")[0],
        "height_m": spec.skier.height,
        "mass_kg": spec.skier.mass,
        "sex": spec.skier.sex,
        "start_speed": spec.course.start_speed,
    }


def _status(run: CrowdRun, index: int) -> str:
    if isinstance(run.starts.get(index), NoRoom):
        return NO_ROOM
    if index in run.outcomes:
        return run.outcomes[index].status
    plan = run.plans.get(index)
    return INFEASIBLE if plan is not None and plan.way is None else WAITING


def _problem(run: CrowdRun, index: int) -> str:
    status, crowd = _status(run, index), run.spec.crowd
    if status == INFEASIBLE:
        tried = "the only try" if crowd.tries == 1 else f"the last of {crowd.tries} tries"
        return f"cannot ski its course: {run.plans[index].problem} ({tried}; less spread or an easier run would work)"
    start = run.starts.get(index)
    if isinstance(start, NoRoom):
        near = start.nearest
        best = f"at best {near.distance:.1f} m from member {near.index + 1}"
        hint = "a longer start interval, more room beside, or less crowd.apart would work"
        return f"no start within {crowd.delay_max:g} s keeps it {crowd.apart:g} m apart ({best}): {hint}"
    return run.outcomes[index].detail if index in run.outcomes else ""


def _end(run: CrowdRun, index: int) -> float:
    way = run.outcomes[index].way if index in run.outcomes else run.plans[index].way
    return way.duration if way else 0.0


def _distance(nearest: Nearest | None) -> float | None:
    return None if nearest is None or not np.isfinite(nearest.distance) else nearest.distance


def _worker_memory(skied: list[Outcome]) -> dict[str, int]:
    """Return the most memory of each process [bytes]."""
    most: dict[str, int] = {}
    for outcome in skied:
        if outcome.memory_bytes is not None:
            key = str(outcome.process)
            most[key] = max(most.get(key, 0), outcome.memory_bytes)
    return most
