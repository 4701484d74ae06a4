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
        self._bodies = [*dynamics.model.ski_body.tolist(), 1]  # the root body is the pelvis
        edging, ski = gains.edging, gains.ski
        self._turn_gains = np.array([(edging.kp, ski.kp, ski.kp), (edging.kd, ski.kd, ski.kd), (1.0, 1.0, 1.0)])
        self._turns = np.zeros((2, 3, 3))
        self._off = np.zeros(len(dynamics.model.body_dof) - 3)

    def update(self, sample: np.ndarray, rate: float) -> Desired:
        """Return the desired accelerations at reference `sample` (3, width) and progress `rate`."""
        return self.follow(self.motion.read(sample, rate))

    def follow(self, motion: Motion) -> Desired:
        """Return the desired accelerations that follow `motion`."""
        value, velocity, acceleration = motion.value, motion.velocity, motion.acceleration
        left, right, pelvis = self._rotation_errors(value)
        self._skis(value, velocity, acceleration, motion, (left, right))
        self._com(value, velocity, acceleration)
        self._pose(value, velocity, acceleration)
        self._pelvis(motion.spin[6:], motion.spin_rate[6:], pelvis)
        self._angular_momentum(velocity, motion.spin[6:])
        return self.desired

    def _rotation_errors(self, value: np.ndarray) -> list[tuple[float, float, float]]:
        """Return the rotation vectors [rad, world] that turn left ski, right ski and pelvis to where they should be."""
        planned = value[self._columns["quaternion"]].tolist()
        present = self.dynamics.xquat[self._bodies].tolist()
        return [rotation_error(planned[4 * i : 4 * i + 4], present[i]) for i in range(3)]

    def _skis(
        self,
        value: np.ndarray,
        velocity: np.ndarray,
        acceleration: np.ndarray,
        motion: Motion,
        turn_errors: tuple[tuple[float, float, float], ...],
    ) -> None:
        dynamics, gain, desired, turns = self.dynamics, self.gains.ski, self.desired, self._turns
        place, moving = self._columns["ski_position"], dynamics.ski_velocity
        np.subtract(value[place].reshape(2, 3), dynamics.ski_places, out=desired.ski_offset)
        desired.ski_turn[:] = turn_errors
        desired.ski_axes[:] = dynamics.ski_rotations
        linear = velocity[place].reshape(2, 3) - moving[:, :3]
        linear *= gain.kd
        linear += gain.kp * desired.ski_offset
        linear += acceleration[place].reshape(2, 3)
        desired.ski[:, :3] = linear
        turns[:, 0] = desired.ski_turn
        np.subtract(motion.spin[:6].reshape(2, 3), moving[:, 3:], out=turns[:, 1])
        turns[:, 2] = motion.spin_rate[:6].reshape(2, 3)
        own = np.matmul(turns, desired.ski_axes)  # in the skis' own axes: error, slip, rate
        own *= self._turn_gains
        np.add(own[:, 0], own[:, 1], out=desired.ski[:, 3:])
        desired.ski[:, 3:] += own[:, 2]

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

    def _pelvis(self, spin: np.ndarray, spin_rate: np.ndarray, error: tuple[float, float, float]) -> None:
        dynamics, gain = self.dynamics, self.gains.pelvis
        wanted = gain.kd * spin
        wanted += spin_rate
        wanted += gain.kp * np.array(error)
        # the root's angular velocity and acceleration are in its own axes
        np.dot(wanted, dynamics.root_rotation, out=self.desired.pelvis)
        self.desired.pelvis -= gain.kd * dynamics.velocity[3:6]

    def _angular_momentum(self, velocity: np.ndarray, spin: np.ndarray) -> None:
        dynamics, off, rate = self.dynamics, self._off, self.desired.angular_momentum_rate
        np.dot(spin, dynamics.root_rotation, out=off[:3])
        off[3:] = velocity[self._columns["joints"]]
        off -= dynamics.velocity[3:]
        np.dot(dynamics.momentum_matrix[:, 3:], off, out=rate)
        rate *= self.gains.angular_momentum.kd


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
