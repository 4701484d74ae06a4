"""What a run would take: simulated time, steps, memory and waiting time, known before anything starts."""

from __future__ import annotations

import dataclasses
import itertools
import math
from typing import TYPE_CHECKING

from .bump_defaults import PAST_LAST, bump_crests
from .gate_defaults import MARGIN, gate_defaults, usual_run_in
from .records import record
from .rhythm_defaults import rhythm_duration

if TYPE_CHECKING:
    from .run_spec import RunSpec
    from .sections import CourseSpec

BYTES_PER_STEP = 3800
"""Memory of one recorded step [bytes]: about 240 numbers of 8 bytes, twice while the recording is put together."""
SECONDS_PER_STEP = 0.8e-3
"""Waiting time of one step [s], measured on one slow core with checks and recording."""
USUAL_FRICTION, USUAL_DRAG = 0.08, 0.003
"""Friction of ski on snow at a usual speed, and drag [1/m], whoever skis on whatever snow."""
SCHUSS_SPEED, LONGEST_SCHUSS = 4.0, 12.0
"""Speed [m/s] that linked turns from rest begin with, and the longest time [s] it may take."""
STOP_TURN = 4.4
"""Sideways acceleration [m/s^2] of the turn into the fall line before a stop."""
STAND_STILL = 3.0
"""Time [s] of a stop without its braking: the skis are turned across, the last of the speed goes, the skier stands."""
SECONDS_TO_PLAN = 3.0
"""Waiting time of start, plan and writing [s]."""
MEMORY_MAX = 8 * 2**30
"""A run whose recording is larger than this [bytes] is not started without being told to."""
SIMULATED_MAX = 3600.0
"""A run of more skiing than this [s] is not started without being told to."""


@record(frozen=True)
class Estimate:
    """Simulated time [s], physics steps, memory of the recording [bytes] and waiting time [s] of a run."""

    simulated_seconds: float
    steps: int
    memory_bytes: int
    wall_seconds: float

    @property
    def too_large(self) -> bool:
        """True if the run should not be started without asking again."""
        return self.memory_bytes > MEMORY_MAX or self.simulated_seconds > SIMULATED_MAX

    @property
    def described(self) -> str:
        """One clause for a message: "13.5 s of skiing, 13500 steps, 24 MB, about 23 s to wait"."""
        return (
            f"{show_duration(self.simulated_seconds)} of skiing, {self.steps} steps, "
            f"{show_bytes(self.memory_bytes)} of memory, about {show_duration(self.wall_seconds)} to wait"
        )


def estimate(spec: RunSpec) -> Estimate:
    """Return about what simulating `spec` would take, from what its course and slope ask for."""
    if spec.course.kind == "turns":
        seconds = _schuss_seconds(spec) + _turning_seconds(spec.course)
    elif spec.course.kind == "rhythm":
        seconds = rhythm_duration(spec.course, spec.rhythm)
    else:
        seconds = _way(spec) / _mean_speed(spec, _way(spec))
    if spec.course.finish == "stop":
        seconds += _stop_seconds(spec)
    steps = round(seconds / spec.simulation.time_step)
    return Estimate(seconds, steps, steps * BYTES_PER_STEP, SECONDS_TO_PLAN + steps * SECONDS_PER_STEP)


def _turning_seconds(course: CourseSpec) -> float:
    turns = course.turn_count - (0.5 if course.half_first_turn else 0.0)
    transitions = course.turn_count - (0 if course.entry == "straight" else 1)  # two halves lead in and out
    return turns * course.turn_duration + transitions * course.transition_duration


def _schuss_seconds(spec: RunSpec) -> float:
    """Return about how long a skier who starts from rest runs straight before the first turn [s]."""
    gain = _gain(spec)
    if spec.course.start_speed > 0.0 or spec.course.entry != "straight" or gain <= 0.0:
        return 0.0
    return min(SCHUSS_SPEED / gain, LONGEST_SCHUSS)


def _stop_seconds(spec: RunSpec) -> float:
    """Return about how long a stop takes [s], with the turn into the fall line that leads to it."""
    course = spec.course
    speed = _mean_speed(spec, 50.0)
    turn = 0.0
    if course.kind == "turns":  # other lines end down the fall line
        heading = 0.5 * speed * (course.turn_duration + course.transition_duration) / course.turn_radius
        turn = 2.0 * min(heading, 1.2) * speed / STOP_TURN
    return turn + speed / spec.technique.stop_deceleration + STAND_STILL


def _gain(spec: RunSpec) -> float:
    """Return about how quickly the slope speeds up a slow skier [m/s^2]."""
    angle = math.radians(spec.slope.angle_deg)
    return 9.81 * (math.sin(angle) - USUAL_FRICTION * math.cos(angle))


def _mean_speed(spec: RunSpec, way: float) -> float:
    """Return about the mean speed [m/s] over `way` [m]: of gliding, or the one to hold if that is less."""
    asked = [speed for speed in (spec.course.target_speed, spec.technique.speed_limit) if not isinstance(speed, str)]
    terminal = _gain(spec) / USUAL_DRAG
    end = terminal + (spec.course.start_speed**2 - terminal) * math.exp(-2.0 * USUAL_DRAG * way)
    return min((0.5 * (spec.course.start_speed + math.sqrt(max(end, 1.0))), *asked))


def _way(spec: RunSpec) -> float:
    """Return about how long the track is [m]."""
    course = spec.course
    if course.kind == "bumps" and not isinstance(course.run_length, str):
        return course.run_length
    if course.kind == "bumps":
        spacing, count = bump_crests(spec.slope, course)
        usual = usual_run_in(spec.slope.bump_start + spacing, spacing)
        run_in = usual if isinstance(course.run_in, str) else course.run_in
        return run_in + (count - 1 + MARGIN) * spacing + PAST_LAST
    if course.kind == "gates" and course.gate_setting != "list":
        gate = gate_defaults(course)
        return (course.gate_count - 1 + 2.0 * MARGIN) * math.hypot(gate.spacing, gate.offset)
    corners = [(row.x, row.y) for row in (spec.gate if course.kind == "gates" else spec.point)]
    return sum(math.dist(a, b) for a, b in itertools.pairwise(corners))


def estimate_turns(spec: RunSpec, turn_count: int) -> Estimate:
    """Return what `spec` would take with another number of turns."""
    return estimate(dataclasses.replace(spec, course=dataclasses.replace(spec.course, turn_count=turn_count)))


def show_duration(seconds: float) -> str:
    """Return a duration as a person says it: "13.5 s", "12 min", "3.2 h", "5.1 days"."""
    for limit, divisor, unit in ((120, 1, "s"), (7200, 60, "min"), (172800, 3600, "h")):
        if seconds < limit:
            return f"{seconds / divisor:.3g} {unit}"
    return f"{seconds / 86400:.3g} days"


def show_bytes(count: float) -> str:
    """Return a size as a person says it: "24 MB", "3.1 GB"."""
    for unit in ("kB", "MB", "GB"):
        count /= 1000
        if count < 1000:
            return f"{count:.3g} {unit}"
    return f"{count / 1000:.3g} TB"
