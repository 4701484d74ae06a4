"""What the controller needs from the model at one state: inertia, bias, Jacobians, momentum.

The poles are passive, so their accelerations follow from the others'. They are eliminated exactly,

    M = M_bb - M_bp M_pp^-1 M_pb,     h = h_b - M_bp M_pp^-1 (h_p - passive_p),

and the controller sees 37 degrees of freedom. Root rows of M and h give the centre of mass and the angular momentum
about it for nothing: m c'' = M[0:3] q'' + h[0:3] + m g and, with the root's rotation R and position p,
k' = R (M[3:6] q'' + h[3:6]) - (c - p) x (M[0:3] q'' + h[0:3]).
"""

from __future__ import annotations

import math

import numpy as np

from ..body import SkierModel
from ..gravity import GRAVITY


class Dynamics:
    """Dynamics at the present state of `data`; arrays are overwritten by every `update`.

    `inertia` (37, 37) and `bias` (37,) after elimination of the poles (bias includes gravity and -`applied`);
    `applied` (nv,) generalised air drag; `outside` (37,) a generalised force from outside as felt, which the controller
    reckons with and forward dynamics does not;
    `ski_jacobian` (2, 6, 37) and `ski_bias` (2, 6) of the ski centres, linear then angular, world axes;
    `ski_velocity` (2, 6); `com`, `com_velocity` (3,); `momentum_matrix` (3, 37), `momentum_bias`, `momentum` (3,).
    """

    def __init__(self, model: SkierModel, drag_factor: float = 0.0) -> None:
        """Allocate for `model` and take a fresh MuJoCo state.

        `drag_factor` [1/m] times the squared speed is the air's deceleration of the centre of mass.
        """
        import mujoco

        self._mj = mujoco
        self.model = model
        self.drag_factor = drag_factor
        self.data = model.new_data()
        nv = model.mujoco.nv
        body, pole = model.body_dof, model.pole_dof
        self._full = np.zeros((nv, nv))
        self._flat = self._full.reshape(-1)
        self._bb = (body[:, None] * nv + body).ravel()
        self._bp = (body[:, None] * nv + pole).ravel()
        self._pp = (pole[:, None] * nv + pole).ravel()
        nb = len(body)
        self.inertia = np.zeros((nb, nb))
        self.bias = np.zeros(nb)
        self.applied = np.zeros(nv)
        self.outside = np.zeros(nb)
        self._bp_block = np.zeros((nb, len(pole)))
        self._pp_block = np.zeros((len(pole), len(pole)))
        self._pole_coupling = np.zeros((len(pole), nb))
        self.ski_jacobian = np.zeros((2, 6, nb))
        self.ski_bias = np.zeros((2, 6))
        self.ski_velocity = np.zeros((2, 6))
        self._jac = np.zeros((6, nv))
        self._jac_dot = np.zeros((6, nv))
        self.velocity = np.zeros(nb)
        d = self.data
        self.qpos, self.qvel = d.qpos, d.qvel
        self._xpos, self._xmat, self.xquat = d.xpos, d.xmat.reshape(-1, 3, 3), d.xquat
        self._qfrc_bias, self._qfrc_passive, self._subtree = d.qfrc_bias, d.qfrc_passive, d.subtree_com
        self.com = np.zeros(3)
        self.com_velocity = np.zeros(3)
        self.momentum_matrix = np.zeros((3, nb))
        self.momentum_bias = np.zeros(3)
        self.momentum = np.zeros(3)
        self._skew = np.zeros((3, 3))

    def update(self) -> None:
        """Recompute everything from `data.qpos` and `data.qvel`."""
        mj, m, d = self._mj, self.model.mujoco, self.data
        mj.mj_fwdPosition(m, d)
        mj.mj_fwdVelocity(m, d)
        mj.mj_fullM(m, d, self._full)
        np.dot(self._full[:3], self.qvel, out=self.com_velocity)
        self.com_velocity /= self.model.mass
        self._apply_drag()
        self._eliminate_poles()
        np.take(self.qvel, self.model.body_dof, out=self.velocity)
        self._update_skis()
        self._update_momentum()

    @property
    def root_rotation(self) -> np.ndarray:
        """World rotation (3, 3) of the pelvis."""
        return self._xmat[1]

    def ski_position(self, ski: int) -> np.ndarray:
        """World position (3,) [m] of the middle of a ski's base; 0 is left."""
        return self._xpos[self.model.ski_body[ski]]

    def ski_rotation(self, ski: int) -> np.ndarray:
        """World rotation (3, 3) of a ski; 0 is left."""
        return self._xmat[self.model.ski_body[ski]]

    def body_position(self, body: int) -> np.ndarray:
        """World position (3,) [m] of a MuJoCo body's frame."""
        return self._xpos[body]

    def accelerations(self, torque: np.ndarray, snow: np.ndarray, push: np.ndarray | None = None) -> np.ndarray:
        """Return q'' (nv,) under hinge torques (31,) [N m] and snow's generalised force `snow` (37,): forward dynamics
        of the whole model, poles included. `push` (nv,) is a generalised force the controller knows nothing of.
        """
        model = self.model
        force = self.applied + self._qfrc_passive - self._qfrc_bias
        force[model.actuated_dof] += torque
        force[model.body_dof] += snow
        if push is not None:
            force += push
        out = np.zeros((1, len(force)))
        self._mj.mj_solveM(model.mujoco, self.data, out, force[None])
        return out[0]

    def integrate(self, acceleration: np.ndarray, time_step: float) -> None:
        """Advance velocity, then position (semi-implicit Euler), by `time_step` [s]."""
        d = self.data
        self.qvel += time_step * acceleration
        self._mj.mj_integratePos(self.model.mujoco, self.qpos, self.qvel, time_step)
        d.time += time_step

    def _apply_drag(self) -> None:
        velocity = self.com_velocity
        np.dot(velocity, self._full[:3], out=self.applied)
        self.applied *= -self.drag_factor * math.sqrt(velocity @ velocity)

    def _eliminate_poles(self) -> None:
        flat, pole, body = self._flat, self.model.pole_dof, self.model.body_dof
        np.take(flat, self._bb, out=self.inertia.reshape(-1))
        np.take(flat, self._bp, out=self._bp_block.reshape(-1))
        np.take(flat, self._pp, out=self._pp_block.reshape(-1))
        net = self._qfrc_bias - self._qfrc_passive - self.applied
        inverse = np.linalg.inv(self._pp_block)
        np.dot(inverse, self._bp_block.T, out=self._pole_coupling)
        self.inertia -= self._bp_block @ self._pole_coupling
        np.take(net, body, out=self.bias)
        self.bias -= self._bp_block @ (inverse @ net[pole])

    def _update_skis(self) -> None:
        mj, m, d = self._mj, self.model.mujoco, self.data
        jac, jac_dot, body = self._jac, self._jac_dot, self.model.body_dof
        for i, ski in enumerate(self.model.ski_body.tolist()):
            point = self._xpos[ski]
            mj.mj_jac(m, d, jac[:3], jac[3:], point, ski)
            mj.mj_jacDot(m, d, jac_dot[:3], jac_dot[3:], point, ski)
            np.take(jac, body, axis=1, out=self.ski_jacobian[i])
            np.dot(jac, self.qvel, out=self.ski_velocity[i])
            np.dot(jac_dot, self.qvel, out=self.ski_bias[i])

    def _update_momentum(self) -> None:
        inertia, bias = self.inertia, self.bias
        self.com[:] = self._subtree[1]
        x, y, z = (self.com - self._xpos[1]).tolist()
        skew = self._skew
        skew[0, 1], skew[0, 2], skew[1, 2] = -z, y, -x
        skew[1, 0], skew[2, 0], skew[2, 1] = z, -y, x
        rotation = self._xmat[1]
        self.momentum_matrix[:] = rotation @ inertia[3:6] - skew @ inertia[:3]
        known = self.applied
        self.momentum_bias[:] = rotation @ (bias[3:6] + known[3:6]) - skew @ (bias[:3] + known[:3])
        self.momentum[:] = rotation @ (self._full[3:6] @ self.qvel) - skew @ (self._full[:3] @ self.qvel)

    @property
    def com_bias(self) -> np.ndarray:
        """Part (3,) of the centre of mass's acceleration that does not depend on q'': c'' = M[0:3] q'' / m + this."""
        return (self.bias[:3] + self.applied[:3]) / self.model.mass + GRAVITY
