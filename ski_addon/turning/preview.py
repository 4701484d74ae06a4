"""Instant motion of any course: the leaning body along its track, in milliseconds, for the whole run.

The track says where the support goes and `planning.ride` how fast; the lean is the bounded one of the pendulum over
it. On bumps the body keeps to the ground's smooth course, as in the plan, and its lean is measured from the snow.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from ..course import CourseRide, Track, build_track, ride_course
from ..errors import SkiAddonError
from ..gravity import GRAVITY, STANDARD_GRAVITY
from ..planning import as_planned
from ..planning.checks import check_arrival
from ..planning.line import body_normals
from ..planning.ride import Body, plan_ride
from ..planning.speed_and_lean import speed_control
from ..snow import Snow
from ..spec import RunSpec
from ..terrain import PlaneTerrain, Terrain, build_terrain
from .body import TurningBody
from .motion import TurningMotion
from .person import body_of
from .rhythm import RhythmRun, run_rhythm
from .trace import motion_on_ground
from .way import Leaning, Way

TIME_STEP = 0.01
"""Time between neighbouring moments of a preview [s], about: a whole number of them makes the run."""
RIDE_STEP = 0.02
"""Step [s] in which a preview's speed is integrated."""
LEAST_MOMENTS = 20
"""A rhythm or path that cannot be kept to for so many moments has no preview."""


def preview_motion(spec: RunSpec) -> TurningMotion:
    """Return the motion of the leaning body on the whole run of `spec`, whatever its course and ground.

    Raises `SpecError` or `PlanInfeasible` for a course without a track. Where friction stops a skier on the way, or a
    rhythm or a path past obstacles cannot go on, the motion ends; see `preview_course`.
    """
    return preview_course(spec).motion


@dataclass(frozen=True)
class Preview:
    """The `motion` of a run, and the `problem` that ends it early, or None."""

    motion: TurningMotion
    problem: SkiAddonError | None


def preview_course(spec: RunSpec, terrain: Terrain | None = None) -> Preview:
    """Return the preview of a run; a rhythm or path that cannot be kept to ends at that place, with the problem.

    `terrain` is that of the run, if it is known already. Raises what `preview_motion` raises.
    """
    terrain = terrain or build_terrain(spec.slope)
    believed = as_planned(spec)
    level, stops = isinstance(terrain, PlaneTerrain), spec.course.finish == "stop"
    if spec.course.kind == "rhythm":
        made = run_rhythm(believed, terrain.mean_angle)
        if made.last < LEAST_MOMENTS and made.problem is not None:
            raise made.problem
        if made.problem is not None or (level and not stops):
            return Preview(_of_rhythm(made, terrain), made.problem)
    if spec.course.kind == "follow":
        ride = ride_course(believed, terrain)
        if ride.stopped is not None and len(ride.time) < LEAST_MOMENTS:
            raise ride.stopped
        if ride.stopped is not None or (level and not stops):
            return Preview(_of_ride(ride, body_of(believed), terrain), ride.stopped)
    return Preview(preview_track(believed, build_track(believed, terrain), terrain), None)


def _of_ride(ride: CourseRide, body: TurningBody, terrain: Terrain) -> TurningMotion:
    """Return how a path is followed as motion: the plan has the lean already."""
    x, y, _, lean, lean_rate, curvature = ride.states.T
    place = np.stack((x * np.cos(terrain.mean_angle), y), axis=1)
    return motion_on_ground(body, terrain, ride.time, place, lean, lean_rate, curvature, ride.speed)


def _of_rhythm(made: RhythmRun, terrain: Terrain) -> TurningMotion:
    """Return the swings themselves as motion: on a plane they need no second look."""
    run, kept = made.run, slice(0, made.last + 1)
    place = np.stack((run.down[kept, 0] * np.cos(terrain.mean_angle), run.left[kept, 0]), axis=1)
    values = (values[kept, 0] for values in (run.lean, run.lean_rate, run.curvature, run.speed, run.phase))
    return motion_on_ground(made.body, terrain, run.time[kept], place, *values)


Riding = tuple[np.ndarray, np.ndarray, np.ndarray]
"""Even times (n,) [s], and the way [m] and the speed [m/s] of the centre of mass then."""


def preview_track(spec: RunSpec, track: Track, terrain: Terrain, riding: Riding | None = None) -> TurningMotion:
    """Return the motion of the leaning body along `track` on `terrain`, ridden as in `riding` if that is known."""
    body = body_of(spec)
    ups = None if isinstance(terrain, PlaneTerrain) else body_normals(track)
    time, arc, speed = riding or ride_track(spec, track)
    step = time[1]
    first = Way.along(track, ups, step, arc, speed)
    share = _inside(body, first, first.lean(body))  # the ride is that of the centre of mass, on its smaller circle
    passed = np.concatenate(([0.0], np.cumsum(0.5 * step * (share[1:] + share[:-1]))))
    time = _evenly(float(passed[-1]))
    arc, speed = np.interp(time, passed, arc), np.interp(time, passed, speed / share)
    way = Way.along(track, ups, time[1], arc, speed)
    leaning = way.lean(body)
    speed = speed * _inside(body, way, leaning)
    motion = motion_on_ground(
        body, terrain, time, way.position[:, :2], leaning.lean, leaning.lean_rate, way.curvature, speed
    )
    return motion if way.up is None else dataclasses.replace(motion, leg_force=_force(body, way, leaning, speed))


def ride_track(spec: RunSpec, track: Track, step: float = RIDE_STEP) -> Riding:
    """Return how fast `track` is ridden, integrated in steps of `step` [s].

    Raises `PlanInfeasible` where friction holds the skier at the start.
    """
    snow = Snow.of(spec.snow, spec.skier, spec.technique.tuck)
    weight = -(track.surface_normal @ GRAVITY)
    body = Body(weight, np.zeros_like(weight), track.arc_length)
    ride = plan_ride(track, snow, body, speed_control(spec, track), step)
    if ride.time[-1] < TIME_STEP:  # nothing moves at all; one who is stopped later is shown up to there
        check_arrival(track, ride)
    time = _evenly(float(ride.time[-1]))
    return time, np.interp(time, ride.time, ride.arc_length), np.interp(time, ride.time, ride.speed)


def _evenly(duration: float) -> np.ndarray:
    return np.linspace(0.0, duration, max(round(duration / TIME_STEP), 3) + 1)


def _inside(body: TurningBody, way: Way, leaning: Leaning) -> np.ndarray:
    """Return how much slower (n,) than the support the centre of mass is, which leans into the turn [VP93 Eq. 21]."""
    return 1.0 - way.curvature * body.leg_length * np.sin(leaning.body_lean)


def _force(body: TurningBody, way: Way, leaning: Leaning, speed: np.ndarray) -> np.ndarray:
    """Return the leg's force (n,) [body weights] over bumpy ground, as the body over the smooth ground feels it."""
    across = leaning.pull_left + np.square(way.speed) * way.curvature
    force = body.leg_force(leaning.body_lean, leaning.body_lean_rate, way.curvature, speed, leaning.pull_into, across)
    return np.hypot(*force) / STANDARD_GRAVITY
