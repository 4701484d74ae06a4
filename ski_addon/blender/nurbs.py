"""Points on NURBS splines, reckoned as Blender does: reading them off a mesh of the curve would need to write data,
which is not allowed while a panel is drawn.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..frames import Array

MOST = 400
"""The most points that are taken from a spline."""


def nurbs_line(spline: Any, step: float) -> Array:
    """Return points (m, 3) along a NURBS spline in its object's axes, about `step` [in its unit] apart, ends included.

    A cyclic spline is followed once round.
    """
    points, knots, order = _parts(spline)
    low, high = knots[order - 1], knots[len(points)]
    way = float(np.linalg.norm(np.diff(points[:, :3] / points[:, 3:], axis=0), axis=1).sum())
    count = int(np.clip(np.ceil(way / max(step, 1e-9)), 8, MOST))
    corners = knots[order - 1 : len(points) + 1]  # where knots are repeated, or the order is 2
    return _evaluated(points, knots, order, np.union1d(np.linspace(low, high, count + 1), corners))


def nurbs_knots(spline: Any) -> Array:
    """Return the places (m, 3) on a NURBS spline that belong to its control points, which lie beside it."""
    points, knots, order = _parts(spline)
    count = len(spline.points)
    own = np.array([knots[index + 1 : index + order].mean() for index in range(count)])
    low, high = knots[order - 1], knots[len(points)]
    places = np.unique(np.clip(own, low, high) if not spline.use_cyclic_u else low + (own - low) % (high - low))
    return _evaluated(points, knots, order, places)


def _parts(spline: Any) -> tuple[Array, Array, int]:
    """Return control points (n, 4) times their weights, the weights last, the knots (n + order,) and the order."""
    raw = np.array([point.co for point in spline.points], dtype=float)
    points = np.concatenate((raw[:, :3] * raw[:, 3:], raw[:, 3:]), axis=1)
    order = int(min(spline.order_u, len(points)))
    count = len(points)
    if spline.use_cyclic_u:
        points = np.concatenate((points, points[np.arange(order - 1) % count]))
    return points, _knots(spline, count, order), order


def _knots(spline: Any, count: int, order: int) -> Array:
    """Return the knots of a spline of `count` control points."""
    cyclic, at_ends, bezier = spline.use_cyclic_u, spline.use_endpoint_u, spline.use_bezier_u
    repeated = order - 1 if bezier else 1
    free = min(2, repeated) if bezier else 1
    head = order - int(cyclic) if at_ends else free
    tail = 2 * order - 1 if cyclic else order if at_ends else 0
    total = count + order + (order - 1 if cyclic else 0)
    knots, left, now = np.zeros(total), head, 0.0
    begin = 1 if at_ends and cyclic else 0
    now += begin
    for index in range(begin, total - tail):
        knots[index] = now
        left -= 1
        if left == 0:
            now, left = now + 1.0, repeated
    knots[total - tail :] = now + (knots[:tail] - knots[0])
    return knots


def _evaluated(points: Array, knots: Array, order: int, places: Array) -> Array:
    """Return the curve (m, 3) at the parameters `places` (m,), by the recursion of Cox and de Boor."""
    last = len(points) - 1
    span = np.clip(np.searchsorted(knots, places, side="right") - 1, order - 1, last)
    while np.any(empty := (knots[span + 1] <= knots[span]) & (span > order - 1)):
        span = np.where(empty, span - 1, span)
    found = points[span[:, None] - (order - 1) + np.arange(order)].copy()  # (m, order, 4)
    for level in range(1, order):
        for index in range(order - 1, level - 1, -1):
            at = span - (order - 1) + index
            width = knots[at + order - level] - knots[at]
            share = np.where(width > 0.0, (places - knots[at]) / np.where(width > 0.0, width, 1.0), 0.0)[:, None]
            found[:, index] = (1.0 - share) * found[:, index - 1] + share * found[:, index]
    return np.asarray(found[:, -1, :3] / found[:, -1, 3:])
