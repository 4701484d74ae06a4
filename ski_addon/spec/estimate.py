"""What a run would take: simulated time, steps, memory and waiting time, known before anything starts."""

from __future__ import annotations

import dataclasses
import itertools
import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from .gate_defaults import gate_defaults

if TYPE_CHECKING:
    from .run_spec import RunSpec
    from .sections import CourseSpec

BYTES_PER_STEP = 3100
"""Memory of one recorded step [bytes]: about 195 numbers of 8 bytes, twice while the recording is put together."""
SECONDS_PER_STEP = 0.8e-3
"""Waiting time of one step [s], measured on one slow core with checks and recording."""
SECONDS_TO_PLAN = 3.0
"""Waiting time of start, plan and writing [s]."""
SECONDS_TO_RUN_OUT = 4.5
"""What a stop takes before and after braking [s]: into the fall line, the skis across, and standing."""
PLAIN_LENGTH = 35.0
"""Usual length of a line over a slope that has no bumps [m]."""
MEMORY_MAX = 8 * 2**30
"""A run whose recording is larger than this [bytes] is not started without being told to."""
SIMULATED_MAX = 3600.0
"""A run of more skiing than this [s] is not started without being told to."""


@dataclass(frozen=True)
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
    """Return what simulating `spec` would take, from what its course asks for."""
    seconds = _turning_seconds(spec.course) if spec.course.kind == "turns" else _way(spec) / _usual_speed(spec)
    if spec.course.finish == "stop":
        seconds += SECONDS_TO_RUN_OUT + _usual_speed(spec) / spec.technique.stop_deceleration
    steps = round(seconds / spec.simulation.time_step)
    return Estimate(seconds, steps, steps * BYTES_PER_STEP, SECONDS_TO_PLAN + steps * SECONDS_PER_STEP)


def _turning_seconds(course: CourseSpec) -> float:
    turns = course.turn_count - (0.5 if course.half_first_turn else 0.0)
    transitions = course.turn_count - (0 if course.entry == "straight" else 1)  # two halves lead in and out
    return turns * course.turn_duration + transitions * course.transition_duration


def _usual_speed(spec: RunSpec) -> float:
    """Return about the mean speed [m/s]: the one to hold, or somewhat more than at the start."""
    asked = [speed for speed in (spec.course.target_speed, spec.technique.speed_limit) if not isinstance(speed, str)]
    if asked:
        return min(asked)
    return max(spec.course.start_speed * (1.0 if spec.course.kind == "bumps" else 1.4), 6.0)


def _way(spec: RunSpec) -> float:
    """Return about how long the track is [m]."""
    course = spec.course
    if course.kind == "bumps" and not isinstance(course.run_length, str):
        return course.run_length
    if course.kind == "bumps":
        moguls = spec.slope.mogul_count * spec.slope.mogul_spacing
        bumps = 2.0 * spec.slope.bump_count * spec.slope.bump_width
        length, wave = {
            "moguls": (moguls, spec.slope.mogul_spacing),
            "bumps": (bumps, 2.0 * spec.slope.bump_width),
        }.get(spec.slope.kind, (PLAIN_LENGTH, 0.0))
        return length + 2.0 * wave
    if course.kind == "gates" and course.gate_setting != "list":
        gate = gate_defaults(course)
        return (course.gate_count + 2) * math.hypot(gate.spacing, gate.offset)
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
