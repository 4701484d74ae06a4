"""The numbers behind the plots: forces in body weights and along the slope's axes, phase bands, torques by joint."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from ..simulation import Recording

Array = np.ndarray

JOINT_GROUPS = {
    "hip": "thigh",
    "knee": "shank",
    "ankle": "foot",
    "lower back": "abdomen",
    "upper back": "chest",
    "neck": "head",
    "shoulder": "upper_arm",
    "elbow": "forearm",
    "wrist": "hand",
}
"""Name of a joint as people say it -> body that its hinges move."""


class Band(NamedTuple):
    """A stretch of the run in one phase: `phase` +1 left turn, 0 transition, -1 right turn; times in s."""

    phase: int
    start: float
    end: float


class ForceSplit(NamedTuple):
    """Resultant snow force [body weights]: along the surface normal (n,), and to the left of the track (n,)."""

    normal: Array
    left: Array


class TorqueSeries(NamedTuple):
    """Torque of one joint over its human limit (n,), the larger of both sides and all axes, and its peak's hinge."""

    name: str
    ratio: Array
    peak: float
    peak_hinge: str


def body_weight(recording: Recording) -> float:
    """Return the weight of the skier with equipment [N], the unit of all forces in a report."""
    return float(recording.header["mass"]) * float(np.linalg.norm(recording.header["gravity"]))


def ski_forces(recording: Recording) -> Array:
    """Return the size of the snow force on each ski [body weights] (n, 2), left before right."""
    return np.linalg.norm(recording.snow_force, axis=2) / body_weight(recording)


def force_split(recording: Recording) -> ForceSplit:
    """Return the resultant snow force along the surface normal and to the left of the track, as [SG19 Fig. 15]."""
    total = recording.snow_force.sum(axis=1) / body_weight(recording)  # (n, 3)
    left = np.cross(recording.surface_normal, recording.track_tangent)
    return ForceSplit(np.sum(total * recording.surface_normal, axis=1), np.sum(total * left, axis=1))


def body_height(recording: Recording) -> Array:
    """Return how high the centre of mass is over the snow along its normal (n,) [m]."""
    over = recording.com - recording.track_position
    return np.sum(over * recording.surface_normal, axis=1)


def bump_height(recording: Recording) -> Array:
    """Return how high the snow under the skis is over a straight slope, from the run's start to its end (n,) [m]."""
    level = np.mean(recording.surface_normal, axis=0)
    height = recording.track_position @ (level / np.linalg.norm(level))
    return height - np.interp(recording.arc_length, recording.arc_length[[0, -1]], height[[0, -1]])


def phase_bands(time: Array, phase: Array) -> list[Band]:
    """Return the stretches of equal phase, in order; each ends where the next starts."""
    if not len(time):
        return []
    starts = np.concatenate(([0], np.flatnonzero(np.diff(phase)) + 1))
    ends = np.concatenate((starts[1:], [len(time) - 1]))
    return [Band(int(phase[i]), float(time[i]), float(time[j])) for i, j in zip(starts, ends, strict=True)]


def torque_by_joint(recording: Recording) -> list[TorqueSeries]:
    """Return the torque ratios joined by joint, hardest first (both sides, all axes)."""
    hinges = recording.header["actuated_joint_names"]
    out = []
    for name, body in JOINT_GROUPS.items():
        columns = [i for i, hinge in enumerate(hinges) if hinge.partition(".")[0].rpartition("_")[0] == body]
        if columns and len(recording.time):
            ratios = np.abs(recording.torque_ratio[:, columns])
            hardest = int(ratios.max(axis=0).argmax())
            out.append(TorqueSeries(name, ratios.max(axis=1), float(ratios.max()), hinges[columns[hardest]]))
    return sorted(out, key=lambda series: -series.peak)


def thinned(time: Array, values: Array, most: int = 4000) -> tuple[Array, Array]:
    """Return a curve of at most `most` points that keeps its peaks: of each block, the value of largest size."""
    block = -(-len(time) // most)
    if block <= 1:
        return time, values
    count = len(time) // block
    blocks = values[: count * block].reshape(count, block)
    peak = np.abs(blocks).argmax(axis=1)
    return time[: count * block].reshape(count, block)[np.arange(count), peak], blocks[np.arange(count), peak]
