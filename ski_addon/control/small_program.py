"""The controller's program as one small system: the fast way, exact while no muscle and no hinge is at a limit.

`formulation.py` writes the program down plainly, with 77 or more unknowns and rows; this file solves the same one. See
docs/control_step.md for the derivation. In short, with the root's equations of motion written about the centre of mass

    A q'' + h = w,      w = B f     (6 rows: m c'' and the angular momentum's rate, from what snow pushes),

the tasks of centre of mass and angular momentum depend on the wrench w alone, 1/2 (w - w*)' C (w - w*), and all others
on q'' alone, 1/2 q'' P q'' - g' q''. For multipliers y of the six rows both are minimised in closed form, and with
z = y + C (w - w*) what is left are six equations for z (`dual.py`):

    K z + k = B f(z),     S = A P^-1 A',   (I + S C) K = S,   (I + S C) k = A P^-1 g + h + S C w*.

Torques follow from the equations of motion. Where one is beyond its limit, or a hinge's acceleration is, the answer is
not that of the whole program, and there is none from here.
"""

from __future__ import annotations

import numpy as np

from ..body import SkierModel
from ..gravity import GRAVITY
from ..snow import Snow
from .dual import DualNewton
from .dynamics import Dynamics
from .effort import Effort, Solution
from .gains import Gains
from .hinge_ranges import HingeRanges
from .snow_patch import SnowPatch
from .task_weights import posture_weights, ski_weights
from .tasks import Desired


class SmallProgram:
    """Builds and solves the program of one step; owns its arrays, and begins its search at the last multipliers."""

    STATE = ("_z",)

    def __init__(self, model: SkierModel, snow: Snow, gains: Gains, segments: int) -> None:
        """Reserve room for `segments` contact points on each of the four edges."""
        from scipy.linalg import blas, lapack

        # none of these shares so small a system between threads; numpy's own, and dtrtrs, do, and wait for them
        self._add_squares, self._factor, self._solve = blas.dsyrk, lapack.dpotrf, lapack.dgesv
        self._forward, self._back = blas.dtrsm, blas.dtrsv
        self._model = model
        self.patch, self.ranges = SnowPatch(model, snow, segments), HingeRanges(model)
        self._newton = DualNewton(self.patch.count, gains.force)
        n = len(model.body_dof)
        scale = np.sqrt(ski_weights(gains, model.skeleton.ski_length, model.skeleton.ski_width))
        self._scale = np.tile(scale, 2)
        self._mixing = np.diag(self._scale)  # of world rows into scaled rows in the skis' own axes
        self._spin_scale = scale[3:, None]
        self._rows, self._target = np.zeros((12, n)), np.zeros((2, 6))
        self._posture, self._legs = posture_weights(model, gains)
        self._posture_target = np.zeros(n)
        self._hessian, self._columns = np.zeros((n, n), order="F"), np.zeros((n, 7), order="F")
        self._diagonal = np.zeros((n, n), order="F")
        np.fill_diagonal(self._diagonal, self._posture)
        self._momentum_weight = gains.angular_momentum.weight
        self._com_weight = gains.com.weight / model.mass**2
        self._cost = self._momentum_weight * np.eye(6)
        self._wish = np.zeros(6)
        self._identity = np.eye(6)
        self._z = np.zeros(6)

    def solve(
        self,
        dynamics: Dynamics,
        desired: Desired,
        edge_angle: np.ndarray,
        normal: np.ndarray,
        leg_freedom: float = 1.0,
    ) -> Effort | None:
        """Return the solution at the present state, or None where it cannot be had this way: when a torque or a hinge's
        acceleration would be beyond its limits, or Newton's method does not converge.

        `edge_angle` (2,) [rad] decides which edges bear; `normal` (3,) is the snow's; `leg_freedom` is a factor on the
        weight of the legs' pose.
        """
        patch = self.patch
        patch.place(dynamics, normal)
        patch.set_bounds(edge_angle)
        self._build_body(dynamics, desired, leg_freedom)
        K, k = self._six_equations(dynamics, desired)
        answer = self._newton.solve(K, k, patch.wrenches, patch.lower, patch.upper, self._z)
        self._z[:] = answer.z if answer.converged else 0.0
        if not answer.converged:
            return None
        y = answer.z - self._cost @ (patch.wrenches @ answer.forces) + self._wish
        return self._effort(dynamics, self._acceleration(y), answer.forces, answer.steps)

    def _build_body(self, dynamics: Dynamics, desired: Desired, leg_freedom: float) -> None:
        """Factor P = L L' of all tasks that depend on accelerations, and leave L^-1 [A' g] in `_columns`."""
        rows, columns, mixing, target = self._rows, self._columns, self._mixing, self._target
        np.subtract(desired.ski, dynamics.ski_bias, out=target)
        for ski in range(2):
            axes, spin = desired.ski_axes[ski].T, slice(6 * ski + 3, 6 * ski + 6)
            np.multiply(axes, self._spin_scale, out=mixing[spin, spin])
            target[ski, 3:] = desired.ski[ski, 3:] - axes @ dynamics.ski_bias[ski, 3:]
        np.dot(mixing, dynamics.ski_jacobian.reshape(12, -1), out=rows)
        posture = self._posture
        if leg_freedom != 1.0:
            posture = posture.copy()
            posture[self._legs] *= leg_freedom
        hessian = self._hessian
        hessian[:] = self._diagonal
        if leg_freedom != 1.0:
            np.fill_diagonal(hessian, posture)
        self._add_squares(1.0, rows.T, beta=1.0, c=hessian, lower=1, overwrite_c=1)
        self._posture_target[3:6] = desired.pelvis
        self._posture_target[6:] = desired.joints
        columns[:, :6] = dynamics.root_rows.T
        np.dot(target.reshape(12) * self._scale, rows, out=columns[:, 6])
        columns[:, 6] += posture * self._posture_target
        self._factor(hessian, lower=1, clean=0, overwrite_a=1)
        self._forward(1.0, hessian, columns, lower=1, overwrite_b=1)

    def _six_equations(self, dynamics: Dynamics, desired: Desired) -> tuple[np.ndarray, np.ndarray]:
        """Return K (6, 6) and k (6,), and set the wrench's cost C and the wish C w*."""
        cost, wish, axes, mass = self._cost, self._wish, desired.com_axes, self._model.mass
        outside = dynamics.about_com @ (dynamics.outside[:6] + dynamics.applied[:6])
        cost[:3, :3] = self._com_weight * axes.T @ axes
        wanted = mass * (desired.com - axes @ GRAVITY) - axes @ outside[:3]
        wish[:3] = self._com_weight * wanted @ axes
        wish[3:] = self._momentum_weight * (desired.angular_momentum_rate - outside[3:])
        products = self._columns.T @ self._columns
        S = products[:6, :6]
        right = np.empty((6, 7))
        right[:, :6] = S
        known = dynamics.about_com @ (dynamics.bias[:6] - dynamics.outside[:6])
        right[:, 6] = products[:6, 6] + known + S @ wish
        _, _, solved, _ = self._solve(self._identity + S @ cost, right)
        return solved[:, :6], solved[:, 6]

    def _acceleration(self, y: np.ndarray) -> np.ndarray:
        """Return q'' (37,) = P^-1 (g + A' y)."""
        half = self._columns[:, 6] + self._columns[:, :6] @ y
        return self._back(self._hessian, half, lower=1, trans=1, overwrite_x=1)

    def _effort(self, dynamics: Dynamics, acceleration: np.ndarray, forces: np.ndarray, steps: int) -> Effort | None:
        """Return what the solution takes, or None when it takes too much."""
        ranges, patch, hinges = self.ranges, self.patch, acceleration[6:]
        ranges.update(dynamics)
        if bool((hinges < ranges.lower).any()) or bool((hinges > ranges.upper).any()):
            return None
        wrench = patch.ski_wrenches(forces)
        snow = wrench.reshape(12) @ dynamics.ski_jacobian.reshape(12, -1)
        force = dynamics.inertia @ acceleration + (dynamics.bias - dynamics.outside) - snow
        torque = force[6:]
        if bool((torque < ranges.torque_lower).any()) or bool((torque > ranges.torque_upper).any()):
            return None
        edges = patch.edge_forces(forces)
        return Effort(
            torque=torque,
            end_stop=ranges.end_stop(torque),
            snow=snow,
            edge_normal=edges[:, 0],
            edge_side=edges[:, 1],
            load_moment=patch.load_moments(dynamics, forces),
            ski_force=wrench[:, :3],
            root_residual=max(map(abs, force[:6].tolist())),
            solution=Solution(np.concatenate((acceleration, forces)), steps, 0, 1),
        )
