"""The controller's program written down a second time, slowly: every task and every row from MuJoCo's whole model.

Residuals are evaluated as functions of the unknowns, one unknown at a time, from the accelerations of bodies and
points; nothing is shared with `ski_addon.control` but the meaning of the unknowns: q'' (37), then for each ski the
normal forces of its left and right edge and the side forces of its left and right edge, in units of 100 N.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np

from ski_addon.control import Dynamics, Gains
from ski_addon.control.tasks import Desired

FORCE_UNIT = 100.0
GRAVITY = np.array([0.0, 0.0, -9.81])


@dataclass(frozen=True)
class NaiveProgram:
    """min 1/2 x'Px + q'x, lower <= Ax <= upper, dense."""

    P: np.ndarray
    q: np.ndarray
    A: np.ndarray
    lower: np.ndarray
    upper: np.ndarray


@dataclass(frozen=True)
class Snowpack:
    """What the program needs to know of snow and skis."""

    friction: float
    friction_per_speed: float
    shear_limit: float
    segments: int
    length: float
    width: float


def affine(function: Callable[[np.ndarray], np.ndarray], size: int) -> tuple[np.ndarray, np.ndarray]:
    """Matrix and constant of an affine `function` of a vector of `size`."""
    constant = function(np.zeros(size))
    return np.stack([function(e) - constant for e in np.eye(size)], axis=1), constant


class NaiveModel:
    """The skier at one state; every question is asked of MuJoCo's 41 degrees of freedom."""

    def __init__(self, dynamics: Dynamics) -> None:
        self.model = dynamics.model
        self.mj = dynamics.model.mujoco
        self.data = dynamics.model.new_data()
        self.data.qpos[:], self.data.qvel[:] = dynamics.qpos, dynamics.qvel
        mujoco.mj_fwdPosition(self.mj, self.data)
        mujoco.mj_fwdVelocity(self.mj, self.data)
        self.mass_matrix = np.zeros((41, 41))
        mujoco.mj_fullM(self.mj, self.data, self.mass_matrix)
        self.com = self.data.subtree_com[1].copy()
        self.air = self._air(dynamics.drag_factor)

    def _air(self, drag_factor: float) -> np.ndarray:
        """Generalised force of a drag that acts on every body in proportion to its mass."""
        momentum = np.zeros(3)
        for body in range(1, 21):
            jacobian, _, _, _ = self.point(self.data.xipos[body], body)
            momentum += self.mj.body_mass[body] * jacobian @ self.data.qvel
        velocity = momentum / self.model.mass
        out = np.zeros(41)
        for body in range(1, 21):
            jacobian, _, _, _ = self.point(self.data.xipos[body], body)
            out -= jacobian.T @ (self.mj.body_mass[body] * drag_factor * np.linalg.norm(velocity) * velocity)
        return out

    def point(self, place: np.ndarray, body: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Jacobians (3, 41) of a point fixed to a body, linear and angular, and their time derivatives."""
        arrays = [np.zeros((3, 41)) for _ in range(4)]
        mujoco.mj_jac(self.mj, self.data, arrays[0], arrays[1], place, body)
        mujoco.mj_jacDot(self.mj, self.data, arrays[2], arrays[3], place, body)
        return arrays[0], arrays[1], arrays[2], arrays[3]

    def whole(self, acceleration: np.ndarray) -> np.ndarray:
        """q'' (41,) when the body has `acceleration` (37,): the poles do what spring, damper and air make them."""
        body, pole = self.model.body_dof, self.model.pole_dof
        out = np.zeros(41)
        out[body] = acceleration
        free = self.data.qfrc_passive + self.air - self.data.qfrc_bias
        for _ in range(2):  # once would do; the second pass shows that it did
            error = (free - self.mass_matrix @ out)[pole]
            out[pole] += np.linalg.solve(self.mass_matrix[np.ix_(pole, pole)], error)
        return out

    def point_acceleration(self, acceleration: np.ndarray, place: np.ndarray, body: int) -> np.ndarray:
        jacobian, _, jacobian_dot, _ = self.point(place, body)
        return jacobian @ self.whole(acceleration) + jacobian_dot @ self.data.qvel

    def angular_acceleration(self, acceleration: np.ndarray, body: int) -> np.ndarray:
        _, jacobian, _, jacobian_dot = self.point(self.data.xpos[body], body)
        return jacobian @ self.whole(acceleration) + jacobian_dot @ self.data.qvel

    def com_acceleration(self, acceleration: np.ndarray) -> np.ndarray:
        total = np.zeros(3)
        for body in range(1, 21):
            total += self.mj.body_mass[body] * self.point_acceleration(acceleration, self.data.xipos[body], body)
        return total / self.model.mass

    def momentum_rate(self, acceleration: np.ndarray) -> np.ndarray:
        """d/dt of the angular momentum about the centre of mass, summed over bodies [N m, world]."""
        total = np.zeros(3)
        for body in range(1, 21):
            axes = self.data.ximat[body].reshape(3, 3)
            inertia = axes @ np.diag(self.mj.body_inertia[body]) @ axes.T
            _, jacobian, _, _ = self.point(self.data.xpos[body], body)
            spin = jacobian @ self.data.qvel
            arm = self.data.xipos[body] - self.com
            linear = self.point_acceleration(acceleration, self.data.xipos[body], body)
            total += np.cross(arm, self.mj.body_mass[body] * linear)
            total += inertia @ self.angular_acceleration(acceleration, body) + np.cross(spin, inertia @ spin)
        return total

    def needed_force(self, acceleration: np.ndarray) -> np.ndarray:
        """Generalised force (37,) that muscles and snow together must give, by inverse dynamics."""
        data = self.model.new_data()
        data.qpos[:], data.qvel[:] = self.data.qpos, self.data.qvel
        data.qacc[:] = self.whole(acceleration)
        mujoco.mj_inverse(self.mj, data)
        return (data.qfrc_inverse - self.air)[self.model.body_dof]


def task_residuals(
    naive: NaiveModel, desired: Desired, gains: Gains, snow: Snowpack, absent: tuple[str, ...] = ()
) -> Callable[[np.ndarray], np.ndarray]:
    """Residuals of all tasks but the `absent` ones, each times the root of its weight, as a function of q'' (37,)."""
    legs = set(naive.model.leg_dof.ravel().tolist())

    def ski(acceleration: np.ndarray, index: int) -> list[float]:
        """The paper's four corners, whose desired accelerations are those of a rigid ski; roll has its own weight."""
        body = int(naive.model.ski_body[index])
        axes, wanted = desired.ski_axes[index], desired.ski[index]
        linear = naive.point_acceleration(acceleration, naive.data.xpos[body], body) - wanted[:3]
        angular = axes.T @ naive.angular_acceleration(acceleration, body) - wanted[3:]
        out = []
        if "ski" not in absent:
            for x in (0.5 * snow.length, -0.5 * snow.length):
                for y in (0.5 * snow.width, -0.5 * snow.width):
                    without_roll = np.array([0.0, angular[1], angular[2]])
                    corner = linear + axes @ np.cross(without_roll, np.array([x, y, 0.0]))
                    out += (np.sqrt(gains.ski.weight) * corner).tolist()
        if "edging" not in absent:
            out.append(np.sqrt(gains.edging.weight) * angular[0])
        return out

    def residuals(acceleration: np.ndarray) -> np.ndarray:
        out = ski(acceleration, 0) + ski(acceleration, 1)
        if "com" not in absent:
            error = desired.com_axes @ naive.com_acceleration(acceleration) - desired.com
            out += (np.sqrt(gains.com.weight) * error).tolist()
        if "angular_momentum" not in absent:
            error = naive.momentum_rate(acceleration) - desired.angular_momentum_rate
            out += (np.sqrt(gains.angular_momentum.weight) * error).tolist()
        if "pelvis" not in absent:
            out += (np.sqrt(gains.pelvis.weight) * (acceleration[3:6] - desired.pelvis)).tolist()
        for hinge, dof in enumerate(naive.model.actuated_dof.tolist()):
            task = "leg_pose" if dof in legs else "pose"
            if task not in absent:
                error = acceleration[6 + hinge] - desired.joints[hinge]
                out.append(np.sqrt(getattr(gains, task).weight) * error)
        out += (np.sqrt(gains.root_position) * acceleration[:3]).tolist()
        return np.array(out)

    return residuals


def contact_force(naive: NaiveModel, snow: Snowpack, normal: np.ndarray, forces: np.ndarray) -> np.ndarray:
    """Generalised force (37,) of the snow: every contact point one by one, at its own Jacobian."""
    total = np.zeros(41)
    segment = snow.length / snow.segments
    number = 0
    for ski in range(2):
        body = int(naive.model.ski_body[ski])
        middle, axes = naive.data.xpos[body], naive.data.xmat[body].reshape(3, 3)
        jacobian, _, _, _ = naive.point(middle, body)
        velocity = jacobian @ naive.data.qvel
        velocity = velocity - (velocity @ normal) * normal
        speed = np.linalg.norm(velocity)
        mu = snow.friction + snow.friction_per_speed * speed
        across = np.cross(normal, axes[:, 0])
        directions = (normal - mu * velocity / speed, across / np.linalg.norm(across))
        for direction in directions:
            for side in (0.5, -0.5):
                for k in range(snow.segments):
                    local = np.array([-0.5 * snow.length + (k + 0.5) * segment, side * snow.width, 0.0])
                    jacobian, _, _, _ = naive.point(middle + axes @ local, body)
                    total += jacobian.T @ (direction * forces[number] * FORCE_UNIT)
                    number += 1
    return total[naive.model.body_dof]


def snow_bounds(naive: NaiveModel, snow: Snowpack, edge_angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Bounds of the forces: unilateral normals; side forces against the side that bears; a lifting edge fades out."""
    weight = naive.model.mass * 9.81 / FORCE_UNIT
    lower, upper = [], []
    for angle in edge_angle:
        x = np.clip((abs(angle) - np.deg2rad(0.5)) / np.deg2rad(7.5), 0.0, 1.0)
        lifted = 1.0 - 3.0 * x**2 + 2.0 * x**3
        bearing = {"left": 1.0 if angle > 0 else lifted, "right": lifted if angle > 0 else 1.0}
        edges_that_bear = 1.0 + lifted  # the grip of the whole ski is shared between them
        grip = snow.shear_limit / FORCE_UNIT / snow.segments / edges_that_bear
        slight = 0.5 * weight / snow.segments
        normal = {edge: 6.0 * weight if b == 1.0 else b * slight for edge, b in bearing.items()}
        side = {edge: min(6.0 * weight, grip) if b == 1.0 else b * min(slight, grip) for edge, b in bearing.items()}
        weaker = min(side.values()) if lifted < 1.0 else side["left"]
        for edge in ("left", "right"):
            lower += [0.0] * snow.segments
            upper += [normal[edge]] * snow.segments
        lower += [-weaker] * snow.segments + [-side["right"]] * snow.segments
        upper += [side["left"]] * snow.segments + [weaker] * snow.segments
    return np.array(lower), np.array(upper)


def hinge_bounds(naive: NaiveModel) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations (31,) that keep every hinge within its range by 0.5 deg in the next 30 ms, at most 800 rad/s^2."""
    lower, upper = [], []
    model = naive.model
    for hinge in range(31):
        angle, rate = naive.data.qpos[model.actuated_qpos[hinge]], naive.data.qvel[model.actuated_dof[hinge]]
        margin = np.deg2rad(0.5)
        for limit, out in ((model.joint_lower[hinge] + margin, lower), (model.joint_upper[hinge] - margin, upper)):
            out.append(np.clip(4.0 * (limit - angle - 0.03 * rate) / 0.03**2, -800.0, 800.0))
    return np.array(lower), np.array(upper)


def torque_bounds(naive: NaiveModel) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest torque (31,): the muscles', and ten times as much where a hinge runs into its end stop."""
    lower, upper = [], []
    model, margin = naive.model, np.deg2rad(0.1)
    for hinge in range(31):
        weakest, strongest = model.torque_lower[hinge], model.torque_upper[hinge]
        stop = 10.0 * max(-weakest, strongest)
        reached = naive.data.qpos[model.actuated_qpos[hinge]] + 0.03 * naive.data.qvel[model.actuated_dof[hinge]]
        lower.append(weakest - stop if reached > model.joint_upper[hinge] - margin else weakest)
        upper.append(strongest + stop if reached < model.joint_lower[hinge] + margin else strongest)
    return np.array(lower), np.array(upper)


def naive_program(
    dynamics: Dynamics,
    desired: Desired,
    gains: Gains,
    snow: Snowpack,
    edge_angle: np.ndarray,
    normal: np.ndarray,
    absent: tuple[str, ...] = (),
) -> NaiveProgram:
    """The whole program at the present state."""
    naive = NaiveModel(dynamics)
    points = 8 * snow.segments
    rows, constant = affine(task_residuals(naive, desired, gains, snow, absent), 37)
    size = 37 + points
    P, q = np.zeros((size, size)), np.zeros(size)
    P[:37, :37] = rows.T @ rows
    P[range(37, size), range(37, size)] = gains.force
    q[:37] = rows.T @ constant

    motion, bias = affine(naive.needed_force, 37)
    push, _ = affine(lambda forces: contact_force(naive, snow, normal, forces), points)
    model = naive.model
    scale = np.concatenate((np.full(6, 0.01), 1.0 / np.maximum(model.torque_upper, -model.torque_lower)))
    dynamics_rows = scale[:, None] * np.hstack((motion, -push))
    hinge_rows = np.hstack((np.zeros((31, 6)), np.eye(31), np.zeros((31, points))))
    snow_rows = np.hstack((np.zeros((points, 37)), np.eye(points)))
    torques = torque_bounds(naive)
    torque_lower, torque_upper = (np.concatenate((np.zeros(6), bound)) for bound in torques)
    hinges, forces = hinge_bounds(naive), snow_bounds(naive, snow, edge_angle)
    return NaiveProgram(
        P=P,
        q=q,
        A=np.vstack((dynamics_rows, hinge_rows, snow_rows)),
        lower=np.concatenate((scale * (torque_lower - bias), hinges[0], forces[0])),
        upper=np.concatenate((scale * (torque_upper - bias), hinges[1], forces[1])),
    )
