"""A path that is followed past obstacles by planning ahead [VP93 sec. 6], as a track and as a motion."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..errors import PlanInfeasible
from ..spec import RunSpec
from ..terrain import Terrain
from ..turning.following import Followed, Obstacles, Problem, between_samples, body_on, follow_to_the_end
from ..turning.following.stepping import HEADING, LEAN, Bodies, X, Y
from .drawn_points import CLIMB_MAX, DRAWN_CLIMB_MAX, check_climb, check_inside, distinct_points
from .follow_problem import LEAST_SPEED, WITHIN, follow_problem, obstacles_of, standing_lean
from .labels import label_turns
from .path import least_turn
from .smoothing import curvature, smoothed
from .surface import track_on_surface
from .track import Track

SMOOTHING = 0.6, 0.3, 0.15
"""Lengths [m] below which bends of the ridden track are smoothed away; the first that clears all obstacles is taken."""
GRID = 0.1
"""Distance between places of the track before it is laid on the ground [m]."""
CUT = 0.03
"""How much nearer [m] than the tolerance a smooth track may come to an obstacle than the samples of the plan."""
_RATE = 100.0


@dataclass(frozen=True)
class CourseRide:
    """How the path of a course is followed: the `problem` solved, what was `followed` and the motion in between.

    `time` (n,) [s] is even, `states` (n, 6) by rows of `turning.following.stepping`, `speed` (n,) [m/s]. A slow start
    runs straight on first.
    """

    problem: Problem
    followed: Followed
    time: np.ndarray
    states: np.ndarray
    speed: np.ndarray

    @property
    def stopped(self) -> PlanInfeasible | None:
        """What stops the body before the path's end, or None."""
        if not self.followed.reason:
            return None
        x, y = self.followed.places[-1]
        place = f"x = {x:.1f}, y = {y:.1f} ({self.time[-1]:.1f} s)"
        return PlanInfeasible(place, None, f"there is no feasible plan: {self.followed.reason}")


def ride_course(spec: RunSpec, terrain: Terrain) -> CourseRide:
    """Return how the path of `spec` is followed, up to where nothing goes on (`followed.reason`).

    Raises `SpecError` or `PlanInfeasible` for what is impossible from the beginning.
    """
    points, number = distinct_points(spec)
    check_climb(points, DRAWN_CLIMB_MAX, points, number, terrain)
    check_inside(points, points, number, terrain)
    problem, speed = follow_problem(spec, terrain, points)
    path = problem.lane.path
    check_inside(path.places[: path.last + 1], points, number, terrain)
    start, lead_states, lead_speed = _start(problem, speed)
    followed = follow_to_the_end(problem, start)
    time, states, pace = between_samples(problem, followed, _RATE)
    states, pace = np.concatenate((lead_states, states)), np.concatenate((lead_speed, pace))
    step = float(time[1]) if len(time) > 1 else 1.0 / _RATE
    return CourseRide(problem, followed, step * np.arange(len(states)), states, pace)


def build_follow_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return the track of the body that follows the `[[point]]` rows of `spec` past its `[[obstacle]]` rows.

    Raises `SpecError` or `PlanInfeasible` with the place and what stops the body there.
    """
    ride = ride_course(spec, terrain)
    if ride.stopped is not None:
        raise ride.stopped
    points, number = distinct_points(spec)
    path = _smooth(ride)
    check_climb(path, CLIMB_MAX, points, number, terrain)
    bend = curvature(path)
    phase, turn = label_turns(bend, least_turn(bend))
    down, left = np.ascontiguousarray(path.T)
    return track_on_surface(terrain, down, left, phase, turn, spec.course.start_speed)


def check_clear(track: Track, spec: RunSpec, terrain: Terrain) -> None:
    """Raise `PlanInfeasible` where `track`, its run-out included, runs into an obstacle of `spec`."""
    places = np.stack((track.position[:, 0] / np.cos(terrain.mean_angle), track.position[:, 1]), axis=1)
    obstacles = _narrower(obstacles_of(spec))
    hit = np.flatnonzero(obstacles.hit_by(places[:-1], places[1:]))
    if len(hit):
        found = obstacles.first_hit(places[:-1], places[1:])
        x, y = places[hit[0]]
        what = "the way to the stop" if track.arc_length[hit[0]] > track.stop_from - WITHIN else "the smoothed track"
        reason = f"{what} runs into {found.name if found else 'an obstacle'} (move it, or choose another finish)"
        raise PlanInfeasible(f"x = {x:.1f}, y = {y:.1f}", None, reason)


def _narrower(obstacles: Obstacles) -> Obstacles:
    return replace(obstacles, reach=np.maximum(obstacles.reach - CUT, 0.0))


def _start(problem: Problem, speed: np.ndarray) -> tuple[Bodies, np.ndarray, np.ndarray]:
    """Return where the path begins to be followed, and even times' states (n, 6) and speeds (n,) until then."""
    lane = problem.lane
    path, first = lane.path, int(np.argmax(speed >= LEAST_SPEED))
    heading = float(path.heading[0])
    toward = np.array([np.cos(heading), np.sin(heading)])
    place = path.places[0] + path.along[first] * toward
    lean = standing_lean(problem, first, heading)
    found = problem.obstacles.first_hit(path.places[:1], place[None])
    if first and found is not None:
        x, y = path.places[0]
        reason = f"{found.name} is in the way before there is speed to steer with (start faster, or move it)"
        raise PlanInfeasible(f"x = {x:.1f}, y = {y:.1f}", None, reason)
    body = body_on(lane, place, heading)
    body.state[LEAN] = lean
    pace = _straight(path.along[: first + 1], speed[: first + 1])
    ahead = np.append(np.cumsum((0.5 * (pace[1:] + pace[:-1]) / _RATE)[::-1])[::-1], 0.0)  # of each moment [m]
    states = np.zeros((len(pace), 6))
    states[:, [X, Y]] = place - ahead[:, None] * toward
    states[:, HEADING], states[:, LEAN] = heading, lean
    return body, states[:-1], pace[:-1]


def _straight(along: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Return the speed (n,) [m/s] at even times up to the end of a run over `along` (m,) [m] at `speed` (m,)."""
    if len(along) < 2:
        return speed[:1]
    time = np.concatenate(([0.0], np.cumsum(2.0 * np.diff(along) / (speed[1:] + speed[:-1]))))
    return np.interp(time[-1] - np.arange(int(time[-1] * _RATE), -1, -1) / _RATE, time, speed)


def _smooth(ride: CourseRide) -> np.ndarray:
    """Return the ridden way (n, 2) [m] at even steps, as smooth as the obstacles allow."""
    from scipy.interpolate import CubicSpline

    places = ride.states[:, [X, Y]]
    arc = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))))
    apart = np.concatenate(([True], np.diff(arc) > 1e-6))
    even = np.linspace(0.0, arc[-1], max(int(np.ceil(arc[-1] / GRID)), 20) + 1)
    way = CubicSpline(arc[apart], places[apart])(even)
    obstacles = _narrower(ride.problem.obstacles)
    for length in SMOOTHING:
        path = smoothed(way, length)
        if not obstacles.hit_by(path[:-1], path[1:]).any():
            break
    return path
