"""Tasks: what each part of the body should accelerate like to follow the reference [SG19 Eq. 32-42].

Desired accelerations are proportional-derivative laws on errors plus the reference's own acceleration. The reference
is looked up at the skier's progress sigma, the planned time whose place is reached: with derivatives ' by planned time,
velocity is X' sigma. and acceleration X'' sigma.^2; sigma. is 1 for a skier who is as fast as planned.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..planning import Reference
from .dynamics import Dynamics
from .gains import Gains
from .motion import Motion
from .slide import share_of_sliding

PROGRESS_PULL = 10.0
"""Rate [1/s] at which progress is drawn to where the centre of mass is."""
CREEP = 0.3
"""Planned speed along the skis [m/s] about and below which progress is kept by the clock."""
FASTEST_RATE = 3.0
"""Most planned seconds that may pass in a second."""


@dataclass
class Desired:
    """Desired accelerations and the errors behind them, overwritten each step.

    `ski` (2, 6): linear [m/s^2, world] and angular [rad/s^2] in the ski's own axes; `ski_axes` (2, 3, 3) those axes in
    the world; `com` (2,) across the skis and along the normal, `com_axes` (2, 3); `pelvis` (3,) [rad/s^2] in the
    pelvis's axes; `joints` (31,); `angular_momentum_rate` (3,) [N m]; `ski_offset` (2, 3) position errors [m] and
    `ski_turn` (2, 3) rotation errors [rad, world]; `com_offset` (3,) [m].
    """

    ski: np.ndarray = field(default_factory=lambda: np.zeros((2, 6)))
    ski_axes: np.ndarray = field(default_factory=lambda: np.zeros((2, 3, 3)))
    com: np.ndarray = field(default_factory=lambda: np.zeros(2))
    com_axes: np.ndarray = field(default_factory=lambda: np.zeros((2, 3)))
    pelvis: np.ndarray = field(default_factory=lambda: np.zeros(3))
    joints: np.ndarray = field(default_factory=lambda: np.zeros(31))
    angular_momentum_rate: np.ndarray = field(default_factory=lambda: np.zeros(3))
    ski_offset: np.ndarray = field(default_factory=lambda: np.zeros((2, 3)))
    ski_turn: np.ndarray = field(default_factory=lambda: np.zeros((2, 3)))
    com_offset: np.ndarray = field(default_factory=lambda: np.zeros(3))


def progress_rate(reference: Reference, sample: np.ndarray, dynamics: Dynamics) -> float:
    """Return sigma., the planned seconds that pass in a second.

    A reference by the clock cannot be followed, for nothing drives a skier along the skis but gravity: place and speed
    along them are the skier's own. Where the plan hardly moves along the skis, standing or braking across the slope,
    there is nothing to be late for, and the clock rules. `sample` is the reference at the present progress.
    """
    columns = reference.columns
    along = sample[0, columns["along"]]
    off = dynamics.com - sample[0, columns["com"]]
    behind = float(along @ off)
    speed = float(along @ dynamics.com_velocity) + PROGRESS_PULL * behind
    # whoever is off to the inside of a turn passes the plan's places sooner
    planned = float(along @ sample[1, columns["com"]]) - float(off @ sample[1, columns["along"]])
    own = 1.0 - share_of_sliding(float(along @ sample[0, columns["tangent"]]))
    rate = 1.0 + own * (speed - planned) * planned / (planned * planned + CREEP * CREEP)
    return min(max(rate, 0.0), FASTEST_RATE)


class TaskSet:
    """Evaluates `Desired` for a reference and gains."""

    def __init__(self, reference: Reference, gains: Gains, dynamics: Dynamics) -> None:
        """Bind to the reference's columns and the dynamics whose state is tracked."""
        self.reference, self.gains, self.dynamics = reference, gains, dynamics
        self.desired = Desired()
        self.motion = Motion(reference)
        self._columns = reference.columns
        self._joint_address = dynamics.model.actuated_qpos
        self._reference_velocity = np.zeros(len(dynamics.model.body_dof))

    def update(self, sample: np.ndarray, rate: float) -> Desired:
        """Return the desired accelerations at reference `sample` (3, width) and progress `rate`."""
        return self.follow(self.motion.read(sample, rate))

    def follow(self, motion: Motion) -> Desired:
        """Return the desired accelerations that follow `motion`."""
        value, velocity, acceleration = motion.value, motion.velocity, motion.acceleration
        quaternions = value[self._columns["quaternion"]].tolist()
        for ski in range(2):
            self._ski(ski, value, velocity, acceleration, motion.spin, motion.spin_rate, quaternions)
        self._com(value, velocity, acceleration)
        self._pose(value, velocity, acceleration)
        self._pelvis(motion.spin[6:9], motion.spin_rate[6:9], quaternions[8:12])
        self._angular_momentum(velocity, motion.spin[6:9])
        return self.desired

    def _ski(
        self,
        ski: int,
        value: np.ndarray,
        velocity: np.ndarray,
        acceleration: np.ndarray,
        spin: np.ndarray,
        spin_rate: np.ndarray,
        quaternions: list[float],
    ) -> None:
        dynamics, gains, desired = self.dynamics, self.gains, self.desired
        start = self._columns["ski_position"].start + 3 * ski
        place, turn = slice(start, start + 3), slice(3 * ski, 3 * ski + 3)
        offset, turn_error = desired.ski_offset[ski], desired.ski_turn[ski]
        np.subtract(value[place], dynamics.ski_position(ski), out=offset)
        current = dynamics.xquat[dynamics.model.ski_body[ski]].tolist()
        turn_error[:] = rotation_error(quaternions[4 * ski : 4 * ski + 4], current)
        moving = dynamics.ski_velocity[ski]
        linear = gains.ski.kp * offset + gains.ski.kd * (velocity[place] - moving[:3]) + acceleration[place]
        axes = desired.ski_axes[ski]
        axes[:] = dynamics.ski_rotation(ski)
        error, slip = turn_error @ axes, (spin[turn] - moving[3:]) @ axes
        desired.ski[ski, :3] = linear
        desired.ski[ski, 3:] = gains.ski.kp * error + gains.ski.kd * slip + spin_rate[turn] @ axes
        desired.ski[ski, 3] += (gains.edging.kp - gains.ski.kp) * error[0] + (gains.edging.kd - gains.ski.kd) * slip[0]

    def _com(self, value: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray) -> None:
        columns, dynamics, gain, desired = self._columns, self.dynamics, self.gains.com, self.desired
        com = columns["com"]
        desired.com_axes[0], desired.com_axes[1] = value[columns["across"]], value[columns["normal"]]
        np.subtract(value[com], dynamics.com, out=desired.com_offset)
        wanted = gain.kp * desired.com_offset + gain.kd * (velocity[com] - dynamics.com_velocity) + acceleration[com]
        np.dot(desired.com_axes, wanted, out=desired.com)

    def _pose(self, value: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray) -> None:
        columns, dynamics, gain = self._columns["joints"], self.dynamics, self.gains.pose
        error = value[columns] - dynamics.qpos[self._joint_address]
        self.desired.joints[:] = (
            gain.kp * error + gain.kd * (velocity[columns] - dynamics.velocity[6:]) + acceleration[columns]
        )

    def _pelvis(self, spin: np.ndarray, spin_rate: np.ndarray, quaternion: list[float]) -> None:
        dynamics, gain = self.dynamics, self.gains.pelvis
        error = np.array(rotation_error(quaternion, dynamics.xquat[1].tolist()))
        rotation = dynamics.root_rotation
        # the root's angular velocity and acceleration are in its own axes
        self.desired.pelvis[:] = (
            gain.kp * error + gain.kd * spin + spin_rate
        ) @ rotation - gain.kd * dynamics.velocity[3:6]

    def _angular_momentum(self, velocity: np.ndarray, spin: np.ndarray) -> None:
        dynamics, planned = self.dynamics, self._reference_velocity
        planned[:3] = dynamics.velocity[:3]
        planned[3:6] = spin @ dynamics.root_rotation
        planned[6:] = velocity[self._columns["joints"]]
        wanted = dynamics.momentum_matrix @ (planned - dynamics.velocity)
        self.desired.angular_momentum_rate[:] = self.gains.angular_momentum.kd * wanted


def rotation_error(target: list[float], current: list[float]) -> tuple[float, float, float]:
    """Return the world rotation vector [rad] that turns `current` into `target`, a quaternion of any length."""
    tw, tx, ty, tz = target
    cw, cx, cy, cz = current
    w = tw * cw + tx * cx + ty * cy + tz * cz
    x = -tw * cx + tx * cw - ty * cz + tz * cy
    y = -tw * cy + tx * cz + ty * cw - tz * cx
    z = -tw * cz - tx * cy + ty * cx + tz * cw
    sine = math.sqrt(x * x + y * y + z * z)
    if w < 0.0:
        w, x, y, z = -w, -x, -y, -z
    factor = 2.0 * math.atan2(sine, w) / sine if sine > 1e-9 else 2.0 / w
    return factor * x, factor * y, factor * z
