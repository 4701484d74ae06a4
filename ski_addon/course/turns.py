"""Linked turns given by durations and a radius [SG19 sec. 4.2, Algorithm 1 with its signs mended].

Algorithm 1 accelerates away from the turn as printed; here the curvature itself is prescribed over time, positive to
the left, and speed, heading and position follow by integration with friction and drag.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ..errors import PlanInfeasible
from ..frames import normalized
from ..gravity import STANDARD_GRAVITY
from ..snow import Snow
from ..spec import CourseSpec, RunSpec
from ..terrain import PlaneTerrain, Terrain
from .pace import speed_to_hold
from .surface import track_on_surface
from .track import LEFT, RIGHT, TRANSITION, Track

SAMPLE_TIME = 0.005
"""Planned time between neighbouring places of a track [s]."""
SLOWEST = 0.15
"""A skier slower than this [m/s] has stopped."""
BRAKING_TIME = 0.7
"""Time [s] in which a skier brings down a speed above the one to hold."""
SLOW_START, SPEED_TO_TURN, LONGEST_SCHUSS = 0.3, 4.0, 12.0
"""A start slower than the first [m/s] is followed by a straight run up to the second, of the third [s] at most."""


@dataclass(frozen=True)
class TurnSchedule:
    """Curvature over time: knots at `time` (k,) [s] with the `curvature` (k,) [1/m] held or eased to between them.

    Knots come in pairs: hold, ease, hold, ease. `phase` and `turn` (k - 1,) label the intervals.
    """

    time: np.ndarray
    curvature: np.ndarray
    phase: np.ndarray
    turn: np.ndarray

    def curvature_at(self, time: np.ndarray) -> np.ndarray:
        """Return the curvature [1/m] at `time` (any shape) [s], eased by half a cosine between knots [SG19 Eq. 8]."""
        index = self._interval(time)
        begin, end = self.time[index], self.time[index + 1]
        x = np.clip((time - begin) / (end - begin), 0.0, 1.0)
        ease = 0.5 - 0.5 * np.cos(np.pi * x)
        return self.curvature[index] + (self.curvature[index + 1] - self.curvature[index]) * ease

    def labels_at(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the phase label and the turn's number at `time`."""
        index = self._interval(time)
        return self.phase[index], self.turn[index]

    def _interval(self, time: np.ndarray) -> np.ndarray:
        return np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(self.time) - 2)


def turn_schedule(course: CourseSpec, schuss: float = 0.0) -> TurnSchedule:
    """Return the curvature schedule of `course`, after a straight run of `schuss` [s] if it starts straight."""
    side = LEFT if course.first_turn == "left" else RIGHT
    durations: list[float] = []
    curvature = [0.0] if course.entry == "straight" else [side / course.turn_radius]
    phase: list[int] = []
    turn: list[int] = []

    def add(duration: float, ends_at: float, label: int, number: int) -> None:
        durations.append(duration)
        curvature.append(ends_at)
        phase.append(label)
        turn.append(number)

    if course.entry == "straight":
        if schuss:
            add(schuss, 0.0, TRANSITION, 1)
        add(0.5 * course.transition_duration, side / course.turn_radius, TRANSITION, 1)
    for number in range(1, course.turn_count + 1):
        bend = side / course.turn_radius
        first_half = number == 1 and course.half_first_turn
        add(course.turn_duration * (0.5 if first_half else 1.0), bend, side, number)
        if number < course.turn_count:
            add(course.transition_duration, -bend, TRANSITION, number)
        elif course.entry == "straight":
            add(0.5 * course.transition_duration, 0.0, TRANSITION, number)
            add(0.5 * course.transition_duration, 0.0, TRANSITION, number)
        side = -side
    time = np.concatenate(([0.0], np.cumsum(durations)))
    return TurnSchedule(time, np.array(curvature), np.array(phase, dtype=np.int8), np.array(turn))


def build_turn_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return the track of linked turns: exact on a plane slope, laid over any other ground from its mean plane.

    Unless the first turn is a half one, the run starts turned away from the fall line so that the middle of the first
    turn heads down it; otherwise the whole track would drift to one side.
    Raises `PlanInfeasible` when friction stops the skier.
    """
    steepness, normal = float(np.sin(terrain.mean_angle)), float(np.cos(terrain.mean_angle))
    glide = _Glide(Snow.of(spec.snow, spec.skier, spec.technique.tuck), steepness, normal, speed_to_hold(spec))
    schedule = turn_schedule(spec.course, _schuss_time(glide, spec.course.start_speed))
    if spec.technique.equations == "printed_sign":  # Algorithm 1 as it is printed: away from the lean
        schedule = replace(schedule, curvature=-schedule.curvature)
    motion = _integrate(schedule, glide, spec.course.start_speed)
    heading0 = _start_heading(schedule, motion, spec.course)
    if heading0:
        motion = _integrate(schedule, glide, spec.course.start_speed, heading0)
    return _track(schedule, motion, terrain, spec.course.start_speed)


@dataclass(frozen=True)
class _Motion:
    """Samples over `time` (n,): `arc` [m], `speed`, `heading` [rad], and `down`, `left` [m] within the surface."""

    time: np.ndarray
    arc: np.ndarray
    speed: np.ndarray
    heading: np.ndarray
    down: np.ndarray
    left: np.ndarray


@dataclass(frozen=True)
class _Glide:
    """What moves a skier: snow, the slope's sine and cosine `steepness`, `normal`, and braking to `most` [m/s]."""

    snow: Snow
    steepness: float
    normal: float
    most: float

    def acceleration(self, speed: float, cosine: float) -> float:
        """Return dv/dt [m/s^2] at `speed` where the track's direction has `cosine` with the fall line."""
        along = STANDARD_GRAVITY * self.steepness * cosine
        glide = self.snow.glide_acceleration(along, STANDARD_GRAVITY * self.normal, speed)
        return min(glide, (self.most - speed) / BRAKING_TIME) if speed > self.most - glide * BRAKING_TIME else glide


def _integrate(schedule: TurnSchedule, glide: _Glide, speed: float, heading: float = 0.0) -> _Motion:
    """Integrate speed, heading and position by classical Runge-Kutta steps."""
    end = float(schedule.time[-1])
    count = max(int(np.ceil(end / SAMPLE_TIME)), 20)
    step = end / count
    time = np.linspace(0.0, end, count + 1)
    bend = schedule.curvature_at(np.linspace(0.0, end, 2 * count + 1))
    speeds, headings, stuck = _stages(bend.tolist(), glide, speed, heading, step)
    weights = np.array([step / 6.0, step / 3.0, step / 3.0, step / 6.0])
    moves = (speeds, speeds * np.cos(headings), speeds * np.sin(headings))
    arc, down, left = (np.concatenate(([0.0], np.cumsum(move[:-1] @ weights))) for move in moves)
    if stuck:
        at = time[len(arc) - 1]
        raise _stopped(at, float(arc[-2]), int(schedule.labels_at(at)[1]))
    return _Motion(time, arc, speeds[:, 0].copy(), headings[:, 0].copy(), down, left)


def _stages(
    bend: list[float], glide: _Glide, speed: float, heading: float, step: float
) -> tuple[np.ndarray, np.ndarray, bool]:
    """Return speed [m/s] and heading [rad] (n, 4) at the four stages of each step, and whether the skier got stuck.

    `bend` [1/m] is the curvature at every half `step` [s]. Plain floats, for this is a loop of thousands of steps.
    """
    snow, half, sixth, cos, most = glide.snow, 0.5 * step, step / 6.0, math.cos, glide.most
    gravity, normal = STANDARD_GRAVITY * glide.steepness, STANDARD_GRAVITY * glide.normal
    friction, per_speed, drag = snow.friction, snow.friction_per_speed, snow.drag_factor
    stages: list[float] = []
    stuck = False

    def gain(v: float, psi: float) -> float:
        rate = gravity * cos(psi) - (friction + per_speed * v) * normal - drag * v * v
        return min(rate, (most - v) / BRAKING_TIME) if v > most - rate * BRAKING_TIME else rate

    v, psi = speed, heading
    for i in range(0, len(bend) - 2, 2):
        begin, middle, end = bend[i : i + 3]
        a = gain(v, psi)
        v2, psi2 = v + half * a, psi + half * (begin * v)
        b = gain(v2, psi2)
        v3, psi3 = v + half * b, psi + half * (middle * v2)
        c = gain(v3, psi3)
        v4, psi4 = v + step * c, psi + step * (middle * v3)
        d = gain(v4, psi4)
        stages += (v, v2, v3, v4, psi, psi2, psi3, psi4)
        after = v + sixth * (a + 2.0 * b + 2.0 * c + d)
        psi += sixth * (begin * v + 2.0 * (middle * v2) + 2.0 * (middle * v3) + end * v4)
        stuck = after < min(SLOWEST, v) or after <= 0.0
        v = after
        if stuck:
            break
    stages += (v, v, v, v, psi, psi, psi, psi)
    table = np.array(stages).reshape(-1, 2, 4)
    return table[:, 0].copy(), table[:, 1].copy(), stuck


def _schuss_time(glide: _Glide, speed: float) -> float:
    """Return how long [s] a slow starter runs straight down until he is fast enough to turn."""
    gain = glide.acceleration(speed, 1.0)
    if speed >= SLOW_START or gain <= 0.0:
        return 0.0
    return min((SPEED_TO_TURN - speed) / gain, LONGEST_SCHUSS)


def _stopped(time: float, arc: float, turn: int) -> PlanInfeasible:
    return PlanInfeasible(
        f"turn {turn} ({arc:.1f} m, {time:.1f} s)",
        None,
        "friction stops the skier there: make the slope steeper, lower snow.friction, start faster or turn less",
    )


def _start_heading(schedule: TurnSchedule, motion: _Motion, course: CourseSpec) -> float:
    """Return the heading [rad] at the start that points the middle of the first turn down the fall line."""
    if course.half_first_turn and course.entry == "turn":
        return 0.0
    in_first = np.flatnonzero(schedule.phase != TRANSITION)[0]
    begin, end = schedule.time[in_first], schedule.time[in_first + 1]
    middle = begin if course.half_first_turn else 0.5 * (begin + end)
    return -float(np.interp(middle, motion.time, motion.heading))


def _track(schedule: TurnSchedule, motion: _Motion, terrain: Terrain, start_speed: float) -> Track:
    phase, turn = schedule.labels_at(motion.time)
    if not isinstance(terrain, PlaneTerrain):
        return track_on_surface(terrain, motion.down, motion.left, phase, turn, start_speed)
    normal = terrain.normal(0.0, 0.0)
    down_axis = normalized(np.array([normal[2], 0.0, -normal[0]]))
    left_axis = np.array([0.0, 1.0, 0.0])
    position = motion.down[:, None] * down_axis + motion.left[:, None] * left_axis
    return Track(
        arc_length=motion.arc.copy(),
        position=position,
        tangent=np.cos(motion.heading)[:, None] * down_axis + np.sin(motion.heading)[:, None] * left_axis,
        surface_normal=np.broadcast_to(normal, position.shape).copy(),
        curvature=schedule.curvature_at(motion.time),
        normal_curvature=np.zeros_like(motion.arc),
        torsion=np.zeros_like(motion.arc),
        phase=phase,
        turn=turn,
        start_speed=start_speed,
    )
