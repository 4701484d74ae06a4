"""Where skis throw up snow, which way and how strongly, from a recording."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..frames import Array, continuous_quaternions, matrix_from_columns, normalized, quaternion_from_matrix
from ..gravity import STANDARD_GRAVITY
from .interpolation import Bracket, bracket, linear
from .poses import EmptyRecordingError, body_poses_at, frame_times

if TYPE_CHECKING:
    from ..body.skeleton import Skeleton
    from ..simulation.recording import Recording

CARVED = 0.1
"""A carving edge throws up as much as one that slips sideways at this share of the speed at which it cuts the snow."""
FULL = 2.0
"""Snow thrown by a body's weight that slips at this speed [m/s] is a strength of 63 %."""
SIDE_HELD = np.deg2rad(3.0)
"""Skis edged by less [rad] have no outside; the one of before keeps being it."""
_PER_FRAME = 4


@dataclass(frozen=True)
class SprayMotion:
    """An emitter at m keys: `frame` (m,), `position` (m, 3) [m, world], `quaternion` (m, 4), `strength` (m,) 0..1.

    It lies on the edge of the outside ski that holds: its x along the ski, its z where the snow flies, out of the turn
    and up. `strength` is 0 for skis that glide flat, stand still or fly.
    """

    frame: Array
    position: Array
    quaternion: Array
    strength: Array


def spray_motion(
    recording: Recording, skeleton: Skeleton, mass: float, fps: float, frame_start: float = 1
) -> SprayMotion:
    """Return where the skis of `recording` throw up snow, at the frames of a scene of `fps` [1/s].

    `mass` [kg] is the skier's. A key holds the mean over its frame, so that no short blow is lost between two. Raises
    `SpecError` for an impossible rate and `EmptyRecordingError` if nothing was recorded.
    """
    if len(recording.time) == 0:
        raise EmptyRecordingError
    frame, time = frame_times(float(recording.time[-1] - recording.time[0]), fps, 1, frame_start)
    strength = _mean_strength(recording, skeleton, mass, time, fps)
    place, ahead, left, normal, edge = _skis(recording, skeleton, time)
    side = _outside(edge.mean(axis=1))  # 1 in a left turn, where the right ski is outside and holds with its left edge
    ski, key = (side > 0.0).astype(int), np.arange(len(time))
    place, ahead, left = place[key, ski], ahead[key, ski], left[key, ski]
    position = place + 0.5 * skeleton.ski_width * side[:, None] * left
    out = normal - side[:, None] * np.cross(normal, ahead)
    z = normalized(out)
    turn = matrix_from_columns(ahead, np.cross(z, ahead), z)
    quaternion = continuous_quaternions(quaternion_from_matrix(turn))
    return SprayMotion(frame, position, quaternion, strength)


def _mean_strength(recording: Recording, skeleton: Skeleton, mass: float, time: Array, fps: float) -> Array:
    """Return the strength (m,) in the mean of the frame round each `time` (m,) [s], as far as it was recorded."""
    fine = ((np.arange(len(time) * _PER_FRAME) + 0.5) / _PER_FRAME - 0.5) / fps
    there = (fine >= 0.0) & (fine <= float(recording.time[-1] - recording.time[0]))
    if np.count_nonzero(there) < 2:
        return np.zeros(len(time))  # one moment does not tell what moves
    strength = np.zeros(len(fine))
    strength[there] = 1.0 - np.exp(-_thrown(recording, skeleton, mass, fine[there]) / FULL)
    count = there.reshape(len(time), -1).sum(axis=1)
    return strength.reshape(len(time), -1).sum(axis=1) / np.maximum(count, 1)


def _thrown(recording: Recording, skeleton: Skeleton, mass: float, time: Array) -> Array:
    """Return how fast both skis push snow aside (m,) [m/s], in body weights that press on them, at `time` (m,) [s]."""
    place, ahead, _, normal, edge = _skis(recording, skeleton, time)
    force = np.linalg.norm(linear(recording.snow_force, _when(recording, time)), axis=2)
    velocity = np.gradient(place, time, axis=0)
    aside = np.abs(np.sum(velocity * np.cross(normal[:, None], ahead), axis=2))
    along = np.abs(np.sum(velocity * ahead, axis=2))
    pushed = force / (mass * STANDARD_GRAVITY) * (aside + CARVED * along * np.abs(np.sin(edge)))
    return np.asarray(pushed.sum(axis=1))


def _when(recording: Recording, time: Array) -> Bracket:
    return bracket(np.asarray(recording.time, dtype=float) - recording.time[0], time)


def _skis(recording: Recording, skeleton: Skeleton, time: Array) -> tuple[Array, Array, Array, Array, Array]:
    """Return of both skis at `time` (m,): places, directions ahead in the surface and to the left (m, 2, 3).

    Then the surface's normals (m, 3) and the edge angles (m, 2) [rad].
    """
    poses = body_poses_at(recording, skeleton, time)
    skis = [skeleton.body(name) for name in ("ski.L", "ski.R")]
    matrix = poses.matrices()[:, skis]
    where = _when(recording, time)
    normal = normalized(linear(recording.surface_normal, where))
    ahead = matrix[..., :3, 0] - np.sum(matrix[..., :3, 0] * normal[:, None], axis=2, keepdims=True) * normal[:, None]
    return matrix[..., :3, 3], normalized(ahead), matrix[..., :3, 1], normal, linear(recording.edge_angle, where)


def _outside(edge: Array) -> Array:
    """Return 1 where skis of mean `edge` angle (m,) [rad] hold to the left, -1 to the right; flat ones as before."""
    side = np.where(np.abs(edge) > SIDE_HELD, np.sign(edge), 0.0)
    known = np.flatnonzero(side)
    if len(known) == 0:
        return np.ones(len(edge))
    last = np.maximum.accumulate(np.where(side != 0.0, np.arange(len(side)), known[0]))
    return np.asarray(side[last])
