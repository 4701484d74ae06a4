"""Gate courses [SG19 sec. 4.5]: a line past all poles, and where the poles stand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..spec import RunSpec
from ..spec.gate_defaults import MARGIN
from ..terrain import Terrain
from .fair_line import FairLine, Poles, fair_line, turning_curvature
from .gate_checks import check_line, check_places
from .gate_settings import run_in_of, set_poles
from .labels import label_turns
from .surface import track_on_surface
from .track import Track

SPACING = 0.08
"""Distance between neighbouring places of the plan-view line [m]."""
LEAST_BEND = 0.005
"""Slighter bends [1/m] are no turns."""


@dataclass(frozen=True)
class Gates:
    """The gates of a course in the order they are passed; read-only arrays.

    `position` (n, 3) [m, world] of the foot of each turning pole, `side` (n,) int8 +1 passed turning left (the pole
    stands to the left of the skis) or -1, `distance` (n,) [m] asked from pole to the middle between the skis.
    """

    position: np.ndarray
    side: np.ndarray
    distance: np.ndarray

    def __post_init__(self) -> None:
        for value in vars(self).values():
            value.setflags(write=False)

    def __len__(self) -> int:
        return len(self.side)

    def lists(self) -> dict[str, list[Any]]:
        """Return the gates as lists of plain numbers, to be written as JSON."""
        return {name: value.tolist() for name, value in vars(self).items()}

    @classmethod
    def from_lists(cls, lists: Mapping[str, list[Any]]) -> Gates:
        """Return the gates of what `lists` gave; no gates if there is nothing in it."""
        return cls(
            np.array(lists.get("position", []), dtype=float).reshape(-1, 3),
            np.array(lists.get("side", []), dtype=np.int8),
            np.array(lists.get("distance", []), dtype=float),
        )

    def apexes(self, track: Track) -> np.ndarray:
        """Return the indices (n,) of the places of `track` that are nearest to each pole, seen from above."""
        offset = track.position[None, :, :2] - self.position[:, None, :2]
        return np.argmin(np.linalg.norm(offset, axis=2), axis=1)


def course_gates(spec: RunSpec, terrain: Terrain) -> Gates | None:
    """Return the gates of `spec.course` as they stand on `terrain`, or None for a course without gates."""
    if spec.course.kind != "gates":
        return None
    poles = set_poles(spec)
    x, y = poles.down * np.cos(terrain.mean_angle), poles.left
    position = np.stack((x, y, terrain.height(x, y)), axis=1)
    return Gates(position, poles.side.astype(np.int8), poles.distance.copy())


def build_gate_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return the track past the gates of `spec.course`, down the fall line before the first and after the last.

    Raises `SpecError` naming the gate that cannot be passed, why, and what could.
    """
    poles = set_poles(spec)
    check_places(spec, poles, terrain)
    line = gate_line(spec, poles)
    check_line(spec, poles, line)
    down, left, _ = line.sampled(SPACING)
    curvature = turning_curvature(poles, line, down)
    start = poles.down[0] - run_in_of(spec.course, poles.down)
    ahead = np.arange(down[0] - SPACING, start, -SPACING)[::-1]
    curvature = np.concatenate((np.zeros(len(ahead)), curvature))
    phase, turn = label_turns(curvature, LEAST_BEND)
    down, left = np.concatenate((ahead, down)), np.concatenate((np.full(len(ahead), left[0]), left))
    return track_on_surface(terrain, down, left, phase, turn, spec.course.start_speed)


def gate_line(spec: RunSpec, poles: Poles, tolerance: float = 1e-7, like: FairLine | None = None) -> FairLine:
    """Return the smoothest line past `poles`, which begins to bend at most a little more than a spacing before them.

    `tolerance` and a line past nearly the same poles, `like`, as for `fair_line`.
    """
    run_in = run_in_of(spec.course, poles.down)
    gaps = np.diff(poles.down) if len(poles) > 1 else np.array([run_in])
    return fair_line(poles, min(run_in, MARGIN * float(gaps[0])), MARGIN * float(gaps[-1]), tolerance, like)
