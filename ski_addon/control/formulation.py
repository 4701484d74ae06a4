"""The controller's quadratic program, built here and solved in `solver.py` [SG19 Eq. 28-42, in reduced form].

Unknowns are x = [q'' (37), f (n)]: accelerations of root and driven hinges, and for each contact point its normal and
its side force in units of `FORCE_UNIT`. Torques are eliminated by the equations of motion, so that the program is

    minimise   sum of weighted task errors + small force cost
    subject to root rows     M_r q'' - J_r' f = -h_r                 (6 equalities: no torque moves the root)
               torque rows   tau_min <= M_j q'' + h_j - J_j' f <= tau_max
               hinge rows    q'' bounds that keep every hinge in its range; one on its way past its end leans on the end
                             stop there, and its torque row gives room for that
               snow rows     0 <= normal force <= cap, side force within its caps

Penetration depths of the paper's program occur in no objective, so the forces themselves are the unknowns.
The sparsity never changes: edges that do not bear get zero bounds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..body import SkierModel
from ..snow import Snow, contact_points
from .dynamics import Dynamics
from .effort import Effort, Solution
from .gains import FORCE_UNIT, Gains
from .hinge_ranges import HingeRanges
from .snow_patch import ForceBounds
from .task_weights import posture_weights, ski_weights
from .tasks import Desired

ROOT_SCALE = 0.01
"""Root rows are multiplied by this so that all rows are of order one."""


@dataclass(frozen=True)
class Problem:
    """min 1/2 x'Px + q'x with lower <= Ax <= upper, in the sparsity of `Formulation`.

    `hessian` and `constraints` are the non-zeros of P's upper triangle and of A, column by column. `end_stops` (2, 31)
    is what end stops add to the torque rows of `lower` and `upper`; 0 but for hinges on their way past their ends.
    """

    hessian: np.ndarray
    gradient: np.ndarray
    constraints: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    end_stops: np.ndarray


class Formulation:
    """Builds the program of one step; owns the arrays that `Problem` shows."""

    def __init__(self, model: SkierModel, snow: Snow, gains: Gains, segments: int) -> None:
        """Lay out unknowns and rows for `segments` contact points on each of the four edges.

        `torque_lower`, `torque_upper` (31,) [N m] are the hinges' torque limits at the state of the last `build`: those
        of the muscles, and of the end stop where a hinge is on its way past the end of its range.
        """
        self.model, self.snow, self.gains, self.segments = model, snow, gains, segments
        skeleton = model.skeleton
        self.points = contact_points(skeleton.ski_length, skeleton.ski_width, segments)
        self.accelerations = len(model.body_dof)
        self.hinges = self.accelerations - 6
        self.per_ski = 4 * segments
        self.forces = 2 * self.per_ski
        self.unknowns = self.accelerations + self.forces
        self.rows = 6 + 2 * self.hinges + self.forces
        self._arms = np.zeros((2, 2 * segments, 3))
        self.snow_map = np.zeros((2, 6, self.per_ski))
        self.force_columns = np.zeros((self.accelerations, self.forces))
        self._torque_scale = 1.0 / np.maximum(-model.torque_lower, model.torque_upper)
        self._layout_tasks()
        self._layout_hessian()
        self._layout_constraints()
        self._layout_bounds()

    # -- layout, once ------------------------------------------------------------------------------------------------

    def _layout_tasks(self) -> None:
        gains, model = self.gains, self.model
        ski = ski_weights(gains, model.skeleton.ski_length, model.skeleton.ski_width)
        weights = np.array([*ski, *ski, *[gains.com.weight] * 2, *[gains.angular_momentum.weight] * 3])
        self._task_scale = np.sqrt(weights)
        self._task_rows = np.zeros((len(weights), self.accelerations))
        self._task_target = np.zeros(len(weights))
        self._posture, self._legs = posture_weights(model, gains)
        self._posture_target = np.zeros(self.accelerations)

    def _layout_hessian(self) -> None:
        from scipy import sparse

        n = self.accelerations
        pattern = np.zeros((self.unknowns, self.unknowns))
        pattern[:n, :n] = np.triu(np.ones((n, n)))
        pattern[range(n, self.unknowns), range(n, self.unknowns)] = 1.0
        self.hessian_pattern = sparse.csc_matrix(pattern)
        columns, rows = np.nonzero(pattern[:n, :n].T)
        self._hessian_index = rows * n + columns
        self._hessian = np.empty(self.hessian_pattern.nnz)
        self._hessian[len(rows) :] = self.gains.force
        self._gradient = np.zeros(self.unknowns)

    def _layout_constraints(self) -> None:
        from scipy import sparse

        n, hinges = self.accelerations, self.hinges
        pattern = np.zeros((self.rows, self.unknowns))
        pattern[:6, :] = 1.0
        pattern[6:n, :n] = self._inertia_pattern()[6:]
        for i, dof in enumerate(self.model.leg_dof):
            legs = np.searchsorted(self.model.body_dof, dof)
            pattern[np.ix_(legs, n + i * self.per_ski + np.arange(self.per_ski))] = 1.0
        pattern[n + np.arange(hinges), 6 + np.arange(hinges)] = 1.0
        pattern[n + hinges + np.arange(self.forces), n + np.arange(self.forces)] = 1.0
        self.constraint_pattern = sparse.csc_matrix(pattern)
        self._dense = np.zeros((self.rows, self.unknowns))
        self._dense[n + np.arange(hinges), 6 + np.arange(hinges)] = 1.0
        self._dense[n + hinges + np.arange(self.forces), n + np.arange(self.forces)] = 1.0
        columns, rows = np.nonzero(pattern.T)
        self._constraint_index = rows * self.unknowns + columns
        self._constraints = np.zeros(len(rows))
        self._row_scale = np.concatenate((np.full(6, ROOT_SCALE), self._torque_scale))[:, None]

    def _inertia_pattern(self) -> np.ndarray:
        """Return which degrees of freedom couple: those on one chain to the root."""
        skeleton, dof = self.model.skeleton, self.model.body_dof
        owner = np.concatenate((np.zeros(6, dtype=int), skeleton.joint_body))[dof]
        chain = [_ancestors(skeleton.parent, body) for body in owner]
        return np.array([[a in chain[j] or b in chain[i] for j, b in enumerate(owner)] for i, a in enumerate(owner)])

    def _layout_bounds(self) -> None:
        n, hinges, model = self.accelerations, self.hinges, self.model
        self._lower, self._upper = np.zeros(self.rows), np.zeros(self.rows)
        self._ranges = HingeRanges(model)
        self.torque_lower, self.torque_upper = self._ranges.torque_lower, self._ranges.torque_upper
        self._end_stops = np.zeros((2, hinges))
        self.torque_rows, self.hinge_rows = slice(6, n), slice(n, n + hinges)
        bounds = (bound[n + hinges :] for bound in (self._lower, self._upper))
        self._force_bounds = ForceBounds(model, self.snow, self.segments, *bounds)

    # -- build, each step --------------------------------------------------------------------------------------------

    def build(
        self,
        dynamics: Dynamics,
        desired: Desired,
        edge_angle: np.ndarray,
        normal: np.ndarray,
        leg_freedom: float = 1.0,
    ) -> Problem:
        """Return the program at the present state.

        `edge_angle` (2,) [rad] decides which edges bear; `normal` (3,) is the snow's; `leg_freedom` is a factor on the
        weight of the legs' pose. Raises nothing; the arrays of the returned problem are overwritten by the next call.
        """
        self._build_snow(dynamics, normal)
        self._build_cost(dynamics, desired, leg_freedom)
        self._build_hinge_bounds(dynamics)
        self._build_constraints(dynamics)
        self._force_bounds.set(edge_angle)
        return Problem(self._hessian, self._gradient, self._constraints, self._lower, self._upper, self._end_stops)

    def _build_snow(self, dynamics: Dynamics, normal: np.ndarray) -> None:
        """Fill `snow_map` (2, 6, per ski): wrench at the ski's middle by unit unknowns, and `force_columns`."""
        segments = self.segments
        for ski in range(2):
            rotation = dynamics.ski_rotation(ski)
            arms = self._arms[ski] = self.points.reshape(-1, 3) @ rotation.T  # (2 segments, 3)
            velocity = dynamics.ski_velocity[ski]
            along, across, speed = _surface_axes(rotation, velocity, normal)
            mu = self.snow.friction_coefficient(speed)
            push = (normal - mu * along) * FORCE_UNIT
            side = across * FORCE_UNIT
            block = self.snow_map[ski]
            block[:3, : 2 * segments] = push[:, None]
            block[:3, 2 * segments :] = side[:, None]
            block[3:, : 2 * segments] = _cross_matrix(push) @ arms.T
            block[3:, 2 * segments :] = _cross_matrix(side) @ arms.T
            columns = slice(ski * self.per_ski, (ski + 1) * self.per_ski)
            self.force_columns[:, columns] = dynamics.ski_jacobian[ski].T @ block

    def _build_cost(self, dynamics: Dynamics, desired: Desired, leg_freedom: float) -> None:
        rows, target, n = self._task_rows, self._task_target, self.accelerations
        mass_rows = dynamics.inertia[:3]
        for ski in range(2):
            jacobian, bias = dynamics.ski_jacobian[ski], dynamics.ski_bias[ski]
            axes, top = desired.ski_axes[ski].T, 6 * ski
            rows[top : top + 3] = jacobian[:3]
            np.dot(axes, jacobian[3:], out=rows[top + 3 : top + 6])
            target[top : top + 3] = desired.ski[ski, :3] - bias[:3]
            target[top + 3 : top + 6] = desired.ski[ski, 3:] - axes @ bias[3:]
        np.dot(desired.com_axes, mass_rows, out=rows[12:14])
        rows[12:14] /= self.model.mass
        target[12:14] = desired.com - desired.com_axes @ dynamics.com_bias
        rows[14:17] = dynamics.momentum_matrix
        target[14:17] = desired.angular_momentum_rate - dynamics.momentum_bias
        rows *= self._task_scale[:, None]
        target *= self._task_scale
        hessian = rows.T @ rows
        posture = self._posture
        if leg_freedom != 1.0:
            posture = posture.copy()
            posture[self._legs] *= leg_freedom
        hessian.reshape(-1)[:: n + 1] += posture
        self._posture_target[3:6] = desired.pelvis
        self._posture_target[6:] = desired.joints
        np.take(hessian, self._hessian_index, out=self._hessian[: len(self._hessian_index)])
        self._gradient[:n] = -(target @ rows) - posture * self._posture_target

    def _build_constraints(self, dynamics: Dynamics) -> None:
        n, dense, bias = self.accelerations, self._dense, dynamics.bias - dynamics.outside
        np.multiply(dynamics.inertia, self._row_scale, out=dense[:n, :n])
        np.multiply(self.force_columns, -self._row_scale, out=dense[:n, n:])
        np.take(dense, self._constraint_index, out=self._constraints)
        lower, upper, scale = self._lower, self._upper, self._torque_scale
        lower[:6] = upper[:6] = -ROOT_SCALE * bias[:6]
        lower[6:n] = (self.torque_lower - bias[6:]) * scale
        upper[6:n] = (self.torque_upper - bias[6:]) * scale

    def _build_hinge_bounds(self, dynamics: Dynamics) -> None:
        ranges = self._ranges
        ranges.update(dynamics)
        self._lower[self.hinge_rows], self._upper[self.hinge_rows] = ranges.lower, ranges.upper
        np.multiply(ranges.end_stops, self._torque_scale, out=self._end_stops)

    # -- read a solution ---------------------------------------------------------------------------------------------

    def snow_force(self, unknowns: np.ndarray) -> np.ndarray:
        """Return the snow's generalised force (37,) of a solution."""
        return self.force_columns @ unknowns[self.accelerations :]

    def torques(self, dynamics: Dynamics, unknowns: np.ndarray) -> np.ndarray:
        """Return the hinge torques (31,) [N m] of a solution, by the equations of motion."""
        n = self.accelerations
        known = dynamics.bias[6:] - dynamics.outside[6:]
        return (dynamics.inertia[6:] @ unknowns[:n] + known) - self.snow_force(unknowns)[6:]

    def root_residual(self, dynamics: Dynamics, unknowns: np.ndarray) -> float:
        """Return the largest error of the root's equations of motion [N or N m] at a solution."""
        n = self.accelerations
        known = dynamics.bias[:6] - dynamics.outside[:6]
        error = dynamics.inertia[:6] @ unknowns[:n] + known - self.snow_force(unknowns)[:6]
        return float(np.max(np.abs(error)))

    def edge_forces(self, unknowns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return normal and side force (2 skis, 2 edges) [N] of a solution; positive side forces push left."""
        forces = unknowns[self.accelerations :].reshape(2, 2, 2, self.segments).sum(axis=3) * FORCE_UNIT
        return forces[:, 0], forces[:, 1]

    def load_moments(self, unknowns: np.ndarray) -> np.ndarray:
        """Return, for each ski, its normal forces times their places from the ski's middle (2, 3) [N m, world]."""
        forces = unknowns[self.accelerations :].reshape(2, self.per_ski)[:, : 2 * self.segments] * FORCE_UNIT
        return np.einsum("sp,spi->si", forces, self._arms)

    def ski_forces(self, unknowns: np.ndarray) -> np.ndarray:
        """Return the snow's force on each ski (2, 3) [N, world]."""
        forces = unknowns[self.accelerations :].reshape(2, self.per_ski)
        return np.einsum("sij,sj->si", self.snow_map[:, :3], forces)

    def effort(self, dynamics: Dynamics, solution: Solution) -> Effort:
        """Return what a solution takes; torques are cut to their limits, which a rough solution may pass a little."""
        x, model = solution.unknowns, self.model
        torque = np.clip(self.torques(dynamics, x), self.torque_lower, self.torque_upper)
        edge_normal, edge_side = self.edge_forces(x)
        return Effort(
            torque=torque,
            end_stop=torque - np.clip(torque, model.torque_lower, model.torque_upper),
            snow=self.snow_force(x),
            edge_normal=edge_normal,
            edge_side=edge_side,
            load_moment=self.load_moments(x),
            ski_force=self.ski_forces(x),
            root_residual=self.root_residual(dynamics, x),
            solution=solution,
        )


def _ancestors(parent: np.ndarray, body: int) -> set[int]:
    chain = {int(body)}
    while body >= 0:
        chain.add(int(body))
        body = parent[body]
    return chain


def _cross_matrix(force: np.ndarray) -> np.ndarray:
    """Return C with C r = r x force."""
    x, y, z = force.tolist()
    return np.array(((0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0)))


def _surface_axes(
    rotation: np.ndarray, velocity: np.ndarray, normal: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Return the ski's direction of travel and its left across the edge within the snow, and its speed [m/s].

    Friction acts against the travel; side force acts across the ski [SG19 Fig. 9].
    """
    fx, fy, fz = rotation[:, 0].tolist()
    nx, ny, nz = normal.tolist()
    lx, ly, lz = ny * fz - nz * fy, nz * fx - nx * fz, nx * fy - ny * fx
    size = (lx * lx + ly * ly + lz * lz) ** 0.5
    across = np.array((lx / size, ly / size, lz / size))
    vx, vy, vz = velocity[:3].tolist()
    into = vx * nx + vy * ny + vz * nz
    vx, vy, vz = vx - into * nx, vy - into * ny, vz - into * nz
    speed = (vx * vx + vy * vy + vz * vz) ** 0.5
    along = np.array((vx, vy, vz)) / max(speed, 1e-6)
    return along, across, speed
