"""Planning members: drawn anew until a plan is found, and remembered in one file so that a crowd can go on later."""

from __future__ import annotations

import contextlib
import functools
import hashlib
import json
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .. import archive
from ..atomic import atomic_path
from ..errors import Cancelled, MissingInputError, SkiAddonError
from .crowd_spec import CrowdSpec
from .members import Member, draw_member
from .tracks import Way, way_of

PLANS = "plans.npz"
"""File of the planned ways, in the folder of a crowd."""


@dataclass(frozen=True)
class MemberPlan:
    """A member, and its planned `way`, or the `problem` that its last try had instead."""

    member: Member
    way: Way | None
    problem: str = ""


def plan_member(crowd: CrowdSpec, index: int, stop: Callable[[], bool] = lambda: False) -> MemberPlan:
    """Draw the member `index` until it can ski its course, at most `crowd.tries` times.

    Raises `Cancelled` when `stop` says so, and what is wrong with its run's files.
    """
    from ..pipeline import make_plan

    problem = ""
    for attempt in range(1, crowd.crowd.tries + 1):
        if stop():
            raise Cancelled
        member = draw_member(crowd, index, attempt)
        try:
            plan = make_plan(member.spec).plan
        except MissingInputError:
            raise
        except SkiAddonError as error:
            problem = str(error)
        else:
            return MemberPlan(member, way_of(plan.time, plan.com, plan.duration))
    return MemberPlan(member, None, problem)


def save_plans(folder: Path, crowd: CrowdSpec, plans: Mapping[int, MemberPlan]) -> None:
    """Remember the plans of a crowd in its folder, in one step."""
    keys = {index: member_key(crowd, index) for index in plans}
    head = {keys[index]: _said(plan) for index, plan in plans.items()}
    arrays = {keys[index]: plan.way.place for index, plan in plans.items() if plan.way}
    with atomic_path(folder / PLANS) as temporary, temporary.open("wb") as stream:
        np.savez(stream, head=np.frombuffer(json.dumps(head).encode(), dtype=np.uint8), **arrays)


def _said(plan: MemberPlan) -> dict[str, Any]:
    duration = plan.way.duration if plan.way else None
    return {"attempt": plan.member.attempt, "problem": plan.problem, "duration": duration}


def load_plans(folder: Path, crowd: CrowdSpec) -> dict[int, MemberPlan]:
    """Return the remembered plans that are still those of the crowd's members; a file that is damaged has none."""
    found: dict[int, MemberPlan] = {}
    problems = (*archive.DAMAGE, KeyError, TypeError, zipfile.BadZipFile)
    with contextlib.suppress(*problems), zipfile.ZipFile(folder / PLANS) as members:
        head = json.loads(archive.read_member(members, "head").tobytes())
        for index in range(crowd.crowd.count):
            key = member_key(crowd, index)
            if key in head:
                said = head[key]
                planned = said["duration"] is not None
                way = Way(archive.read_member(members, key), float(said["duration"])) if planned else None
                found[index] = MemberPlan(draw_member(crowd, index, int(said["attempt"])), way, said["problem"])
    return found


def member_key(crowd: CrowdSpec, index: int) -> str:
    """Return a hash of all that decides the plan of a member: its run, how it is drawn, and with what it is planned."""
    run = crowd.run_of(index)
    asked: list[Any] = [run.spec.content_hash(), crowd.section("spread"), crowd.crowd.seed, crowd.crowd.tries, index]
    written = json.dumps([asked, _versions()], sort_keys=True)
    return hashlib.sha256(written.encode()).hexdigest()


@functools.cache
def _versions() -> dict[str, str]:
    from ..simulation.versions import library_versions

    return library_versions()
