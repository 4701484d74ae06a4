"""From a run document to a problem of path following: the drawn path, the obstacles, speed and ground along it.

Everything is in the coordinates that courses are drawn in, down the slope and to the left within its mean plane.
"""

from __future__ import annotations

import math

import numpy as np

from ..errors import PlanInfeasible, SpecError
from ..gravity import GRAVITY
from ..snow import Snow
from ..spec import ObstacleSpec, RunSpec
from ..terrain import Terrain
from ..turning.body import TurningBody
from ..turning.following import (
    DISC,
    LINE,
    POLYGON,
    DesiredPath,
    Obstacle,
    Obstacles,
    Problem,
    SearchSettings,
    hermite_path,
    lane_with,
    polyline_path,
)
from .pace import speed_to_hold

LEAST_SPEED = 2.5
"""Speed [m/s] from which a path is followed; a slower start runs straight on until then."""
WITHIN = 5.0
"""Length of path [m] within one obstacle that is taken for a mistake: it leads into the obstacle, not past it."""
CORNERS = {DISC: 1, LINE: 2, POLYGON: 3}
"""Places that each kind of obstacle needs at least."""
SAMPLE_TIME = 0.1
"""Time between samples of the track [s], about."""


def settings_of(spec: RunSpec) -> SearchSettings:
    """Return the search settings of a run."""
    course = spec.course
    samples = max(round(course.plan_stage_time / SAMPLE_TIME), 1)
    return SearchSettings(
        stages=course.plan_stages,
        stage_time=course.plan_stage_time,
        sample_time=course.plan_stage_time / samples,
        lean_bound=math.radians(course.plan_lean_deg),
    )


def steered_body(spec: RunSpec) -> TurningBody:
    """Return the turning body of the run's person with the course's bounds."""
    from ..turning.preview import body_of  # a preview is of courses

    body, course = body_of(spec), spec.course
    return TurningBody(body.leg_length, body.inertia, 1.0 / course.plan_radius, course.plan_steering)


def follow_problem(spec: RunSpec, terrain: Terrain, points: np.ndarray) -> tuple[Problem, np.ndarray]:
    """Return the problem of following `points` (n, 2) [m] and the speed (m,) [m/s] at the samples of its path.

    The problem's own speed is at least `LEAST_SPEED`. Raises `SpecError` and `PlanInfeasible` for what can be seen to
    be impossible before any search.
    """
    settings, obstacles = settings_of(spec), obstacles_of(spec)
    quickest = max(spec.course.start_speed, 40.0 if math.isinf(speed_to_hold(spec)) else speed_to_hold(spec))
    make = hermite_path if spec.course.path_shape == "spline" else polyline_path
    path = make(points, beyond=1.2 * quickest * (settings.horizon + 1.0))
    check_obstacles(path, obstacles, spec)
    normal, pull = ground_along(path, terrain)
    speed = gliding_speed(spec, path, normal, pull)
    lane = lane_with(path, np.maximum(speed, LEAST_SPEED), normal, pull)
    return Problem(steered_body(spec), lane, obstacles, settings), speed


def obstacles_of(spec: RunSpec) -> Obstacles:
    """Return the obstacles of the rows `[[obstacle]]`; rows that make no shape raise `SpecError`."""
    return Obstacles.of([_obstacle(row, number) for number, row in enumerate(spec.obstacle, start=1)])


def _obstacle(row: ObstacleSpec, number: int) -> Obstacle:
    points = np.array(row.points, dtype=float).reshape(-1, 2)
    key, least = f"obstacle {number}: points", CORNERS[row.kind]
    different = len({(x, y) for x, y in row.points})
    if different < least or (row.kind == DISC and len(points) != 1):
        wanted = "one place" if row.kind == DISC else f"at least {least} different places"
        problem = f"has {different} different places" if different != 1 else "has one place"
        raise SpecError(key, problem=problem, hint=f"a {row.kind} needs {wanted}")
    radius = row.radius if row.kind == DISC else 0.0
    return Obstacle(row.kind, points, radius, row.tolerance, row.name or f"obstacle {number} ({row.kind})")


def check_obstacles(path: DesiredPath, obstacles: Obstacles, spec: RunSpec) -> None:
    """Raise `SpecError` if the path starts or ends in an obstacle or leads into one and not past it."""
    for what, index in (("starts", 0), ("ends", path.last)):
        found = obstacles.at(path.places[index])
        if found is not None:
            _refuse(f"point {1 if index == 0 else len(spec.point)}", what, path.places[index], found)
    length = np.diff(path.along[: path.last + 1])
    middle = 0.5 * (path.places[: path.last] + path.places[1 : path.last + 1])
    for obstacle in obstacles.all:
        some = Obstacles.of([obstacle])
        inside = some.clearance(middle) <= 0.0
        if obstacle.kind == POLYGON:
            inside |= np.array([some.at(place) is not None for place in middle])
        run = _longest_run(inside)
        if run is not None and float(length[run].sum()) > WITHIN:
            _refuse("point", f"leads for {length[run].sum():.1f} m", middle[run.start], obstacle)


def _longest_run(inside: np.ndarray) -> slice | None:
    """Return the longest stretch of true values of `inside` (n,), or None."""
    edges = np.flatnonzero(np.diff(np.concatenate(([False], inside, [False])).astype(int)))
    if not len(edges):
        return None
    begins, ends = edges[::2], edges[1::2]
    longest = int(np.argmax(ends - begins))
    return slice(int(begins[longest]), int(ends[longest]))


def _refuse(field: str, what: str, place: np.ndarray, obstacle: Obstacle) -> None:
    reach = f", its tolerance of {obstacle.tolerance:g} m included" if obstacle.tolerance else ""
    problem = f"{what} inside {obstacle.name} at x = {place[0]:.1f}, y = {place[1]:.1f}{reach}"
    raise SpecError(field, problem=problem, hint="move the path or the obstacle, or make its tolerance smaller")


def ground_along(path: DesiredPath, terrain: Terrain) -> tuple[np.ndarray, np.ndarray]:
    """Return gravity into the ground (m,) and along it (m, 2), down the mean slope and to the left [m/s^2]."""
    cosine, sine = math.cos(terrain.mean_angle), math.sin(terrain.mean_angle)
    normal = terrain.normal(path.places[:, 0] * cosine, path.places[:, 1])
    into = -(normal @ GRAVITY)
    along = GRAVITY + into[:, None] * normal
    down = along @ np.array([cosine, 0.0, -sine])
    return into, np.where(np.abs(pull := np.stack((down, along[:, 1]), axis=1)) < 1e-9, 0.0, pull)


def gliding_speed(spec: RunSpec, path: DesiredPath, normal: np.ndarray, pull: np.ndarray) -> np.ndarray:
    """Return the speed (m,) [m/s] of one who glides along the path, up to the speed to be held.

    Raises `PlanInfeasible` where friction stops the skier.
    """
    snow, most = Snow.of(spec.snow, spec.skier, spec.technique.tuck), speed_to_hold(spec)
    along = pull[:, 0] * np.cos(path.heading) + pull[:, 1] * np.sin(path.heading)
    energy = 0.5 * min(spec.course.start_speed, most) ** 2
    speeds = [math.sqrt(2.0 * energy)]
    for index, step in enumerate(np.diff(path.along).tolist()):
        gain = snow.glide_acceleration(float(along[index]), float(normal[index]), speeds[-1])
        energy = energy + step * gain
        if energy <= 0.0:
            if index < path.last:
                x, y = path.places[index]
                reason = "no speed is left to balance with: make the slope steeper, lower snow.friction or start faster"
                raise PlanInfeasible(f"x = {x:.1f}, y = {y:.1f} ({path.along[index]:.1f} m)", None, reason)
            energy = 0.5 * speeds[-1] ** 2
        energy = min(energy, 0.5 * most**2)
        speeds.append(math.sqrt(2.0 * energy))
    return np.array(speeds)


def standing_lean(problem: Problem, sample: int, heading: float) -> float:
    """Return the lean [rad] that is balanced when running straight on with `heading` at a sample of the path."""
    down, left = problem.lane.pull[sample]
    return -math.atan2(left * math.cos(heading) - down * math.sin(heading), float(problem.lane.normal[sample]))
