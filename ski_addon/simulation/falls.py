"""Recognising a fall: what went wrong, where, and why."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

import numpy as np

from ..control import Command, Dynamics
from ..planning import Reference
from ..terrain import Terrain

TIPPED_COSINE = 0.2
"""The pelvis has tipped over when its up axis and the snow's normal have a cosine below this."""
LOWEST_HEAD = 0.23
"""Height of the neck over the snow, in units of stature, below which the skier lies."""
LOWEST_COM = 0.18
"""Height of the centre of mass over the snow, in units of stature, below which the skier sits."""
SKI_LEFT_TRACK = 0.4
"""Error of a ski corner [m], from where it is steered, beyond which a ski has left its track."""
FARTHEST_OFF = 6.0
"""Distance of the skis from the track [m] beyond which a skier who steered to stay up is lost."""
TELLING_TIME = 0.03
"""A hinge at its torque limit for this long [s] before a fall is named as its reason."""
STALLED, GLIDING = 0.02, 0.5
"""Progressing slower than the first, of what is planned, where more than the second [m/s] is planned, is a stop."""


@dataclass(frozen=True)
class Fall:
    """Why a run ended: `status` "fell" or "diverged", `time` [s], `what` failed, `where` [m along the track], `why`."""

    status: str
    time: float
    what: str
    where: float
    why: str

    def detail(self) -> dict[str, float | str]:
        """Return the fall without its status, for a recording's header."""
        values = asdict(self)
        values.pop("status")
        return values


class FallWatch:
    """Watches a run for a fall and remembers what the muscles and the solver did before it."""

    STATE = ("_saturated_since", "_saturated_hinge")

    def __init__(self, dynamics: Dynamics, reference: Reference, terrain: Terrain, *, on_track: bool = True) -> None:
        """Watch the skier of `dynamics`, who follows `reference` on `terrain` and, if `on_track`, must keep to it."""
        self._speed = reference.columns["speed"]
        self._dynamics, self._terrain, self._on_track = dynamics, terrain, on_track
        skeleton = dynamics.model.skeleton
        self._height = skeleton.height
        self._head = skeleton.body("head") + 1
        self._hinges = [skeleton.joint_names[i] for i in skeleton.actuated]
        self._saturated_since: float | None = None
        self._saturated_hinge = ""

    def note_torques(self, time: float, ratio: np.ndarray) -> None:
        """Remember since when a hinge has been at its torque limit; `ratio` (31,) is of the limit."""
        strongest = int(np.argmax(ratio))
        if ratio[strongest] < 0.999:
            self._saturated_since = None
        elif self._saturated_since is None:
            self._saturated_since, self._saturated_hinge = time, self._hinges[strongest]

    def check(
        self, time: float, progress: float, command: Command, ski_error: float, track_offset: float
    ) -> Fall | None:
        """Return the fall that has happened at this state, or None.

        `ski_error` [m] is the largest one of a ski corner from where it is steered, `track_offset` [m] the distance of
        the skis from the track.
        """
        dynamics = self._dynamics
        normal = self._terrain.normal(dynamics.com[0], dynamics.com[1])
        what = self._what(normal, ski_error, track_offset)
        if what is not None:
            return Fall("fell", time, what, progress, self._why(time, command))
        if command.rate < STALLED and float(command.sample[0, self._speed][0]) > GLIDING:
            why = "friction and slope no longer carry it forward"
            return Fall("fell", time, "the skier came to a stop", progress, why)
        if command.effort.solution.status != 0:
            return Fall("fell", time, "the skier lost control", progress, self._why(time, command))
        return None

    def divergence(self, time: float, progress: float) -> Fall | None:
        """Return the end of a run whose state is no longer made of finite numbers, or None."""
        dynamics = self._dynamics
        if math.isfinite(float(dynamics.qpos.sum()) + float(dynamics.qvel.sum())):
            return None
        return Fall("diverged", time, "the state is no longer a number", progress, "the step before it went too far")

    def _what(self, normal: np.ndarray, ski_error: float, track_offset: float) -> str | None:
        dynamics, height = self._dynamics, self._height
        head = self._above_snow(dynamics.body_position(self._head), normal)
        com = self._above_snow(dynamics.com, normal)
        if float(dynamics.root_rotation[:, 2] @ normal) < TIPPED_COSINE:
            return "the pelvis tipped over"
        if head < LOWEST_HEAD * height:
            return f"the head came down to {head:.2f} m over the snow"
        if com < LOWEST_COM * height:
            return f"the body came down to {com:.2f} m over the snow"
        if self._on_track and ski_error > SKI_LEFT_TRACK:
            return f"a ski left its track by {ski_error:.2f} m"
        if self._on_track and abs(track_offset) > FARTHEST_OFF:
            return f"the skis were steered {abs(track_offset):.1f} m off the track"
        return None

    def _above_snow(self, point: np.ndarray, normal: np.ndarray) -> float:
        return float((point[2] - self._terrain.height(point[0], point[1])) * normal[2])

    def _why(self, time: float, command: Command) -> str:
        held = 0.0 if self._saturated_since is None else time - self._saturated_since
        if held >= TELLING_TIME:
            return f"{self._saturated_hinge} had been at its torque limit for {held:.2f} s"
        if command.effort.solution.status != 0:
            return "no torques and snow forces were found that follow the plan"
        return "the centre of mass left the range the skis can support"
