"""The track as it is passed in time: the ground's frame and forces under the skis, and the skis' own motion.

Skis follow the snow, however bumpy; the body over them keeps to the ground's smooth course: it does not nod with every
bump. So there are two frames, that of the skis and that of the body, which differ by the bumps' pitch and roll.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..course import Track
from ..frames import matrix_from_columns, normalized
from ..gravity import GRAVITY
from ..snow import Snow
from .ride import Ride

SMOOTH_LENGTH = 6.0
"""Standard deviation [m] of the window that smooths the ground: waves shorter than about three times this are bumps."""
NODDING = 0.3
"""Share of the bumps' pitch and roll that the body goes along with: ankles and hips give the rest."""
PLACES_PER_METRE = 10
"""Places for each metre of track at which the ground is smoothed."""


@dataclass(frozen=True)
class Line:
    """n places of a track, evenly in planned `time` (n,) [s].

    `arc_length` [m], `speed` [m/s] and `acceleration` [m/s^2] along the track, `steering` [rad] from track to skis,
    positive to the left, and its rate [rad/s]; `position` (n, 3) [m, world], `tangent`, `surface_normal` (n, 3),
    `curvature`, `normal_curvature`, `torsion` (n,) [1/m] as in `Track`; `phase`, `turn` (n,); gravity's parts (n,)
    along the track, to its left and into the snow and the air's `drag` against the motion [m/s^2].

    `body_frame` (n, 3, 3) has columns along and across the skis and up from the ground's smooth course; `spin` (n, 3)
    [rad/s] is its angular velocity and `pull` (n, 3) [m/s^2] gravity and drag less the acceleration of the skis, both
    in its own axes.
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
    body_frame: np.ndarray
    spin: np.ndarray
    pull: np.ndarray

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
        table = np.hstack((track.position, track.tangent, track.surface_normal, bends, body_normals(track)))
        self._spline = CubicSpline(track.arc_length, table)

    def line(self, ride: Ride, snow: Snow) -> Line:
        """Return the track as `ride` passes it."""
        track = self.track
        values = self._spline(np.clip(ride.arc_length, track.arc_length[0], track.arc_length[-1]))
        normal = normalized(values[:, 6:9])
        tangent = values[:, 3:6] - np.sum(values[:, 3:6] * normal, axis=1, keepdims=True) * normal
        tangent = normalized(tangent)
        left = np.cross(normal, tangent)
        moved = ride.acceleration[:, None] * tangent + (ride.speed**2)[:, None] * (
            values[:, 9:10] * left + values[:, 10:11] * normal
        )
        drag = snow.drag_factor * ride.speed**2
        frame = turned_frames(tangent, normalized(values[:, 12:15]), ride.steering)
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
            gravity_left=left @ GRAVITY,
            gravity_into=-(normal @ GRAVITY),
            drag=drag,
            body_frame=frame,
            spin=frame_spin(frame, ride.time),
            pull=np.einsum("nij,ni->nj", frame, GRAVITY - drag[:, None] * tangent - moved),
        )


def turned_frames(tangent: np.ndarray, up: np.ndarray, steering: np.ndarray) -> np.ndarray:
    """Return frames (n, 3, 3) whose columns are the direction that `steering` (n,) [rad] turns left from `tangent`
    (n, 3) about `up` (n, 3), the left of it, and `up`.
    """
    across = normalized(np.cross(up, tangent))
    ahead = np.cross(across, up)
    c, s = np.cos(steering)[:, None], np.sin(steering)[:, None]
    return matrix_from_columns(c * ahead + s * across, c * across - s * ahead, up)


def frame_spin(frame: np.ndarray, time: np.ndarray) -> np.ndarray:
    """Return the angular velocity (n, 3) [rad/s] of frames (n, 3, 3) in their own axes, by central differences."""
    rate = np.swapaxes(frame, -1, -2) @ np.gradient(frame, time, axis=0, edge_order=2)
    return 0.5 * (rate[:, (2, 0, 1), (1, 2, 0)] - rate[:, (1, 2, 0), (2, 0, 1)])


def body_normals(track: Track) -> np.ndarray:
    """Return the up axes (n, 3) of a body on the track: those of the smooth ground, and a little of its bumps."""
    smooth = smoothed_along(track, track.surface_normal)
    return normalized(smooth + NODDING * (track.surface_normal - smooth))


def smoothed_along(track: Track, values: np.ndarray) -> np.ndarray:
    """Return `values` (n, k) smoothed along the track over `SMOOTH_LENGTH`; beyond its ends they go on straight."""
    from scipy.ndimage import gaussian_filter1d

    count = max(int(np.ceil(track.length * PLACES_PER_METRE)), 2)
    arc = np.linspace(0.0, track.length, count + 1)
    margin = int(np.ceil(4.0 * SMOOTH_LENGTH * count / track.length))
    steps = np.arange(1, margin + 1)
    columns = []
    for column in np.asarray(values).T:
        path = np.interp(arc, track.arc_length, column)
        first, last = path[0] - (path[1] - path[0]) * steps[::-1], path[-1] + (path[-1] - path[-2]) * steps
        smooth = gaussian_filter1d(np.concatenate((first, path, last)), SMOOTH_LENGTH * count / track.length)
        columns.append(np.interp(track.arc_length, arc, smooth[margin:-margin]))
    return np.stack(columns, axis=1)
