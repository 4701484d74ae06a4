"""Courses by rhythm: what the rows of a run document ask of phase control, and what becomes of it on the slope.

The swings are made on the plane of the slope, with gravity across them; other ground is laid under their plan view.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..course.pace import speed_to_hold
from ..errors import PlanInfeasible, SkiAddonError, SpecError
from ..gravity import STANDARD_GRAVITY
from ..snow import Snow
from ..spec import RhythmSpec, RunSpec
from ..spec.rhythm_defaults import HEADING_DEG, PERIOD, SHARPNESS_DEG, rhythm_duration, rhythm_keys
from .body import TurningBody
from .limits import Verdict, first_trouble
from .pace import Pace
from .person import leg_length
from .steering import Start, Steered, Targets, steer

TIME_STEP = 0.01
"""Time between neighbouring moments [s]."""


@dataclass(frozen=True)
class RhythmRun:
    """One body on a course by rhythm: what it did, `run` of one body; with `body` and `pace`. If the rhythm asks for
    what cannot be, `problem` says so and `last` is the moment up to which it could.
    """

    run: Steered
    body: TurningBody
    pace: Pace
    last: int
    problem: SkiAddonError | None


def rhythm_targets(spec: RunSpec, step: float = TIME_STEP) -> Targets:
    """Return what the `[[rhythm]]` rows ask for over time: between rows evenly, before and after them as they have it.

    Raises `SpecError` for a document without rows and for rows that are not in the order of time.
    """
    _check_rows(spec.rhythm)
    time = step * np.arange(round(rhythm_duration(spec.course, spec.rhythm) / step) + 1)

    def over(name: str, usual: float) -> np.ndarray:
        return np.interp(time, *rhythm_keys(spec.rhythm, name, usual))[:, None]

    return Targets(
        step=step,
        frequency=2.0 * np.pi / over("period", PERIOD),
        sharpness=np.deg2rad(over("sharpness_deg", SHARPNESS_DEG)),
        heading=np.deg2rad(over("heading_deg", HEADING_DEG)),
    )


def _check_rows(rows: tuple[RhythmSpec, ...]) -> None:
    if not rows:
        hint = "add [[rhythm]] rows with time, and period, sharpness_deg or heading_deg"
        raise SpecError("rhythm", problem="has no rows", hint=hint)
    for number, (before, row) in enumerate(zip(rows, rows[1:], strict=False), start=2):
        if row.time <= before.time:
            problem = f"is not after that of the row before ({before.time:g} s)"
            raise SpecError(f"rhythm {number}: time", row.time, problem=problem, hint="put the rows in order of time")


def pace_of(spec: RunSpec, angle: float) -> Pace:
    """Return how fast a run on a plane of `angle` [rad] is: by its snow and target speed, or held."""
    snow = Snow.of(spec.snow, spec.skier, spec.technique.tuck)
    return Pace(
        gravity_normal=STANDARD_GRAVITY * math.cos(angle),
        gravity_down=STANDARD_GRAVITY * math.sin(angle),
        friction=snow.friction,
        friction_per_speed=snow.friction_per_speed,
        drag=snow.drag_factor,
        most=speed_to_hold(spec),
        skid=math.radians(spec.technique.skid_max_deg),
        held=spec.course.pace == "held",
    )


def run_rhythm(spec: RunSpec, angle: float) -> RhythmRun:
    """Return the swings of a run on a plane of `angle` [rad], as far as they can be made.

    Raises `SpecError` for rows that are none, for a start without speed, and where already the first swing cannot be.
    """
    course = spec.course
    targets, pace = rhythm_targets(spec), pace_of(spec, angle)
    if course.start_speed < 1.0:
        hint = "a body at rest cannot be steered: give at least 1 m/s"
        raise SpecError("course.start_speed", course.start_speed, problem="is too slow for a rhythm", hint=hint)
    body = TurningBody(
        leg_length=leg_length(spec),
        curvature_bound=1.0 / course.tightest_radius,
        curvature_rate_bound=course.steering_rate,
    )
    start = Start(course.start_speed, 1.0 if course.first_turn == "left" else -1.0, course.entry == "turn")
    run = steer(body, targets, start, pace)
    verdict = first_trouble(body, pace, run)
    if verdict is None:
        return RhythmRun(run, body, pace, len(run.time) - 1, None)
    return RhythmRun(run, body, pace, verdict.index, _problem(spec, run, verdict))


def _problem(spec: RunSpec, run: Steered, verdict: Verdict) -> PlanInfeasible:
    """Return the failure that names the row, the time and the way of what cannot be."""
    time = float(run.time[verdict.index])
    way = float(np.sum(np.hypot(np.diff(run.down[: verdict.index + 1, 0]), np.diff(run.left[: verdict.index + 1, 0]))))
    row = max(sum(row.time <= time for row in spec.rhythm), 1)
    return PlanInfeasible(f"rhythm {row} ({time:.1f} s, {way:.1f} m)", None, verdict.reason)
