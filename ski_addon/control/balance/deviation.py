"""Where the skier is, measured from the plan at his own progress, across the skis."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...gravity import STANDARD_GRAVITY
from ..dynamics import Dynamics
from ..motion import Motion
from .preview import LEAST_LOAD


@dataclass(frozen=True)
class Deviation:
    """The skier against the plan; lengths in m, positive to the left of the skis or up from the snow.

    `planned_y`, `planned_h`: the planned centre of mass over the skis, with rates `planned_y_rate`, `planned_h_rate`;
    `y`, `y_rate`: how far and fast [m/s] the centre of mass is left of it; `h`: its height over the snow and
    `h_rate`; `speed` [m/s] of the planned line along the skis and its acceleration `centripetal` [m/s^2] across them,
    `turning` [rad/s] of the planned skis; `pull` [1/s^2] N / h, which the pendulum's stiffness is without the turning.
    `sideways` [m/s^2] of the planned centre of mass at the present speed.
    """

    planned_y: float
    planned_h: float
    planned_y_rate: float
    planned_h_rate: float
    y: float
    y_rate: float
    h: float
    h_rate: float
    speed: float
    centripetal: float
    turning: float
    pull: float
    sideways: float


class DeviationGauge:
    """Measures `Deviation`."""

    def __init__(self, motion: Motion, dynamics: Dynamics) -> None:
        """Bind to the reference motion and the skier's dynamics."""
        self._motion, self._dynamics = motion, dynamics
        columns = motion.columns
        self._com, self._place, self._load = columns["com"], columns["track_position"], columns["load"]
        frame = ("along", "across", "normal")
        self._frame = slice(columns[frame[0]].start, columns[frame[-1]].stop)
        self._rows = np.zeros((7, 3))

    def measure(self) -> Deviation:
        """Return the deviation at the motion last read and the present state."""
        motion, dynamics, rows = self._motion, self._dynamics, self._rows
        value, velocity = motion.value, motion.velocity
        axes = value[self._frame].reshape(3, 3)
        np.subtract(value[self._com], value[self._place], out=rows[0])
        np.subtract(velocity[self._com], velocity[self._place], out=rows[1])
        np.subtract(dynamics.com, value[self._com], out=rows[2])
        np.subtract(dynamics.com_velocity, velocity[self._com], out=rows[3])
        rows[4] = velocity[self._place]
        rows[5], rows[6] = motion.acceleration[self._place], motion.acceleration[self._com]
        over, over_rate, off, off_rate, ride, bend, body = (rows @ axes.T).tolist()
        turning = float(velocity[self._frame][:3] @ axes[1])
        (_, y, h), (_, y_rate, h_rate) = over, over_rate
        pull = max(float(value[self._load][0]), LEAST_LOAD) * STANDARD_GRAVITY / max(h, 0.1)
        return Deviation(
            planned_y=y,
            planned_h=h,
            planned_y_rate=y_rate,
            planned_h_rate=h_rate,
            y=off[1],
            y_rate=off_rate[1],
            h=h + off[2],
            h_rate=h_rate + off_rate[2],
            speed=ride[0],
            centripetal=bend[1],
            turning=turning,
            pull=pull,
            sideways=body[1],
        )
