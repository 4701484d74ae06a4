"""How far a pushed skier left the plan, and when he was back on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..body import forward_kinematics
from ..body.skeleton import SIDES, Skeleton
from ..frames import continuous_quaternions, normalized
from ..planning import MotionPlan
from ..simulation import Recording
from .moments import HOLD

CORNER_MAX = 0.020
"""Baseline: error of every ski corner [m]."""
OFFSET_MAX = 0.050
"""Baseline: sideways distance of the skis and of the centre of mass from the plan [m]."""
PELVIS_MAX = np.deg2rad(5.0)
"""Baseline: rotation of the pelvis from the plan's [rad]."""


@dataclass(frozen=True)
class Deviation:
    """Distance from the original plan at the skier's own progress, over n steps.

    `corner` (n,) largest error of a ski corner [m]; `track_offset` (n,) of the middle between the skis from the track
    and `com_offset` (n,) of the centre of mass from the plan's, sideways, positive to the left [m]; `pelvis` (n,)
    angle of the pelvis from the plan's [rad].
    """

    corner: np.ndarray
    track_offset: np.ndarray
    com_offset: np.ndarray
    pelvis: np.ndarray

    @property
    def at_baseline(self) -> np.ndarray:
        """Whether the skier is where an undisturbed one would be, (n,) bool."""
        near = (np.abs(self.track_offset) < OFFSET_MAX) & (np.abs(self.com_offset) < OFFSET_MAX)
        return near & (self.corner < CORNER_MAX) & (self.pelvis < PELVIS_MAX)


def measure_deviation(recording: Recording, plan: MotionPlan, skeleton: Skeleton, first: int = 0) -> Deviation:
    """Return the deviation of the steps from `first` on.

    It is measured from the recorded poses against `plan` itself, so that a controller that moves its own reference to
    stay up is not taken to be on the track.
    """
    progress = recording.progress[first:]
    position, rotation = forward_kinematics(skeleton, recording.qpos[first:])
    left = _at(plan, progress, np.cross(plan.surface_normal, plan.tangent))
    skis = [skeleton.body(f"ski.{side}") for side in SIDES]
    middle = position[:, skis].mean(axis=1)
    planned_pelvis = normalized(_at(plan, progress, continuous_quaternions(plan.pose[:, None, 3:7])[:, 0]))
    cosine = np.abs(np.sum(planned_pelvis * recording.qpos[first:, 3:7], axis=1))
    return Deviation(
        corner=_corner_error(plan, progress, skeleton, position[:, skis], rotation[:, skis]),
        track_offset=np.sum((middle - _at(plan, progress, plan.position)) * left, axis=1),
        com_offset=np.sum((recording.com[first:] - _at(plan, progress, plan.com)) * left, axis=1),
        pelvis=2.0 * np.arccos(np.minimum(cosine, 1.0)),
    )


def recovery_time(time: np.ndarray, at_baseline: np.ndarray, since: float) -> float | None:
    """Return how long after `since` [s] the skier came to baseline and stayed there for `HOLD`; None if never.

    `time` (n,) [s] in equal steps, `at_baseline` (n,) bool.
    """
    if len(time) < 2:
        return None
    window = max(round(HOLD / float(time[1] - time[0])), 1)
    missed = np.concatenate(([0], np.cumsum(~at_baseline)))
    held = missed[window:] == missed[:-window]  # from step i on, for a whole window
    later = np.flatnonzero(held & (time[: len(held)] >= since - 1e-9))
    return max(float(time[later[0]]) - since, 0.0) if len(later) else None


def _corner_error(
    plan: MotionPlan, progress: np.ndarray, skeleton: Skeleton, position: np.ndarray, rotation: np.ndarray
) -> np.ndarray:
    """Return the largest error (n,) [m] of the corners of skis at `position` (n, 2, 3), `rotation` (n, 2, 3, 3)."""
    x, y = 0.5 * skeleton.ski_length, 0.5 * skeleton.ski_width
    corners = np.array([(sx * x, sy * y, 0.0) for sx in (1, -1) for sy in (1, -1)]).T
    planned = _at(plan, progress, plan.ski_position)[..., None] + _at(plan, progress, plan.ski_rotation) @ corners
    error = np.linalg.norm(position[..., None] + rotation @ corners - planned, axis=2)
    return error.max(axis=(1, 2))


def _at(plan: MotionPlan, progress: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return planned `values` (m, ...) at `progress` (n,) [s] into the plan, linear between its places."""
    flat = values.reshape(len(plan.time), -1)
    columns = [np.interp(progress, plan.time, column) for column in flat.T]
    return np.stack(columns, axis=1).reshape(len(progress), *values.shape[1:])
