"""The near future re-made from the present state: skis on the steered line, edged to the lean there is.

What is off the plan is not pulled back to it. Skis follow the line that `Steering` decided, turned into its direction
and rolled to the lean as measured; the centre of mass goes on from where it is, accelerated as the pendulum over that
line is; legs do what skis and centre of mass need. All of it fades in with how far the skier is off the plan.
"""

from __future__ import annotations

import math

import numpy as np

from ...snow import lift_slope
from ..dynamics import Dynamics
from ..motion import Motion
from .deviation import Deviation
from .lean import Heading, Lean, flattening, measured_lean, steered_heading
from .steering import Steering

Vector = list[float]
SKIS, PELVIS = range(2), range(2, 3)
PELVIS_ROLL = 0.5
"""How much of the skis' roll off the plan the pelvis makes too."""
PELVIS_TURN = 0.5
"""How much of the skis' turn off the plan the pelvis makes too."""
LOOSE_LEGS = 0.01
"""Factor on the weight of the legs' pose while the skier is off the plan."""


class Replanner:
    """Changes a `Motion` in place to the re-planned one."""

    def __init__(self, motion: Motion, dynamics: Dynamics) -> None:
        """Bind to the motion the tasks follow and the skier's dynamics."""
        self._motion, self._dynamics = motion, dynamics
        model, columns = dynamics.model, motion.columns
        self._columns = columns
        self._frame = slice(columns["along"].start, columns["normal"].stop)
        hinge = np.searchsorted(model.actuated_dof, np.sort(model.leg_dof.ravel()))
        self._leg_columns = columns["joints"].start + hinge
        self._leg_qpos = model.actuated_qpos[hinge]
        self._leg_velocity = 6 + hinge
        self._legs = np.zeros((2, len(hinge)))
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

        `planned` [m/s^2] is the plan's sideways acceleration at planned speed; `push` the one from outside and
        `tipping` the one by which that turns the body over; skis turn into the steered direction with `grip` 0..1.
        """
        heading = steered_heading(steering, deviation, grip)
        lean = measured_lean(steering, deviation, push, planned)
        edges = self._motion.value[self._columns["edge_angle"]]
        roll = blend * lean.angle
        roll += flattening(0.5 * float(edges[0] + edges[1]) + roll, tipping)
        axes = self._motion.value[self._frame].reshape(3, 3).copy()
        cross = _cross_matrix(axes[2])
        turn = _rotation(cross, axes[2], heading.angle)
        self._move_skis(steering, heading, self._lifts(roll, blend * lean.rate), axes[2], cross, turn)
        self._turn(SKIS, heading, 1.0, roll, blend * lean.rate)
        share = PELVIS_ROLL * blend
        self._turn(PELVIS, heading, PELVIS_TURN, share * lean.angle, share * lean.rate)
        if blend > 0.0:
            self._move_com(blend, deviation, lean, axes[1:])
            self._free_legs(blend)

    def _move_com(self, blend: float, d: Deviation, lean: Lean, axes: np.ndarray) -> None:
        """Let the centre of mass go on from where it is; `axes` (2, 3) are across the skis and up."""
        shares = ((d.y, lean.rise), (d.y_rate, lean.rise_rate), (lean.sideways, lean.rise_acceleration))
        self._motion.table[:, self._columns["com"]] += blend * np.array(shares) @ axes

    def _move_skis(
        self,
        steering: Steering,
        heading: Heading,
        lifts: np.ndarray,
        normal: np.ndarray,
        cross: np.ndarray,
        turn: np.ndarray,
    ) -> None:
        """Move the skis to the steered line and turn them about its middle; `lifts` (2, 2) along the normal."""
        table, columns = self._motion.table, self._columns
        place, skis = table[:, columns["track_position"]], columns["ski_position"]
        e, e1, e2 = steering.offset, steering.rate, steering.acceleration
        shares = np.array(((e, 0.0, 0.0), (e1, e, 0.0), (e2, 2.0 * e1, e)))
        middle = place + shares @ table[:, columns["across"]]
        arm = (table[:, skis].reshape(3, 2, 3) - place[:, None]) @ turn.T  # value, velocity, acceleration by ski
        about = arm[:2] @ cross.T
        w, w1 = heading.rate, heading.acceleration
        arm[2] += 2.0 * w * about[1] + w1 * about[0] + w * w * (about[0] @ cross.T)
        arm[1] += w * about[0]
        arm[:2] += lifts[:, :, None] * normal
        table[:, skis] = (arm + middle[:, None]).reshape(3, 6)

    def _lifts(self, roll: float, roll_rate: float) -> np.ndarray:
        """Return how much higher [m], and rising faster [m/s], the middle of each ski is when it is rolled (2, 2)."""
        motion, edge = self._motion, self._columns["edge_angle"]
        lifts = np.empty((2, 2))
        angles = zip(motion.value[edge].tolist(), motion.velocity[edge].tolist(), strict=True)
        for ski, (angle, rate) in enumerate(angles):
            planned, planned_slope = lift_slope(angle, self._width)
            lift, slope = lift_slope(angle + roll, self._width)
            lifts[0, ski] = lift - planned
            lifts[1, ski] = slope * (rate + roll_rate) - planned_slope * rate
        return lifts

    def _turn(self, parts: range, heading: Heading, share: float, roll: float, roll_rate: float) -> None:
        """Turn the references of `parts` (0, 1: skis, 2: pelvis).

        They turn by `share` of the heading about the normal and roll to the left by `roll` [rad], on at `roll_rate`.
        """
        motion = self._motion
        along, _, normal = motion.value[self._frame].reshape(3, 3).tolist()
        angle, spin, spin_rate = share * heading.angle, share * heading.rate, share * heading.acceleration
        fx, fy, fz = forward = _turned(along, normal, angle)
        nx, ny, nz = normal
        turning = _times(_about(forward, -roll), _about(normal, angle))
        quaternions = motion.value[self._columns["quaternion"]]
        for part in parts:
            place, own = slice(3 * part, 3 * part + 3), slice(4 * part, 4 * part + 4)
            quaternions[own] = _times(turning, quaternions[own].tolist())
            x, y, z = _turned(motion.spin[place].tolist(), normal, angle)
            motion.spin[place] = (
                x + spin * nx - roll_rate * fx,
                y + spin * ny - roll_rate * fy,
                z + spin * nz - roll_rate * fz,
            )
            x, y, z = _turned(motion.spin_rate[place].tolist(), normal, angle)
            motion.spin_rate[place] = x + spin_rate * nx, y + spin_rate * ny, z + spin_rate * nz

    def _free_legs(self, blend: float) -> None:
        """Let the legs be where they are."""
        table, dynamics, measured = self._motion.table, self._dynamics, self._legs
        np.take(dynamics.qpos, self._leg_qpos, out=measured[0])
        np.take(dynamics.velocity, self._leg_velocity, out=measured[1])
        legs = (1.0 - blend) * table[:, self._leg_columns]
        legs[:2] += blend * measured
        table[:, self._leg_columns] = legs
        self._motion.leg_freedom = 1.0 + blend * (LOOSE_LEGS - 1.0)


def _cross_matrix(axis: np.ndarray) -> np.ndarray:
    """Return C with C r = axis x r."""
    x, y, z = axis.tolist()
    return np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))


def _rotation(cross: np.ndarray, axis: np.ndarray, angle: float) -> np.ndarray:
    """Return the rotation (3, 3) by `angle` about the unit `axis` whose cross matrix is `cross`."""
    cosine = math.cos(angle)
    out = math.sin(angle) * cross + ((1.0 - cosine) * axis)[:, None] * axis
    out.reshape(-1)[::4] += cosine
    return out


def _turned(vector: Vector, axis: Vector, angle: float) -> Vector:
    """Return `vector` turned by `angle` about the unit `axis`."""
    x, y, z = vector
    ax, ay, az = axis
    cosine, sine = math.cos(angle), math.sin(angle)
    part = (1.0 - cosine) * (x * ax + y * ay + z * az)
    return [
        cosine * x + sine * (ay * z - az * y) + part * ax,
        cosine * y + sine * (az * x - ax * z) + part * ay,
        cosine * z + sine * (ax * y - ay * x) + part * az,
    ]


def _about(axis: Vector, angle: float) -> tuple[float, float, float, float]:
    """Return the quaternion of a turn by `angle` about the unit `axis`."""
    x, y, z = axis
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
