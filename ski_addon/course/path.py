"""A drawn path: any row of points down the slope, smoothed to what the speed allows."""

from __future__ import annotations

import math

import numpy as np

from ..errors import SpecError
from ..gravity import STANDARD_GRAVITY
from ..spec import RunSpec
from ..terrain import Terrain
from .drawn_points import CLIMB_MAX, DRAWN_CLIMB_MAX, check_climb, check_inside, distinct_points, nearest_point
from .labels import label_turns
from .pace import speed_to_hold
from .smoothing import curvature, interpolated, smoothed, smoothed_to
from .surface import track_on_surface
from .track import Track

RADIUS_MIN = 3.0
"""No turn of a drawn path is tighter than this [m]."""
_SLIGHTEST, _LEAST_TURN, _TURN_SHARE = 0.002, 0.02, 0.4
_LEEWAY = 1.02


def build_path_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return the track along the `[[point]]` rows of `spec`.

    Raises `SpecError` for a path that crosses itself, goes uphill, leaves the terrain or is too tight.
    """
    points, number = distinct_points(spec)
    _check_crossing(points, number)
    check_climb(points, DRAWN_CLIMB_MAX, points, number, terrain)
    path = _smooth(spec, points, number)
    check_climb(path, CLIMB_MAX, points, number, terrain)
    check_inside(path, points, number, terrain)
    bend = curvature(path)
    phase, turn = label_turns(bend, least_turn(bend))
    down, left = np.ascontiguousarray(path.T)
    return track_on_surface(terrain, down, left, phase, turn, spec.course.start_speed)


def least_turn(bend: np.ndarray) -> float:
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
    try:
        result = smoothed(path, asked)
    except np.linalg.LinAlgError:
        hint = "use less, or auto"
        raise SpecError("course.path_smoothing", asked, hint=hint, problem="is too much for this path") from None
    hint = "use more course.path_smoothing, or auto"
    _check_tight(result, points, number, 1.0 / RADIUS_MIN, f"{RADIUS_MIN:g} m", hint)
    return result


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
        near = nearest_point(path[worst], points)
        problem = f"makes a turn of {1.0 / bend[worst]:.1f} m radius, tighter than {allowed} ({1.0 / limit:.1f} m)"
        raise SpecError(f"point {number[near]}", problem=problem, hint=f"{remedy}, or draw a wider turn")
