"""The track as it is passed in time: the ground's frame and forces under the skis, and the skis' own motion."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..course import Track
from ..frames import normalized
from ..gravity import GRAVITY
from ..snow import Snow
from .ride import Ride


@dataclass(frozen=True)
class Line:
    """n places of a track, evenly in planned `time` (n,) [s].

    `arc_length` [m], `speed` [m/s] and `acceleration` [m/s^2] along the track, `steering` [rad] from track to skis,
    positive to the left, and its rate [rad/s]; `position` (n, 3) [m, world], `tangent`, `surface_normal` (n, 3),
    `curvature`, `normal_curvature`, `torsion` (n,) [1/m] as in `Track`; `phase`, `turn` (n,); gravity's parts (n,)
    along the track, to its left and into the snow and the air's `drag` against the motion [m/s^2].
    """

    time: np.ndarray
    arc_length: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    steering: np.ndarray
    steering_rate: np.ndarray
    position: np.ndarray
    tangent: np.ndarray
    surface_normal: np.ndarray
    curvature: np.ndarray
    normal_curvature: np.ndarray
    torsion: np.ndarray
    phase: np.ndarray
    turn: np.ndarray
    gravity_along: np.ndarray
    gravity_left: np.ndarray
    gravity_into: np.ndarray
    drag: np.ndarray

    @property
    def left(self) -> np.ndarray:
        """Unit vectors (n, 3) to the left of the track within the surface."""
        return np.cross(self.surface_normal, self.tangent)


class TrackSpline:
    """A track as smooth functions of arc length."""

    def __init__(self, track: Track) -> None:
        """Fit cubic splines through the track's places."""
        from scipy.interpolate import CubicSpline

        self.track = track
        bends = np.stack((track.curvature, track.normal_curvature, track.torsion), axis=1)
        table = np.hstack((track.position, track.tangent, track.surface_normal, bends))
        self._spline = CubicSpline(track.arc_length, table)

    def line(self, ride: Ride, snow: Snow) -> Line:
        """Return the track as `ride` passes it."""
        track = self.track
        values = self._spline(np.clip(ride.arc_length, track.arc_length[0], track.arc_length[-1]))
        normal = normalized(values[:, 6:9])
        tangent = values[:, 3:6] - np.sum(values[:, 3:6] * normal, axis=1, keepdims=True) * normal
        tangent = normalized(tangent)
        label = np.clip(np.searchsorted(track.arc_length, ride.arc_length, side="right") - 1, 0, len(track.phase) - 1)
        return Line(
            time=ride.time,
            arc_length=ride.arc_length,
            speed=ride.speed,
            acceleration=ride.acceleration,
            steering=ride.steering,
            steering_rate=ride.steering_rate,
            position=values[:, :3],
            tangent=tangent,
            surface_normal=normal,
            curvature=values[:, 9],
            normal_curvature=values[:, 10],
            torsion=values[:, 11],
            phase=track.phase[label],
            turn=track.turn[label],
            gravity_along=tangent @ GRAVITY,
            gravity_left=np.cross(normal, tangent) @ GRAVITY,
            gravity_into=-(normal @ GRAVITY),
            drag=snow.drag_factor * ride.speed**2,
        )
