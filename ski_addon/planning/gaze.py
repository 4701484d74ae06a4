"""Where a skier looks: along the line ahead, with the horizon level as far as a neck can.

A skier's eyes lead. They rest on the place where the skis will be in a while; the head turns there in an even motion,
whatever the body under it does, and tips less than the trunk, up to what is comfortable.
"""

from __future__ import annotations

import numpy as np

from ..body import Skeleton
from ..body.kinematics import body_frames
from ..frames import components, matrix_from_columns, normalized
from .line import Line

EYES_OVER_SNOW = 0.5
"""Height [statures] over the snow of what is looked at."""
CALM = 0.25
"""Standard deviation [s] of the window over which the gaze is even: eyes follow quicker than a head."""
COMFORTABLE = {"head_y": np.deg2rad(58.0), "head_x": np.deg2rad(28.0), "head_z": np.deg2rad(60.0)}
"""How far a neck turns at most, in either direction; it is approached smoothly."""
LEAST_AHEAD = 3.0
"""Distance [m] that is looked ahead at least, however slow."""


def gaze_directions(line: Line, com: np.ndarray, stature: float, look_ahead: float) -> np.ndarray:
    """Return unit vectors (n, 3) from the eyes to where `line` passes in `look_ahead` [s]; world.

    `com` (n, 3) [m] is the centre of mass, over which the eyes are. Beyond its end the line goes on straight.
    """
    ahead = np.maximum(np.interp(line.time + look_ahead, line.time, line.arc_length), line.arc_length + LEAST_AHEAD)
    beyond = np.maximum(line.arc_length + look_ahead * line.speed - line.arc_length[-1], ahead - line.arc_length[-1])
    place = np.stack([np.interp(ahead, line.arc_length, column) for column in line.position.T], axis=1)
    place += np.maximum(beyond, 0.0)[:, None] * line.tangent[-1]
    place[:, 2] += EYES_OVER_SNOW * stature
    eyes = com + np.array([0.0, 0.0, 0.35 * stature])
    return normalized(_calm(normalized(place - eyes), line.time))


def turn_head(skeleton: Skeleton, qpos: np.ndarray, gaze: np.ndarray) -> None:
    """Set the head's three hinges of `qpos` (n, nq) in place so that it faces `gaze` (n, 3), upright in the world."""
    chest = skeleton.body("chest")
    frames = body_frames(skeleton, qpos, range(chest + 1))
    trunk = np.stack([axis.T for axis in frames[chest][1]], axis=-1)
    left = normalized(np.cross([0.0, 0.0, 1.0], gaze))
    wanted = np.swapaxes(trunk, -1, -2) @ matrix_from_columns(gaze, left, np.cross(gaze, left))
    # the neck's hinges are, from the chest outwards, about y, x and z: wanted = Ry(a) Rx(b) Rz(c)
    _, _, xz, yx, yy, yz, _, _, zz = components(wanted.reshape(-1, 9))
    angles = {
        "head_y": np.arctan2(xz, zz),
        "head_x": np.arcsin(np.clip(-yz, -1.0, 1.0)),
        "head_z": np.arctan2(yx, yy),
    }
    for hinge, angle in angles.items():
        most = COMFORTABLE[hinge]
        qpos[:, skeleton.qpos_of(hinge)] = angle / (1.0 + (angle / most) ** 4) ** 0.25


def _calm(values: np.ndarray, time: np.ndarray) -> np.ndarray:
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(values, CALM / float(time[1] - time[0]), axis=0, mode="nearest"))
