"""A turning motion looked up at any moment and at any place of its path, smoothly and for many at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...terrain import PlaneTerrain, Terrain
from ..motion import TurningMotion
from .vectors import Array, columns, cross, dot, unit

SMOOTH_LENGTH = 2.0
"""Standard deviation [m] of the window that smooths the ground under the body: it does not nod with every bump."""
STEP = 0.03
"""Half the way [m] over which the direction of a track is measured."""


@dataclass(frozen=True)
class Moments:
    """The motion at m moments `time` [s]; (m,) arrays as in `TurningMotion`, `phase` unwrapped.

    `place` (m, 3) of the support [m, world]; `body` (m, 3, 3) frame: x ahead, y left, z up from the ground's smooth
    course; `smooth` (m,) [m] is how far that course lies over the support.
    """

    time: Array
    distance: Array
    speed: Array
    lean: Array
    lean_rate: Array
    curvature: Array
    force: Array
    phase: Array
    place: Array
    body: Array
    smooth: Array


class Run:
    """A motion on its ground, to be looked up by time or by distance along the support's path."""

    def __init__(self, motion: TurningMotion, terrain: Terrain | None = None) -> None:
        """Prepare `motion`; without `terrain` its own path and normals are the ground."""
        self.motion, self.terrain = motion, terrain
        phase = np.unwrap(motion.phase)
        smooth_normal, smooth_rise = _smoothed(motion)
        listed = (motion.distance, motion.speed, motion.lean, motion.lean_rate, motion.curvature, motion.leg_force)
        self._table = np.column_stack((*listed, phase, smooth_rise, smooth_normal))
        self._slope = _slopes(self._table, motion.time)
        moving = np.concatenate(([True], np.diff(motion.distance) > 1e-9))
        self._s = motion.distance[moving]
        self._knots = motion.position[moving]
        self._tangents = motion.heading_direction[moving]
        self._normals = motion.surface_normal[moving]

    def at(self, time: Array) -> Moments:
        """Return the motion at `time` (m,) [s of the motion's clock]; times outside are held at its ends."""
        row = _hermite_even(self.motion.time, self._table, self._slope, time)
        place, tangent = self.path(row[:, 0])
        up = unit(row[:, 8:11])
        y = unit(cross(up, tangent))
        body = columns(cross(y, up), y, up)
        s, speed, lean, rate, curvature, force, phase, smooth = np.ascontiguousarray(row[:, :8].T)
        return Moments(time, s, speed, lean, rate, curvature, force, phase, place, body, smooth)

    def curvature(self, time: Array) -> Array:
        """Return the curvature (m,) [1/m] of the support's path at `time` (m,) [s]."""
        return np.interp(time, self.motion.time, self.motion.curvature)

    def path(self, distance: Array) -> tuple[Array, Array]:
        """Return place and direction (..., 3) of the support's path at `distance` (...) [m]; straight at its ends."""
        s, p, t = self._s, self._knots, self._tangents
        if len(s) < 2:
            return p[0] + (distance - s[0])[..., None] * t[0], np.broadcast_to(t[0], (*distance.shape, 3))
        held = np.clip(distance, s[0], s[-1])
        i = np.clip(np.searchsorted(s, held, side="right") - 1, 0, len(s) - 2)
        step = s[i + 1] - s[i]
        u = ((held - s[i]) / step)[..., None]
        step = step[..., None]
        chord, first, last = p[i + 1] - p[i], t[i], t[i + 1]
        a, b = step * first - chord, chord - step * last
        v = 1.0 - u
        place = p[i] + u * (chord + v * (v * a + u * b))
        direction = unit(chord + (v - u) * (v * a + u * b) + u * v * (b - a))
        return place + (distance - held)[..., None] * direction, direction

    def normal(self, place: Array, distance: Array) -> Array:
        """Return the ground's normal (..., 3) at `place` (..., 3), which is at `distance` (...) [m] of the path."""
        if self.terrain is not None:
            return self.terrain.normal(place[..., 0], place[..., 1])
        return self._path_normal(distance)

    def ground(self, distance: Array, across: Array | float = 0.0) -> Array:
        """Return places (..., 3) of the ground `across` [m] to the left of the path at `distance` (...) [m]."""
        place, direction = self.path(distance)
        if np.ndim(across) or across:
            place = place + np.asarray(across)[..., None] * unit(cross(self._path_normal(distance), direction))
        return self.on_ground(place)

    def on_ground(self, place: Array) -> Array:
        """Return `place` (..., 3) put vertically on the ground; as it is where no terrain is known."""
        if self.terrain is None:
            return place
        out = np.array(place)
        out[..., 2] = self.terrain.height(place[..., 0], place[..., 1])
        return out

    def _path_normal(self, distance: Array) -> Array:
        if len(self._s) < 2:
            return np.broadcast_to(self._normals[0], (*distance.shape, 3))
        i = np.clip(np.searchsorted(self._s, distance, side="right") - 1, 0, len(self._s) - 2)
        u = np.clip((distance - self._s[i]) / (self._s[i + 1] - self._s[i]), 0.0, 1.0)[..., None]
        return unit(self._normals[i] * (1.0 - u) + self._normals[i + 1] * u)


def uneven(run: Run) -> bool:
    """Return whether the ground is known and is no plane."""
    return run.terrain is not None and not isinstance(run.terrain, PlaneTerrain)


def traverse_lean(body: Array) -> Array:
    """Return the lean (m,) [rad] at which a body that goes straight on is balanced, for its frames (m, 3, 3)."""
    return np.arctan2(body[:, 2, 1], body[:, 2, 2])


def _slopes(table: Array, time: Array) -> Array:
    return np.zeros_like(table) if len(time) < 2 else np.gradient(table, time, axis=0)


def _hermite_even(time: Array, table: Array, slope: Array, query: Array) -> Array:
    """Interpolate rows of `table` (n, k) with their `slope`, at `query` (m,) among evenly spaced `time` (n,)."""
    if len(time) < 2:
        return np.repeat(table, len(query), axis=0)
    step = (time[-1] - time[0]) / (len(time) - 1)
    where = np.clip((query - time[0]) / step, 0.0, len(time) - 1.0)
    i = np.minimum(where.astype(int), len(time) - 2)
    u = (where - i)[:, None]
    v = 1.0 - u
    rise = table[i + 1] - table[i]
    return table[i] + u * (rise + v * (v * (step * slope[i] - rise) + u * (rise - step * slope[i + 1])))


def _smoothed(motion: TurningMotion) -> tuple[Array, Array]:
    """Return normals (n, 3) of the ground's smooth course and how far it lies over the support (n,) [m]."""
    normal, way = motion.surface_normal, float(motion.distance[-1] - motion.distance[0])
    if len(normal) < 3 or way < 1e-6 or float(np.ptp(normal, axis=0).max()) < 1e-6:
        return normal, np.zeros(len(normal))
    sigma = max(SMOOTH_LENGTH / way * (len(normal) - 1), 1e-3)
    half = min(int(np.ceil(3.0 * sigma)), len(normal) - 1)
    window = np.exp(-0.5 * np.square(np.arange(-half, half + 1) / sigma))
    window /= window.sum()
    mean = unit(normal.mean(axis=0))
    rise = dot(motion.position - motion.position[0], np.broadcast_to(mean, normal.shape))
    values = np.column_stack((normal, rise))
    before, after = 2 * values[0] - values[half:0:-1], 2 * values[-1] - values[-2 : -half - 2 : -1]
    padded = np.concatenate((before, values, after))
    smooth = np.stack([np.convolve(column, window, mode="valid") for column in padded.T], axis=1)
    return unit(smooth[:, :3]), smooth[:, 3] - rise
