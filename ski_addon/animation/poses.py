"""A recording resampled to scene frames: the world pose of every body, and numbers to see or drive with."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from ..body.kinematics import forward_kinematics
from ..errors import SkiAddonError, SpecError
from ..frames import Array, matrix_from_quaternion, quaternion_from_matrix, quaternion_multiply
from .interpolation import Bracket, bracket, linear, slerp
from .span import FrameSpan

if TYPE_CHECKING:
    from ..body.skeleton import Skeleton
    from ..simulation.recording import Recording


class EmptyRecordingError(SkiAddonError):
    """The recording has no step, so that there is nothing to show."""

    exit_code = 3

    def __init__(self) -> None:
        super().__init__("the recording is empty: the run ended before its first step; simulate again")


@dataclass(frozen=True)
class BodyPoses:
    """World pose of every body at every key. Frames are scene frames and may be fractional.

    `frame` (m,), `time` (m,) [s] since the start of the recording, `position` (m, b, 3) [m] and `quaternion`
    (m, b, 4) (w, x, y, z) of each body's frame in the world, `body_names` (b,).
    """

    frame: Array
    time: Array
    position: Array
    quaternion: Array
    body_names: tuple[str, ...]

    def matrices(self) -> Array:
        """Return `world_from_body` (m, b, 4, 4)."""
        out = np.zeros((*self.position.shape[:2], 4, 4))
        out[..., :3, :3] = matrix_from_quaternion(self.quaternion)
        out[..., :3, 3] = self.position
        out[..., 3, 3] = 1.0
        return out

    def within(self, span: FrameSpan) -> BodyPoses:
        """Return the poses of the frames in `span`."""
        kept = span.within(self.frame)
        if kept.all():
            return self
        return BodyPoses(self.frame[kept], self.time[kept], self.position[kept], self.quaternion[kept], self.body_names)

    def moved(self, matrix: Array | None) -> BodyPoses:
        """Return the poses moved by `matrix` (4, 4), a turn and a shift; None moves nothing."""
        if matrix is None:
            return self
        turn = quaternion_from_matrix(matrix[:3, :3])
        position = self.position @ matrix[:3, :3].T + matrix[:3, 3]
        return replace(self, position=position, quaternion=quaternion_multiply(turn, self.quaternion))


def frame_times(duration: float, fps: float, subframes: int = 1, frame_start: float = 1) -> tuple[Array, Array]:
    """Return the frames (m,) that carry a key and their times (m,) [s], for `duration` [s] at `fps` [1/s].

    Frame f shows time (f - frame_start) / fps; `subframes` keys lie on each frame, evenly spaced. The last key is the
    last one that is not later than the end of the recording.
    """
    if not (np.isfinite(fps) and fps > 0):
        raise SpecError("bake.fps", fps, "1..240 1/s", "set the scene's frame rate")
    if subframes < 1:
        raise SpecError("bake.subframes", subframes, "1..8 per frame", "use 1 for one key on every frame")
    count = int(np.floor(duration * fps * subframes + 1e-6)) + 1
    step = np.arange(count) / subframes
    return frame_start + step, step / fps


def sample_body_poses(
    recording: Recording, skeleton: Skeleton, fps: float, subframes: int = 1, frame_start: float = 1
) -> BodyPoses:
    """Return the world pose of every body of `recording` at the scene frames of a scene of `fps` [1/s].

    Raises `SpecError` for an impossible rate and `EmptyRecordingError` if nothing was recorded.
    """
    if len(recording.time) == 0:
        raise EmptyRecordingError
    frame, time = frame_times(float(recording.time[-1] - recording.time[0]), fps, subframes, frame_start)
    return body_poses_at(recording, skeleton, time, frame)


def body_poses_at(recording: Recording, skeleton: Skeleton, time: Array, frame: Array | None = None) -> BodyPoses:
    """Return the world pose of every body at `time` (m,) [s] since the start of `recording`.

    Positions are linear and rotations slerped between the two recorded states around each time.
    """
    where = bracket(np.asarray(recording.time, dtype=float) - recording.time[0], time)
    places, rotations = forward_kinematics(skeleton, recording.qpos[np.concatenate((where.low, where.high))])
    low, high = slice(0, len(where.low)), slice(len(where.low), None)
    share, turns = where.share[:, None], quaternion_from_matrix(rotations)
    position = places[low] * (1.0 - share[..., None]) + places[high] * share[..., None]
    quaternion = slerp(turns[low], turns[high], np.broadcast_to(share, position.shape[:2]))
    frame = np.arange(len(time), dtype=float) if frame is None else frame
    return BodyPoses(frame, np.asarray(time, dtype=float), position, quaternion, tuple(skeleton.body_names))


@dataclass(frozen=True)
class Channel:
    """One animated number: its property `name`, what it means, its `unit` as shown, and `values` (m,) per key."""

    name: str
    doc: str
    unit: str
    values: Array


def sample_channels(recording: Recording, time: Array) -> tuple[Channel, ...]:
    """Return the numbers of `recording` an animator may want to see or drive with, at `time` (m,) [s].

    Angles are in degrees, forces in newtons, left before right; `turn_phase` runs from -1 (right) to 1 (left).
    """
    where = bracket(np.asarray(recording.time) - recording.time[0], time)
    force = np.linalg.norm(recording.snow_force, axis=-1)  # (n, 2)
    edge = np.degrees(recording.edge_angle)
    rows = (
        ("speed", "Speed of the skier", "m/s", recording.speed),
        ("inclination", "Lean of the skier, positive to the left", "deg", np.degrees(recording.inclination)),
        ("edge_angle_left", "Edge angle of the left ski, positive to the left", "deg", edge[:, 0]),
        ("edge_angle_right", "Edge angle of the right ski, positive to the left", "deg", edge[:, 1]),
        ("snow_force_left", "Force of the snow on the left ski", "N", force[:, 0]),
        ("snow_force_right", "Force of the snow on the right ski", "N", force[:, 1]),
        ("turn_phase", "Where in the turn: 1 = full left turn, -1 = full right turn", "", recording.turn_phase),
    )
    return tuple(_channel(name, doc, unit, values, where) for name, doc, unit, values in rows)


def _channel(name: str, doc: str, unit: str, values: Array, where: Bracket) -> Channel:
    return Channel(name, doc, unit, linear(values, where))
