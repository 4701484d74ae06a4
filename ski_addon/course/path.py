"""A drawn path: any row of points down the slope, smoothed to what the speed allows."""

from __future__ import annotations

import math

import numpy as np

from ..errors import SpecError
from ..gravity import STANDARD_GRAVITY
from ..spec import RunSpec
from ..terrain import Terrain
from .labels import label_turns
from .pace import speed_to_hold
from .smoothing import curvature, interpolated, smoothed, smoothed_to
from .surface import track_on_surface
from .track import Track

RADIUS_MIN = 3.0
"""No turn of a drawn path is tighter than this [m]."""
MERGED = 0.05
"""Points nearer than this to the one before them [m] are that point again."""
DRAWN_CLIMB_MAX, CLIMB_MAX = 0.5, 0.2
"""A drawing hand, and the smooth path, may go back up the slope by this much [m]."""
_SLIGHTEST, _LEAST_TURN, _TURN_SHARE = 0.002, 0.02, 0.4
_LEEWAY = 1.02


def build_path_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return the track along the `[[point]]` rows of `spec`.

    Raises `SpecError` for a path that crosses itself, goes uphill, leaves the terrain or is too tight.
    """
    points, number = _distinct(spec)
    _check_crossing(points, number)
    _check_climb(points, DRAWN_CLIMB_MAX, points, number, terrain)
    path = _smooth(spec, points, number)
    _check_climb(path, CLIMB_MAX, points, number, terrain)
    _check_inside(path, points, number, terrain)
    bend = curvature(path)
    phase, turn = label_turns(bend, _least_turn(bend))
    down, left = np.ascontiguousarray(path.T)
    return track_on_surface(terrain, down, left, phase, turn, spec.course.start_speed)


def _least_turn(bend: np.ndarray) -> float:
    """Return from what curvature [1/m] on a bend counts as a turn; less on a path of wide turns only."""
    return max(min(_LEAST_TURN, _TURN_SHARE * float(np.max(np.abs(bend)))), _SLIGHTEST)


def curvature_limit(spec: RunSpec) -> float:
    """Return the largest curvature [1/m] that a skier leaning as far as allowed can ski at the asked speed."""
    sideways = STANDARD_GRAVITY * float(np.tan(np.deg2rad(spec.technique.inclination_max_deg)))
    return min(sideways / max(asked_speed(spec), 0.1) ** 2, 1.0 / RADIUS_MIN)


def asked_speed(spec: RunSpec) -> float:
    """Return the speed [m/s] that is to be held, or that at the start if none is."""
    hold = speed_to_hold(spec)
    return hold if math.isfinite(hold) else spec.course.start_speed


def _smooth(spec: RunSpec, points: np.ndarray, number: np.ndarray) -> np.ndarray:
    """Return a smooth curve (n, 2) along `points`."""
    path, asked = interpolated(points), spec.course.path_smoothing
    if isinstance(asked, str):
        limit = curvature_limit(spec)
        path = smoothed_to(path, limit)
        _check_tight(path, points, number, limit, f"what {asked_speed(spec):g} m/s allow", "ski slower")
        return path
    result = smoothed(path, asked)
    hint = "use more course.path_smoothing, or auto"
    _check_tight(result, points, number, 1.0 / RADIUS_MIN, f"{RADIUS_MIN:g} m", hint)
    return result


def _distinct(spec: RunSpec) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (n, 2) without repetitions and their numbers (n,) in the document, from 1."""
    points = np.array([(point.x, point.y) for point in spec.point], dtype=float).reshape(-1, 2)
    kept: list[int] = []
    for index, point in enumerate(points):
        if not kept or np.hypot(*(point - points[kept[-1]])) > MERGED:
            kept.append(index)
    if len(kept) < 2:
        there = (
            f"are {len(points)} rows, all in one place"
            if len(points) > 1
            else ("is one row" if len(points) else "are no rows")
        )
        hint = "add [[point]] rows with x and y, at least two in different places"
        raise SpecError("point", problem=f"is not a path: there {there}", hint=hint)
    return points[kept], np.array(kept) + 1


def _check_crossing(points: np.ndarray, number: np.ndarray) -> None:
    """Raise `SpecError` if two segments of the polyline cross."""
    begin, step = points[:-1], np.diff(points, axis=0)
    later = np.arange(len(step))
    for i in range(len(step) - 2):
        others = later[i + 2 :]
        away = begin[others] - begin[i]
        across = _cross(step[i], step[others])
        with np.errstate(divide="ignore", invalid="ignore"):
            here, there = _cross(away, step[others]) / across, _cross(away, step[i]) / across
        hit = np.flatnonzero((here >= 0.0) & (here <= 1.0) & (there >= 0.0) & (there <= 1.0))
        if len(hit):
            j = others[hit[0]]
            x, y = begin[i] + here[hit[0]] * step[i]
            problem = (
                f"crosses the path: points {number[j]}-{number[j + 1]} cross points {number[i]}-{number[i + 1]} "
                f"at x = {x:.1f}, y = {y:.1f}"
            )
            raise SpecError(f"point {number[j + 1]}", problem=problem, hint="move it to the near side of that segment")


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def _check_tight(
    path: np.ndarray, points: np.ndarray, number: np.ndarray, limit: float, allowed: str, remedy: str
) -> None:
    bend = np.abs(curvature(path))
    worst = int(np.argmax(bend))
    if bend[worst] > _LEEWAY * limit:
        near = _nearest(path[worst], points)
        problem = f"makes a turn of {1.0 / bend[worst]:.1f} m radius, tighter than {allowed} ({1.0 / limit:.1f} m)"
        raise SpecError(f"point {number[near]}", problem=problem, hint=f"{remedy}, or draw a wider turn")


def _check_climb(path: np.ndarray, most: float, points: np.ndarray, number: np.ndarray, terrain: Terrain) -> None:
    """Raise `SpecError` where `path` (n, 2) goes back up the slope by more than `most` [m]."""
    if terrain.mean_angle <= 0.0:
        return
    lowest = np.maximum.accumulate(path[:, 0])
    back = lowest - path[:, 0]
    if float(back.max()) <= most:
        return
    begin = int(np.argmax(back > most))
    end = begin + int(np.argmin(np.append(np.diff(back[begin:]), -1.0) > 0.0))
    near = _nearest(path[end], points)
    problem = f"goes uphill by {back[end]:.1f} m, to x = {path[end, 0]:.1f}, y = {path[end, 1]:.1f}"
    raise SpecError(f"point {number[near]}", problem=problem, hint=f"x of at least {lowest[end]:.1f} would work")


def _check_inside(path: np.ndarray, points: np.ndarray, number: np.ndarray, terrain: Terrain) -> None:
    """Raise `SpecError` where the path leaves the known ground."""
    cosine = float(np.cos(terrain.mean_angle))
    inside = terrain.contains(path[:, 0] * cosine, path[:, 1])
    if inside.all():
        return
    out = int(np.argmin(inside))
    near = _nearest(path[out], points)
    x_low, x_high, y_low, y_high = terrain.extent
    problem = f"leaves the terrain at x = {path[out, 0]:.1f}, y = {path[out, 1]:.1f}"
    hint = (
        f"the ground reaches from x = {x_low / cosine:.1f} to {x_high / cosine:.1f} and from y = {y_low:.1f} "
        f"to {y_high:.1f}"
    )
    raise SpecError(f"point {number[near]}", problem=problem, hint=hint)


def _nearest(place: np.ndarray, points: np.ndarray) -> int:
    return int(np.argmin(np.linalg.norm(points - place, axis=1)))
