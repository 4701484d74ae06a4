"""Obstacles: discs, lines and polygons that the track must not touch, each with a tolerance [VP93 sec. 6].

All of them are kept as rounded segments: a disc is a segment of no length, a polygon its closed outline. The track
between two samples is a segment too, so that nothing thin can slip through between samples.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...frames import Array

DISC, LINE, POLYGON = "disc", "line", "polygon"


@dataclass(frozen=True)
class Obstacle:
    """One obstacle in the plan view: `points` (k, 2) [m] of the centre of a disc, along a line or round a polygon.

    `radius` [m] is that of a disc; the track keeps `tolerance` [m] away. `name` is for messages.
    """

    kind: str
    points: Array
    radius: float = 0.0
    tolerance: float = 0.0
    name: str = ""

    def moved(self, by: Array) -> Obstacle:
        """Return the obstacle moved by `by` (2,) [m]."""
        return Obstacle(self.kind, np.asarray(self.points) + by, self.radius, self.tolerance, self.name)


@dataclass(frozen=True)
class Obstacles:
    """Rounded segments from `begin` to `end` (k, 2) with radius `reach` (k,) [m]; `owner` (k,) are indices in `all`."""

    all: tuple[Obstacle, ...]
    begin: Array
    end: Array
    reach: Array
    owner: Array

    @classmethod
    def of(cls, obstacles: Sequence[Obstacle]) -> Obstacles:
        """Return the rounded segments of `obstacles`."""
        begin, end, reach, owner = [np.zeros((0, 2))], [np.zeros((0, 2))], [], []
        for index, obstacle in enumerate(obstacles):
            points = np.asarray(obstacle.points, dtype=float).reshape(-1, 2)
            if obstacle.kind == POLYGON:
                points = np.concatenate((points, points[:1]))
            first, second = (points, points) if len(points) == 1 else (points[:-1], points[1:])
            begin.append(first)
            end.append(second)
            reach += [obstacle.radius + obstacle.tolerance] * len(first)
            owner += [index] * len(first)
        return cls(
            tuple(obstacles),
            np.concatenate(begin),
            np.concatenate(end),
            np.array(reach, dtype=float),
            np.array(owner, dtype=int),
        )

    def __len__(self) -> int:
        return len(self.reach)

    @cached_property
    def _middle_and_size(self) -> tuple[Array, Array]:
        return 0.5 * (self.begin + self.end), 0.5 * np.linalg.norm(self.end - self.begin, axis=1) + self.reach

    @cached_property
    def _long(self) -> Array:
        """Which segments (k,) are more than the centre of a disc."""
        return np.asarray((self.begin != self.end).any(axis=1))

    def near(self, place: Array, distance: float) -> Obstacles:
        """Return the segments of which some part is nearer than `distance` [m] to `place` (2,)."""
        if not len(self):
            return self
        return self._chosen(_to_segments(place[None], self.begin, self.end)[0] < distance + self.reach)

    def _chosen(self, kept: Array) -> Obstacles:
        if kept.all():
            return self
        return Obstacles(self.all, self.begin[kept], self.end[kept], self.reach[kept], self.owner[kept])

    def hit_by(self, begin: Array, end: Array) -> Array:
        """Return whether the segments from `begin` to `end` (n, 2) touch any obstacle (n,)."""
        if not len(self) or not len(begin):
            return np.zeros(len(begin), dtype=bool)
        middle, size = self._middle_and_size
        low, high = np.minimum(begin, end).min(axis=0), np.maximum(begin, end).max(axis=0)
        near = (middle + size[:, None] >= low).all(axis=1) & (middle - size[:, None] <= high).all(axis=1)
        if not near.any():
            return np.zeros(len(begin), dtype=bool)
        some = self._chosen(near)
        half = 0.5 * (end - begin)
        track, wall = some._pairs(begin + half, np.hypot(half[:, 0], half[:, 1]))
        hit = np.zeros(len(begin), dtype=bool)
        if len(track):
            gap = some._gaps(begin[track], end[track], wall)
            hit[track[gap <= some.reach[wall]]] = True
        return hit

    def hit_by_tracks(self, places: Array) -> Array:
        """Return whether tracks through `places` (s, 2, n) touch any obstacle (n,)."""
        if not len(self):
            return np.zeros(places.shape[2], dtype=bool)
        along = places.transpose(0, 2, 1)
        hit = self.hit_by(along[:-1].reshape(-1, 2), along[1:].reshape(-1, 2))
        return np.asarray(hit.reshape(-1, places.shape[2]).any(axis=0))

    def _gaps(self, begin: Array, end: Array, wall: Array) -> Array:
        """Return the distances (p,) [m] of segments `begin` to `end` (p, 2) from the own ones `wall` (p,), in pairs."""
        gap = _to_segment(self.begin[wall], begin, end)
        long = self._long[wall]
        if long.any():
            gap[long] = _between(begin[long], end[long], self.begin[wall[long]], self.end[wall[long]])
        return gap

    def _pairs(self, places: Array, distance: Array) -> tuple[Array, Array]:
        """Return indices (p,), (p,) of `places` (n, 2) and of the segments nearer to them than `distance` (n,) [m]."""
        if self._long.any():
            return np.nonzero(_to_segments(places, self.begin, self.end) - self.reach <= distance[:, None])  # type: ignore[return-value]
        x, y = places[:, None, 0] - self.begin[:, 0], places[:, None, 1] - self.begin[:, 1]
        return np.nonzero(x * x + y * y <= np.square(distance[:, None] + self.reach))  # type: ignore[return-value]

    def clearance(self, places: Array) -> Array:
        """Return how far `places` (n, 2) are from the nearest obstacle and its tolerance (n,) [m]; negative inside."""
        if not len(self):
            return np.full(len(places), np.inf)
        return (_to_segments(places, self.begin, self.end) - self.reach).min(axis=1)

    def at(self, place: Array) -> Obstacle | None:
        """Return an obstacle that `place` (2,) lies in, its tolerance included."""
        gap = _to_segments(np.asarray(place, dtype=float)[None], self.begin, self.end)[0] - self.reach
        inside = [o for o in self.all if o.kind == POLYGON and _within(place, np.asarray(o.points))]
        if inside:
            return inside[0]
        return self.all[int(self.owner[int(np.argmin(gap))])] if len(gap) and gap.min() <= 0.0 else None

    def first_hit(self, begin: Array, end: Array) -> Obstacle | None:
        """Return the obstacle that the first touching segment of `begin` to `end` (n, 2) comes nearest to."""
        hit = np.flatnonzero(self.hit_by(begin, end))
        if not len(hit):
            return None
        size = len(self)
        first, last = (np.repeat(part[hit[:1]], size, axis=0) for part in (begin, end))
        gap = _between(first, last, self.begin, self.end) - self.reach
        return self.all[int(self.owner[int(np.argmin(gap))])]


def _to_segments(places: Array, begin: Array, end: Array) -> Array:
    """Return the distances (n, k) of `places` (n, 2) from the segments `begin` to `end` (k, 2) [m]."""
    x, y = places[:, None, 0] - begin[:, 0], places[:, None, 1] - begin[:, 1]
    along = end - begin
    square = np.maximum(along[:, 0] ** 2 + along[:, 1] ** 2, 1e-18)
    share = (x * along[:, 0] + y * along[:, 1]) / square
    share = np.minimum(np.maximum(share, 0.0), 1.0)
    x -= share * along[:, 0]
    y -= share * along[:, 1]
    return np.sqrt(x * x + y * y)


def _between(begin: Array, end: Array, first: Array, second: Array) -> Array:
    """Return the distances (p,) [m] of segments `begin` to `end` (p, 2) from `first` to `second` (p, 2), in pairs."""
    ends = (
        _to_segment(first, begin, end),
        _to_segment(second, begin, end),
        _to_segment(begin, first, second),
        _to_segment(end, first, second),
    )
    across = _side(begin, end, first) * _side(begin, end, second) < 0.0
    across &= _side(first, second, begin) * _side(first, second, end) < 0.0
    return np.asarray(np.where(across, 0.0, np.minimum.reduce(ends)))


def _to_segment(place: Array, begin: Array, end: Array) -> Array:
    """Return the distances (p,) [m] of `place` (p, 2) from `begin` to `end` (p, 2), in pairs."""
    along, off = end - begin, place - begin
    square = np.maximum((along * along).sum(axis=1), 1e-18)
    share = np.minimum(np.maximum((off * along).sum(axis=1) / square, 0.0), 1.0)
    off = off - share[:, None] * along
    return np.asarray(np.hypot(off[:, 0], off[:, 1]))


def _side(begin: Array, end: Array, place: Array) -> Array:
    along, off = end - begin, place - begin
    return np.asarray(along[:, 0] * off[:, 1] - along[:, 1] * off[:, 0])


def _within(place: Array, corners: Array) -> bool:
    """Return whether `place` (2,) lies within the polygon of `corners` (k, 2), by the crossings of a ray."""
    x, y = float(place[0]), float(place[1])
    a, b = corners, np.roll(corners, -1, axis=0)
    spans = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return bool(np.count_nonzero(spans & (at > x)) % 2)
