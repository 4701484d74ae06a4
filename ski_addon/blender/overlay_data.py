"""What the overlay of the 3D view shows of a run at any time: lines and words, looked up from tables."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..animation.interpolation import bracket, linear
from ..animation.poses import EmptyRecordingError, body_poses_at
from ..body import build_skeleton
from ..frames import Array, normalized
from ..report.canvas import rgb
from ..report.series import body_weight
from ..report.style import LEFT, QUIET, RIGHT, THIRD
from ..terrain import build_terrain

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..spec import RunSpec

RATE = 120.0
"""Moments in a second that the tables hold, at least."""
ARROW_METRES = 1.0
"""Length of a force of one body weight [m]."""
_HEAD, _HEAD_LARGEST = 0.25, 0.18
_CROSS = 0.12
_AHEAD, _OUTWARD, _LIFT = 0.95, 0.1, 0.1
"""Where words stand, from the middle of a ski [m]: before its tip, clear of the body."""
LINES = (
    ("body", THIRD, 1),
    ("body on the snow", THIRD, 2),
    ("force left", LEFT, 3),
    ("force right", RIGHT, 3),
    ("planned body", QUIET, 3),
    ("planned height", QUIET, 1),
)
"""Name, colour and number of segments of what is drawn, in the order of the tables."""


def _rgba(color: str) -> Array:
    return np.append(rgb(color), 1.0)


SKI_COLORS = (_rgba(LEFT), _rgba(RIGHT))
"""Colours (4,) of the left and the right ski's words."""


@dataclass(frozen=True)
class Label:
    """Words at `place` (3,) [m, run frame] in `color` (4,) 0 to 1."""

    words: str
    place: Array
    color: Array


@dataclass(frozen=True)
class OverlayMoment:
    """What is drawn at one time: `segments` (k, 2, 3) [m, run frame], their `colors` (k, 4) 0 to 1, and `labels`."""

    segments: Array
    colors: Array
    labels: tuple[Label, ...]


@dataclass(frozen=True)
class OverlayData:
    """Tables of a run at m moments, evenly spaced, in the run frame.

    `time` (m,) [s] since the start of the recording, `segments` (m, k, 2, 3) [m] and their `colors` (k, 4), `edge`
    (m, 2) edge angles [degrees], left positive, and `label_place` (m, 2, 3) [m] where they are written, left before
    right.
    """

    time: Array
    segments: Array
    colors: Array
    edge: Array
    label_place: Array

    def at(self, time: float) -> OverlayMoment:
        """Return what is drawn `time` [s] after the start; before and after the run its first and last moment."""
        last, end = len(self.time) - 1, float(self.time[-1])
        place = last * min(time / end, 1.0) if time > 0.0 and end > 0.0 else 0.0
        low = min(int(place), max(last - 1, 0))
        high, share = min(low + 1, last), place - low
        edge = self._between(self.edge, low, high, share)
        places = self._between(self.label_place, low, high, share)
        labels = tuple(Label(f"{edge[ski]:+.0f}\N{DEGREE SIGN}", places[ski], SKI_COLORS[ski]) for ski in range(2))
        return OverlayMoment(self._between(self.segments, low, high, share), self.colors, labels)

    @staticmethod
    def _between(values: Array, low: int, high: int, share: float) -> Array:
        return values[low] + share * (values[high] - values[low])

    def named(self, name: str) -> slice:
        """Return which segments are those of `name` in `LINES`; raises `KeyError` for another name."""
        first = 0
        for known, _, count in LINES:
            if known == name:
                return slice(first, first + count)
            first += count
        raise KeyError(name)


def build_overlay(recording: Recording, spec: RunSpec) -> OverlayData:
    """Return the tables of `recording`, a run of `spec`.

    They hold the centre of mass with its foot on the snow straight below, the force of the snow on each ski as an arrow
    (one body weight is 1 m) from the ski's middle, where the plan has the centre of mass at the skier's progress and
    the track under it, and the edge angles. Raises `EmptyRecordingError` if nothing was recorded.
    """
    if not len(recording.time):
        raise EmptyRecordingError
    clock = np.asarray(recording.time, dtype=float) - float(recording.time[0])
    time = np.linspace(0.0, clock[-1], int(np.ceil(clock[-1] * RATE)) + 1)
    where = bracket(clock, time)
    skis = _ski_middles(recording, spec, time)
    normal = normalized(linear(recording.surface_normal, where))
    com, force = linear(recording.com, where), linear(recording.snow_force, where) / body_weight(recording)
    reference, track = linear(recording.com_reference, where), linear(recording.track_position, where)
    ground = np.column_stack((com[:, :2], build_terrain(spec.slope).height(com[:, 0], com[:, 1])))
    ahead = normalized(linear(recording.track_tangent, where))
    left = np.cross(normal, ahead)
    segments = np.concatenate(
        (
            np.stack((com, ground), axis=1)[:, None],
            _crosses(ground, (ahead, left)),
            _arrows(skis[:, 0], ARROW_METRES * force[:, 0], left),
            _arrows(skis[:, 1], ARROW_METRES * force[:, 1], left),
            _crosses(reference, (ahead, left, normal)),
            np.stack((reference, track), axis=1)[:, None],
        ),
        axis=1,
    )
    colors = np.concatenate([np.tile(_rgba(color), (count, 1)) for _, color, count in LINES])
    edge = np.degrees(linear(recording.edge_angle, where))
    outward = np.array([[1.0], [-1.0]]) * left[:, None]
    places = skis + _AHEAD * ahead[:, None] + _OUTWARD * outward + _LIFT * normal[:, None]
    return OverlayData(time, segments, colors, edge, places)


def _ski_middles(recording: Recording, spec: RunSpec, time: Array) -> Array:
    """Return the middle of each ski (m, 2, 3) at `time` (m,)."""
    poses = body_poses_at(recording, build_skeleton(spec.skier), time)
    return poses.position[:, [poses.body_names.index(name) for name in ("ski.L", "ski.R")]]


def _crosses(place: Array, axes: tuple[Array, ...]) -> Array:
    """Return small crosses (m, a, 2, 3) at `place` (m, 3), a line along each of a unit axes (m, 3)."""
    return np.stack([np.stack((place - _CROSS * axis, place + _CROSS * axis), axis=1) for axis in axes], axis=1)


def _arrows(place: Array, way: Array, beside: Array) -> Array:
    """Return arrows (m, 3, 2, 3) from `place` (m, 3) along `way` (m, 3): a shaft and the two sides of the head.

    The head spreads in the plane of `way` and `beside` (m, 3); it shrinks with a short arrow.
    """
    tip = place + way
    length = np.linalg.norm(way, axis=1, keepdims=True)
    along = way / np.maximum(length, 1e-9)
    across = beside - np.sum(beside * along, axis=1, keepdims=True) * along
    across /= np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-9)
    size = np.minimum(_HEAD * length, _HEAD_LARGEST)
    sides = [np.stack((tip, tip - size * (along + sign * 0.5 * across)), axis=1) for sign in (1.0, -1.0)]
    return np.stack((np.stack((place, tip), axis=1), *sides), axis=1)
