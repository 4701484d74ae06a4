"""The track: where the middle between the skis goes, by arc length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

LEFT, TRANSITION, RIGHT = 1, 0, -1
"""Phase labels of a track."""


@dataclass(frozen=True)
class Track:
    """Geometry of a run by arc length; read-only arrays.

    `arc_length` (n,) [m] rises strictly; `position` (n, 3) [m, world] lies on the snow, `tangent` and `surface_normal`
    (n, 3) are unit vectors, `curvature` (n,) [1/m] is within the surface, positive to the left; `normal_curvature`
    (n,) [1/m] is that of the ground under the track, positive in a hollow, and `torsion` (n,) [rad/m] how fast the
    ground's left side rises along it; `phase` (n,) int8 is +1 in a left turn, -1 in a right turn, 0 between; `turn`
    (n,) counts turns from 1 (a transition belongs to the turn it leaves); `start_speed` [m/s]; from
    `stop_from` [m] on the track runs straight down, so that the skier may stop.
    """

    arc_length: np.ndarray
    position: np.ndarray
    tangent: np.ndarray
    surface_normal: np.ndarray
    curvature: np.ndarray
    normal_curvature: np.ndarray
    torsion: np.ndarray
    phase: np.ndarray
    turn: np.ndarray
    start_speed: float
    stop_from: float = np.inf

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)

    @property
    def left(self) -> np.ndarray:
        """Unit vectors (n, 3) to the left within the surface."""
        return np.cross(self.surface_normal, self.tangent)

    @property
    def length(self) -> float:
        """Length of the track [m]."""
        return float(self.arc_length[-1])
