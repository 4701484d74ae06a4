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
    `ski_velocity` (2, 6), `ski_places` (2, 3), `ski_rotations` (2, 3, 3), world from ski; `com`, `com_velocity` (3,);
    `momentum_matrix` (3, 37), `momentum_bias`, `momentum` (3,);
    `about_com` (6, 6) turns a generalised force on the root into force [N, world] and moment about the centre of mass
    [N m]; `root_rows` (6, 37) are the inertia's root rows so turned.
    """

    STATE = ("qpos", "qvel", "time")

    def __init__(self, model: SkierModel, drag_factor: float = 0.0) -> None:
        """Allocate for `model` and take a fresh MuJoCo state.

        `drag_factor` [1/m] times the squared speed is the air's deceleration of the centre of mass.
        """
        import mujoco
        from scipy.linalg import lapack

        self._mj = mujoco
        self._solve = lapack.dgesv  # numpy's own would share even four equations between threads, and wait for them
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
        self._pole_right = np.zeros((len(pole), nb + 1), order="F")
        self.ski_jacobian = np.zeros((2, 6, nb))
        self.ski_bias = np.zeros((2, 6))
        self.ski_velocity = np.zeros((2, 6))
        self.ski_places, self.ski_rotations = np.zeros((2, 3)), np.zeros((2, 3, 3))
        self._jac, self._jac_dot = np.zeros((12, nv)), np.zeros((12, nv))
        self._ski_parts = [
            (int(ski), *(jac[6 * i + k : 6 * i + k + 3] for jac in (self._jac, self._jac_dot) for k in (0, 3)))
            for i, ski in enumerate(model.ski_body)
        ]
        self.velocity = np.zeros(nb)
        d = self.data
        self.qpos, self.qvel = d.qpos, d.qvel
        self._xpos, self._xmat, self.xquat = d.xpos, d.xmat.reshape(-1, 3, 3), d.xquat
        self._qfrc_bias, self._qfrc_passive, self._subtree = d.qfrc_bias, d.qfrc_passive, d.subtree_com
        self.com = np.zeros(3)
        self.com_velocity = np.zeros(3)
        self.momentum_bias = np.zeros(3)
        self.momentum = np.zeros(3)
        self.about_com = np.eye(6)
        self.root_rows = np.zeros((6, nb))
        self.momentum_matrix = self.root_rows[3:]

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
        self.qvel.take(self.model.body_dof, out=self.velocity, mode="clip")
        self._update_skis()
        self._update_momentum()

    @property
    def time(self) -> float:
        """MuJoCo's own clock [s], which nothing here depends on."""
        return float(self.data.time)

    @time.setter
    def time(self, value: float) -> None:
        self.data.time = value

    @property
    def root_rotation(self) -> np.ndarray:
        """World rotation (3, 3) of the pelvis."""
        return self._xmat[1]

    def ski_position(self, ski: int) -> np.ndarray:
        """World position (3,) [m] of the middle of a ski's base; 0 is left."""
        return self.ski_places[ski]

    def ski_rotation(self, ski: int) -> np.ndarray:
        """World rotation (3, 3) of a ski; 0 is left."""
        return self.ski_rotations[ski]

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
        flat, right = self._flat, self._pole_right
        flat.take(self._bb, out=self.inertia.reshape(-1), mode="clip")
        flat.take(self._bp, out=self._bp_block.reshape(-1), mode="clip")
        flat.take(self._pp, out=self._pp_block.reshape(-1), mode="clip")
        net = self._qfrc_bias - self._qfrc_passive
        net -= self.applied
        right[:, :-1] = self._bp_block.T
        net.take(self.model.pole_dof, out=right[:, -1], mode="clip")
        _, _, coupling, _ = self._solve(self._pp_block, right)
        reduced = np.dot(self._bp_block, coupling)
        self.inertia -= reduced[:, :-1]
        net.take(self.model.body_dof, out=self.bias, mode="clip")
        self.bias -= reduced[:, -1]

    def _update_skis(self) -> None:
        mj, m, d, skis = self._mj, self.model.mujoco, self.data, self.model.ski_body
        self._xpos.take(skis, axis=0, out=self.ski_places, mode="clip")
        self._xmat.take(skis, axis=0, out=self.ski_rotations, mode="clip")
        for point, (ski, *parts) in zip(self.ski_places, self._ski_parts, strict=True):
            mj.mj_jac(m, d, parts[0], parts[1], point, ski)
            mj.mj_jacDot(m, d, parts[2], parts[3], point, ski)
        self._jac.take(self.model.body_dof, axis=1, out=self.ski_jacobian.reshape(12, -1), mode="clip")
        np.dot(self._jac, self.qvel, out=self.ski_velocity.reshape(-1))
        np.dot(self._jac_dot, self.qvel, out=self.ski_bias.reshape(-1))

    def _update_momentum(self) -> None:
        inertia, bias = self.inertia, self.bias
        self.com[:] = self._subtree[1]
        (cx, cy, cz), (px, py, pz) = self.com.tolist(), self._xpos[1].tolist()
        x, y, z = cx - px, cy - py, cz - pz
        about = self.about_com
        about[3:, :3] = (0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0)
        about[3:, 3:] = self._xmat[1]
        np.dot(about, inertia[:6], out=self.root_rows)
        np.dot(about[3:], bias[:6] + self.applied[:6], out=self.momentum_bias)
        np.dot(about[3:], self._full[:6] @ self.qvel, out=self.momentum)

    @property
    def com_bias(self) -> np.ndarray:
        """Part (3,) of the centre of mass's acceleration that does not depend on q'': c'' = M[0:3] q'' / m + this."""
        return (self.bias[:3] + self.applied[:3]) / self.model.mass + GRAVITY
