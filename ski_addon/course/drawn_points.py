"""The points of a drawn path: which count, and what none may do."""

from __future__ import annotations

import numpy as np

from ..errors import SpecError
from ..spec import RunSpec
from ..terrain import Terrain

MERGED = 0.05
"""Points nearer than this to the one before them [m] are that point again."""
DRAWN_CLIMB_MAX, CLIMB_MAX = 0.5, 0.2
"""A drawing hand, and the smooth path, may go back up the slope by this much [m]."""


def distinct_points(spec: RunSpec) -> tuple[np.ndarray, np.ndarray]:
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


def check_climb(path: np.ndarray, most: float, points: np.ndarray, number: np.ndarray, terrain: Terrain) -> None:
    """Raise `SpecError` where `path` (n, 2) goes back up the slope by more than `most` [m]."""
    if terrain.mean_angle <= 0.0:
        return
    lowest = np.maximum.accumulate(path[:, 0])
    back = lowest - path[:, 0]
    if float(back.max()) <= most:
        return
    begin = int(np.argmax(back > most))
    end = begin + int(np.argmin(np.append(np.diff(back[begin:]), -1.0) > 0.0))
    near = nearest_point(path[end], points)
    problem = f"goes uphill by {back[end]:.1f} m, to x = {path[end, 0]:.1f}, y = {path[end, 1]:.1f}"
    raise SpecError(f"point {number[near]}", problem=problem, hint=f"x of at least {lowest[end]:.1f} would work")


def check_inside(path: np.ndarray, points: np.ndarray, number: np.ndarray, terrain: Terrain) -> None:
    """Raise `SpecError` where the path leaves the known ground."""
    cosine = float(np.cos(terrain.mean_angle))
    inside = terrain.contains(path[:, 0] * cosine, path[:, 1])
    if inside.all():
        return
    out = int(np.argmin(inside))
    near = nearest_point(path[out], points)
    x_low, x_high, y_low, y_high = terrain.extent
    problem = f"leaves the terrain at x = {path[out, 0]:.1f}, y = {path[out, 1]:.1f}"
    hint = (
        f"the ground reaches from x = {x_low / cosine:.1f} to {x_high / cosine:.1f} and from y = {y_low:.1f} "
        f"to {y_high:.1f}"
    )
    raise SpecError(f"point {number[near]}", problem=problem, hint=hint)


def nearest_point(place: np.ndarray, points: np.ndarray) -> int:
    """Return the index of the one of `points` (n, 2) that is nearest to `place` (2,)."""
    return int(np.argmin(np.linalg.norm(points - place, axis=1)))
