"""The ground's frame and forces under a body that passes a track: what its lean has to answer."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..course import Track
from ..frames import matrix_from_columns, normalized
from ..gravity import GRAVITY
from ..planning.line import frame_spin
from .balance import LEAST_LOAD, balanced_lean
from .body import TurningBody


@dataclass(frozen=True)
class Way:
    """A track as it is passed at n moments, every `step` [s].

    `position`, `tangent`, `normal` (n, 3) of the snow, `up` (n, 3) of the smooth ground that the body keeps to, both
    unit vectors; `curvature`, `normal_curvature` (n,) [1/m] as in `Track`; `speed` (n,) of the support [m/s]. Without
    `up` the ground is a plane.
    """

    step: float
    speed: np.ndarray
    position: np.ndarray
    tangent: np.ndarray
    normal: np.ndarray
    curvature: np.ndarray
    normal_curvature: np.ndarray
    up: np.ndarray | None

    @classmethod
    def along(cls, track: Track, ups: np.ndarray | None, step: float, arc: np.ndarray, speed: np.ndarray) -> Way:
        """Return the way over the places `arc` (n,) [m] of `track`; `ups` (m, 3) are the smooth ground's up axes at the
        track's own places, or None on a plane.
        """

        def at(values: np.ndarray) -> np.ndarray:
            if values.ndim == 1:
                return np.interp(arc, track.arc_length, values)
            return np.stack([np.interp(arc, track.arc_length, column) for column in values.T], axis=1)

        tangent = normalized(at(track.tangent))
        normal = track.surface_normal[:1] + 0.0 * tangent if ups is None else normalized(at(track.surface_normal))
        bend = np.zeros_like(arc) if ups is None else at(track.normal_curvature)
        up = None if ups is None else normalized(at(ups))
        return cls(step, speed, at(track.position), tangent, normal, at(track.curvature), bend, up)

    def lean(self, body: TurningBody) -> Leaning:
        """Return the bounded lean of `body` on this way."""
        left = np.cross(self.normal, self.tangent)
        if self.up is None:
            pull_left = left @ GRAVITY - np.square(self.speed) * self.curvature
            into = -(self.normal @ GRAVITY)
            lean, rate = balanced_lean(body, self.step, pull_left, into, self.speed * self.curvature)
            return Leaning(lean, rate, lean, rate, pull_left, into)
        return self._over_bumps(body, left, self.up)

    def _over_bumps(self, body: TurningBody, left: np.ndarray, up: np.ndarray) -> Leaning:
        """Lean over the smooth ground: legs take up what single bumps do along its normal, not what they do aside."""
        across = normalized(np.cross(up, self.tangent))
        frame = matrix_from_columns(np.cross(across, up), across, up)
        roll, pitch, yaw = frame_spin(frame, self.step * np.arange(len(self.speed))).T
        bend = self.curvature[:, None] * left + self.normal_curvature[:, None] * self.normal
        pull_left = np.sum(across * (GRAVITY - np.square(self.speed)[:, None] * bend), axis=1)
        weight = -(up @ GRAVITY)
        into = np.maximum(weight - pitch * self.speed, LEAST_LOAD * weight)
        lean, rate = balanced_lean(body, self.step, pull_left, into, yaw, np.gradient(roll, self.step))
        leg = np.cos(lean)[:, None] * up + np.sin(lean)[:, None] * across
        from_snow = np.arctan2(np.sum(leg * left, axis=1), np.sum(leg * self.normal, axis=1))
        return Leaning(from_snow, np.gradient(from_snow, self.step), lean, rate, pull_left, into)


@dataclass(frozen=True)
class Leaning:
    """Lean (n,) [rad] from the snow's normal and its rate [rad/s]; the same from the smooth ground that the body keeps
    to, and gravity less the support's acceleration there, to the left and into the ground (n,) [m/s^2].
    """

    lean: np.ndarray
    lean_rate: np.ndarray
    body_lean: np.ndarray
    body_lean_rate: np.ndarray
    pull_left: np.ndarray
    pull_into: np.ndarray
