"""The near future re-made from the present state: skis on the steered line, edged to the lean there is.

What is off the plan is not pulled back to it. Skis follow the line that `Steering` decided, turned into its direction
and rolled to the lean as measured; the centre of mass goes on from where it is, accelerated as the pendulum over that
line is; legs do what skis and centre of mass need. All of it fades in with how far the skier is off the plan.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...body import SkierModel
from ...snow import lift_slope
from ..dynamics import Dynamics
from ..motion import Motion
from .deviation import Deviation
from .steering import Steering

PELVIS_ROLL = 0.5
"""How much of the skis' roll off the plan the pelvis makes too."""
PELVIS_TURN = 0.5
"""How much of the skis' turn off the plan the pelvis makes too."""
LOOSE_LEGS = 0.01
"""Factor on the weight of the legs' pose while the skier is off the plan."""
DEEPEST = 0.94
"""Most sideways offset of the centre of mass over the skis, in units of its distance from them."""
FLATTEST, FLATTEN_PUSH = math.radians(10.0), 2.0
"""Skis are rolled by up to the first [rad] towards flat, and `BEYOND_FLAT`, before a push that turns the body over the
edges that bear by the second [m/s^2] or more: then the other edges hold."""
BEYOND_FLAT = math.radians(3.0)
SLOWEST = 0.5
"""Least speed [m/s] by which the direction of the steered line is judged."""


@dataclass(frozen=True)
class Lean:
    """The lean off the plan `angle` [rad, left], its `rate` [rad/s], and the planned and the present height's
    change: `rise` [m], `rise_rate` [m/s], `rise_acceleration` [m/s^2]; `sideways` [m/s^2] is what the centre of mass is
    accelerated to the left off the plan.
    """

    angle: float
    rate: float
    rise: float
    rise_rate: float
    rise_acceleration: float
    sideways: float


@dataclass(frozen=True)
class Heading:
    """Turn of the skis off the plan `angle` [rad, left], `rate` [rad/s] and `acceleration` [rad/s^2]."""

    angle: float
    rate: float
    acceleration: float


def steered_heading(steering: Steering, deviation: Deviation, grip: float = 1.0) -> Heading:
    """Return the direction of the steered line against the planned skis; those without `grip` slide there unturned."""
    speed = max(deviation.speed - steering.offset * deviation.turning, SLOWEST)
    drift = steering.rate
    square = speed * speed + drift * drift
    turn = speed / square
    rate = steering.acceleration * turn
    acceleration = steering.jerk * turn - 2.0 * drift * steering.acceleration * rate / square
    return Heading(grip * math.atan2(drift, speed), grip * rate, grip * acceleration)


def measured_lean(steering: Steering, deviation: Deviation, push: float, planned: float) -> Lean:
    """Return the lean over the steered line against the planned one, and how it goes on.

    The body is a pendulum on a leg of the planned length: `push` [m/s^2] from outside, gravity and snow accelerate it.
    `planned` [m/s^2] is the plan's sideways acceleration at the planned speed.
    """
    d = deviation
    length = math.hypot(d.planned_y, d.planned_h)
    most = DEEPEST * length
    over = min(max(d.planned_y + d.y - steering.offset, -most), most)
    over_rate = d.planned_y_rate + d.y_rate - steering.rate
    height = math.sqrt(length * length - over * over)
    growth = d.planned_y * d.planned_y_rate + d.planned_h * d.planned_h_rate
    height_rate = (growth - over * over_rate) / height
    angle = math.atan2(over, d.h) - math.atan2(d.planned_y, d.planned_h)
    rate = (over_rate * d.h - over * d.h_rate) / (over * over + d.h * d.h)
    rate -= (d.planned_y_rate * d.planned_h - d.planned_y * d.planned_h_rate) / (length * length)
    # sideways acceleration over the skis = that of the body in the world + the frame's part
    square = d.turning * d.turning
    frame = square * (d.planned_y + d.y) - d.centripetal - steering.acceleration
    planned_bend = d.sideways - d.centripetal + square * d.planned_y
    planned_fall = _fall(d.planned_y, d.planned_y_rate, planned_bend, d.planned_h, d.planned_h_rate)
    load = d.pull * d.planned_h + _fall(over, over_rate, frame, height, height_rate) - planned_fall
    lever = over - steering.shift
    free = planned - d.pull * d.planned_y + push
    sideways = (free + lever * load / height) / max(1.0 + over * lever / (height * height), 0.5)
    fall = _fall(over, over_rate, sideways + frame, height, height_rate) - planned_fall
    return Lean(angle, rate, height - d.planned_h, height_rate - d.planned_h_rate, fall, sideways - d.sideways)


def _fall(y: float, y_rate: float, y_acceleration: float, h: float, h_rate: float) -> float:
    """Return h'' of a leg of fixed length that leans."""
    return -(y_rate * y_rate + y * y_acceleration + h_rate * h_rate) / h


def flattening(edge: float, tipping: float) -> float:
    """Return the roll [rad] that brings the lifted edges of skis at `edge` [rad] down before `tipping` [m/s^2]."""
    if edge * tipping >= 0.0:
        return 0.0
    most = min(FLATTEST * min(abs(tipping) / FLATTEN_PUSH, 1.0), abs(edge) + BEYOND_FLAT)
    return math.copysign(most, tipping)


class Replanner:
    """Changes a `Motion` in place to the re-planned one."""

    def __init__(self, motion: Motion, dynamics: Dynamics) -> None:
        """Bind to the motion the tasks follow and the skier's dynamics."""
        self._motion, self._dynamics = motion, dynamics
        model: SkierModel = dynamics.model
        columns = motion.columns
        self._columns = columns
        joints = columns["joints"]
        hinge = np.searchsorted(model.actuated_dof, np.sort(model.leg_dof.ravel()))
        self._leg_columns = joints.start + hinge
        self._leg_qpos = model.actuated_qpos[hinge]
        self._leg_velocity = 6 + hinge
        self._width = model.skeleton.ski_width

    def apply(
        self,
        blend: float,
        steering: Steering,
        deviation: Deviation,
        planned: float,
        push: float,
        tipping: float,
        grip: float = 1.0,
    ) -> None:
        """Re-plan by `blend` (0..1).

        `planned` [m/s^2] is the plan's sideways acceleration at planned speed; `push` the one from outside and `tipping`
        the one by which that turns the body over; skis turn into the steered direction with `grip` 0..1.
        """
        d = deviation
        heading = steered_heading(steering, d, grip)
        lean = measured_lean(steering, d, push, planned)
        self._move_com(blend, d, lean)
        self._move_skis(blend, steering, heading, lean, tipping)
        self._turn_pelvis(blend, heading, lean)
        self._free_legs(blend)

    def _move_com(self, blend: float, d: Deviation, lean: Lean) -> None:
        motion, com = self._motion, self._columns["com"]
        across, normal = motion.value[self._columns["across"]], motion.value[self._columns["normal"]]
        motion.value[com] += blend * d.y * across + blend * lean.rise * normal
        motion.velocity[com] += blend * d.y_rate * across + blend * lean.rise_rate * normal
        motion.acceleration[com] += blend * lean.sideways * across + blend * lean.rise_acceleration * normal

    def _move_skis(self, blend: float, steering: Steering, heading: Heading, lean: Lean, tipping: float) -> None:
        motion, columns = self._motion, self._columns
        skis, place = columns["ski_position"], columns["track_position"]
        along, across, normal = (motion.value[columns[name]] for name in ("along", "across", "normal"))
        swing, swing_t = motion.velocity[columns["across"]], motion.acceleration[columns["across"]]
        cross = _cross_matrix(normal)
        turn = _rotation(cross, normal, heading.angle)
        e, e1, e2 = steering.offset, steering.rate, steering.acceleration
        middle = motion.value[place] + e * across
        middle_1 = motion.velocity[place] + e1 * across + e * swing
        middle_2 = motion.acceleration[place] + e2 * across + 2.0 * e1 * swing + e * swing_t
        arm = (motion.value[skis].reshape(2, 3) - motion.value[place]) @ turn.T
        arm_1 = (motion.velocity[skis].reshape(2, 3) - motion.velocity[place]) @ turn.T
        arm_2 = (motion.acceleration[skis].reshape(2, 3) - motion.acceleration[place]) @ turn.T
        w, w_1 = heading.rate, heading.acceleration
        about = arm @ cross.T
        arm_2 += 2.0 * w * (arm_1 @ cross.T) + w_1 * about + w * w * (about @ cross.T)
        arm_1 += w * about
        roll_rate = blend * lean.rate
        edges = motion.value[columns["edge_angle"]].tolist()
        roll = blend * lean.angle
        roll += flattening(0.5 * (edges[0] + edges[1]) + roll, tipping)
        for ski, edge in enumerate(edges):
            planned, _ = lift_slope(edge, self._width)
            lift, slope = lift_slope(edge + roll, self._width)
            edge_rate = float(motion.velocity[columns["edge_angle"]][ski])
            arm[ski] += (lift - planned) * normal
            arm_1[ski] += (slope * (edge_rate + roll_rate) - lift_slope(edge, self._width)[1] * edge_rate) * normal
        motion.value[skis] = (arm + middle).reshape(-1)
        motion.velocity[skis] = (arm_1 + middle_1).reshape(-1)
        motion.acceleration[skis] = (arm_2 + middle_2).reshape(-1)
        self._turn(0, turn, along, normal, heading, 1.0, roll, roll_rate)
        self._turn(1, turn, along, normal, heading, 1.0, roll, roll_rate)

    def _turn_pelvis(self, blend: float, heading: Heading, lean: Lean) -> None:
        motion, columns = self._motion, self._columns
        along, normal = motion.value[columns["along"]], motion.value[columns["normal"]]
        turn = _rotation(_cross_matrix(normal), normal, PELVIS_TURN * heading.angle)
        share = PELVIS_ROLL * blend
        self._turn(2, turn, along, normal, heading, PELVIS_TURN, share * lean.angle, share * lean.rate)

    def _turn(
        self,
        part: int,
        turn: np.ndarray,
        along: np.ndarray,
        normal: np.ndarray,
        heading: Heading,
        share: float,
        roll: float,
        roll_rate: float,
    ) -> None:
        """Turn a part's reference by `share` of the heading about the normal and roll it to the left by `roll`."""
        motion = self._motion
        forward = turn @ along
        quaternion, spin = motion.value[self._columns["quaternion"]], slice(3 * part, 3 * part + 3)
        place = slice(4 * part, 4 * part + 4)
        turned = _times(_about(normal, share * heading.angle), quaternion[place].tolist())
        quaternion[place] = _times(_about(forward, -roll), turned)
        rolling = -roll_rate * forward
        motion.spin[spin] = turn @ motion.spin[spin] + share * heading.rate * normal + rolling
        motion.spin_rate[spin] = turn @ motion.spin_rate[spin] + share * heading.acceleration * normal

    def _free_legs(self, blend: float) -> None:
        motion, dynamics, legs = self._motion, self._dynamics, self._leg_columns
        value, velocity = motion.value[legs], motion.velocity[legs]
        motion.value[legs] = value + blend * (dynamics.qpos[self._leg_qpos] - value)
        motion.velocity[legs] = velocity + blend * (dynamics.velocity[self._leg_velocity] - velocity)
        motion.acceleration[legs] *= 1.0 - blend
        motion.leg_freedom = 1.0 + blend * (LOOSE_LEGS - 1.0)


def _cross_matrix(axis: np.ndarray) -> np.ndarray:
    """Return C with C r = axis x r."""
    x, y, z = axis.tolist()
    return np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))


def _rotation(cross: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """Return the rotation (3, 3) by `angle` about the unit `axis` whose cross matrix is `cross`."""
    cosine = math.cos(angle)
    out = math.sin(angle) * cross + (1.0 - cosine) * np.outer(axis, axis)
    out.reshape(-1)[::4] += cosine
    return out


def _about(axis: np.ndarray, angle: float) -> tuple[float, float, float, float]:
    x, y, z = axis.tolist()
    sine = math.sin(0.5 * angle)
    return math.cos(0.5 * angle), sine * x, sine * y, sine * z


def _times(a: tuple[float, ...], b: tuple[float, ...] | list[float]) -> tuple[float, float, float, float]:
    """Return the quaternion product a b."""
    aw, ax, ay, az = a
    bw, bx, by, bz = b
    return (
        aw * bw - ax * bx - ay * by - az * bz,
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
    )
