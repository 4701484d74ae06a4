"""Tubes along lines in space, straight or bent, and rings round an axle: what bicycles and bindings are made of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ...frames import Array, normalized
from .shapes import Part, facing_out, loft


def tube(
    points: Sequence[Any] | Array,
    radius: float | Sequence[float] | Array,
    material: str,
    count: int = 10,
    *,
    flat: float = 1.0,
    closed: bool = False,
) -> Part:
    """Return a tube of `radius` [m] (one, or one a point) along `points` (n, 3) [m] with `count` faces round it.

    `flat` scales it across the plane in which it bends; a `closed` tube joins its end to its start.
    """
    points = np.asarray(points, dtype=float)
    radii = np.broadcast_to(np.asarray(radius, dtype=float), len(points))
    first, second = _across(points, closed)
    angle = 2.0 * np.pi * np.arange(count) / count
    cosine, sine = np.cos(angle)[:, None], flat * np.sin(angle)[:, None]
    rings = np.stack([p + r * (cosine * a + sine * b) for p, r, a, b in zip(points, radii, first, second, strict=True)])
    if closed:
        return revolved(rings, material)
    return loft(rings, material)


def revolved(rings: Array, material: str | Callable[[int, int], str]) -> Part:
    """Return closed `rings` (m, k, 3) joined one to the next and the last to the first, as of a tyre."""
    rows, count = rings.shape[:2]
    named = material if callable(material) else lambda _row, _column: material
    faces, materials = [], []
    for row in range(rows):
        for column in range(count):
            a, b = row * count + column, row * count + (column + 1) % count
            c, d = ((row + 1) % rows) * count + (column + 1) % count, ((row + 1) % rows) * count + column
            faces.append((a, b, c, d))
            materials.append(named(row, column))
    return facing_out(Part(rings.reshape(-1, 3), faces, materials))


def turned_profile(profile: Sequence[tuple[float, float]], material: str | Callable[[int, int], str],
                   steps: int = 40) -> Part:  # fmt: skip
    """Return a solid ring about the y axis whose section is the closed `profile` of (radius, y) [m]."""
    section = np.asarray(profile, dtype=float)
    angle = 2.0 * np.pi * np.arange(steps) / steps
    rings = [np.column_stack((r * np.cos(a), y, r * np.sin(a))) for a in angle for r, y in [section.T]]
    return revolved(np.stack(rings), material)


def spindle(profile: Sequence[tuple[float, float]], material: str, count: int = 12) -> Part:
    """Return a solid turned about the y axis, closed at both ends: `profile` of (radius, y) [m] along it."""
    angle = 2.0 * np.pi * np.arange(count) / count
    rings = [np.column_stack((r * np.cos(angle), np.full(count, y), r * np.sin(angle))) for r, y in profile]
    return loft(np.stack(rings), material)


def arc(centre: Sequence[float], radius: float, start: float, end: float, steps: int) -> Array:
    """Return points (steps, 3) on a circle about the y axis, angles [rad] from +x towards +z."""
    angle = np.linspace(start, end, steps)
    return np.asarray(centre) + radius * np.column_stack((np.cos(angle), 0.0 * angle, np.sin(angle)))


def _across(points: Array, closed: bool) -> tuple[Array, Array]:
    """Return two unit vectors (n, 3) across a line at each of its `points`, turned about it as little as can be."""
    if closed:
        tangent = normalized(np.roll(points, -1, axis=0) - np.roll(points, 1, axis=0))
    else:
        tangent = normalized(np.gradient(points, axis=0))
    hint = np.eye(3)[int(np.argmin(np.abs(tangent).max(axis=0)))]
    if closed:  # flat enough that one direction serves all round, and meets itself
        first_axis = normalized(hint - (tangent @ hint)[:, None] * tangent)
        return np.cross(tangent, first_axis), first_axis
    first = [normalized(hint - (hint @ tangent[0]) * tangent[0])]
    for direction in tangent[1:]:
        first.append(normalized(first[-1] - (first[-1] @ direction) * direction))
    first_axis = np.stack(first)
    return np.cross(tangent, first_axis), first_axis
