"""Preparing a run to be pushed: a course that is long enough, its plan, and the moments at which pushes start."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np

from ..errors import SpecError
from ..pipeline import Planned, make_plan
from ..planning import MotionPlan
from ..spec import RunSpec
from .cases import TRANSITION, TURN

SETTLE = 2.0
"""Time [s] from the start of a run before which nobody is pushed."""
WATCH = 5.0
"""Time [s] from the end of a push in which the skier must be back on the plan."""
HOLD = 0.3
"""Time [s] for which the skier must then stay there."""
SPARE = 2.5
"""Time [s] of track kept beyond that: a skier pushed forward is faster than planned."""


@dataclass(frozen=True)
class Prepared:
    """A plan at one start speed, and the places in it (indices) at which a push of each moment starts."""

    planned: Planned
    places: dict[str, int]

    def start(self, moment: str) -> float:
        """Return the time [s] at which a push of that moment starts: a whole step of the simulation."""
        step = self.planned.spec.simulation.time_step
        return round(float(self.planned.plan.time[self.places[moment]]) / step) * step


def prepare(spec: RunSpec, speed: float, duration: float, moments: tuple[str, ...]) -> Prepared:
    """Plan `spec` from `speed` [m/s] with track enough for pushes of `duration` [s] at `moments`.

    A course of linked turns gets as many turns as that takes; another one that is too short raises `SpecError`.
    """
    course = dataclasses.replace(spec.course, start_speed=speed)
    if course.kind == "turns":
        cycle = course.turn_duration + course.transition_duration
        needed = SETTLE + 2 * cycle + duration + WATCH + HOLD + SPARE
        course = dataclasses.replace(course, turn_count=max(course.turn_count, math.ceil(needed / cycle) + 1))
    planned = make_plan(dataclasses.replace(spec, course=course, push=()))
    latest = planned.plan.duration - duration - WATCH - HOLD - SPARE
    return Prepared(planned, {moment: _place(planned.plan, moment, latest) for moment in moments})


def find_apexes(plan: MotionPlan) -> np.ndarray:
    """Return the indices of the apex of every turn: the middle of where it is tightest."""
    edges = np.flatnonzero(np.diff(plan.phase) != 0) + 1
    apexes = []
    for begin, end in zip((0, *edges), (*edges, len(plan.phase)), strict=True):
        if plan.phase[begin] == 0:
            continue
        bend = np.abs(plan.curvature[begin:end])
        tight = begin + np.flatnonzero(bend >= 0.999 * bend.max())
        apexes.append(tight[len(tight) // 2])
    return np.array(apexes, dtype=int)


def find_changes(plan: MotionPlan) -> np.ndarray:
    """Return the indices at which the track changes from one turn to the other: where the curvature changes sign."""
    side = np.sign(plan.curvature)
    turning = np.flatnonzero(side)  # a straight between two turns has no side
    after = np.flatnonzero(np.diff(side[turning]) != 0)
    return (turning[after] + turning[after + 1] + 1) // 2


def _place(plan: MotionPlan, moment: str, latest: float) -> int:
    found = {TURN: find_apexes, TRANSITION: find_changes}[moment](plan)
    times = plan.time[found]
    fitting = found[(times >= SETTLE) & (times <= latest)]
    if not len(fitting):
        problem = f"has no {moment} from {SETTLE:g} s after its start to {plan.duration - latest:.1f} s before its end"
        raise SpecError("course", problem=problem, hint="make the course longer, so that a skier can fall or recover")
    return int(fitting[0])
