"""What a turning body did: the input of every figure [VP93 Fig. 20]."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class TurningMotion:
    """Motion of one turning body on its ground; read-only arrays over n moments, evenly in time.

    `time` (n,) [s]; `position` (n, 3) of the support [m, world]; `heading_direction` (n, 3) unit vector along its
    path within the surface; `surface_normal` (n, 3); `distance` (n,) travelled by the support [m]; `speed` (n,) of the
    centre of mass [m/s]; `lean` (n,) [rad] from the surface normal, `lean_rate` (n,) [rad/s], `curvature` (n,) of the
    support's path [1/m], all positive to the left; `leg_force` (n,) in units of the body's weight; `phase` (n,) [rad]
    in [0, 2 pi): 0 where the body comes upright on its way to the left, pi where it does so to the right.
    """

    time: np.ndarray
    position: np.ndarray
    heading_direction: np.ndarray
    surface_normal: np.ndarray
    distance: np.ndarray
    speed: np.ndarray
    lean: np.ndarray
    lean_rate: np.ndarray
    curvature: np.ndarray
    leg_force: np.ndarray
    phase: np.ndarray

    def __post_init__(self) -> None:
        for value in vars(self).values():
            value.setflags(write=False)

    @property
    def duration(self) -> float:
        """Time from the first moment to the last [s]."""
        return float(self.time[-1] - self.time[0])
