"""Forward kinematics of the skeleton for many configurations at once, in plain numpy."""

from __future__ import annotations

import numpy as np

from ..frames import matrix_from_quaternion, rotation_about
from .skeleton import Skeleton


def forward_kinematics(skeleton: Skeleton, qpos: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return world positions (n, 20, 3) [m] and rotations (n, 20, 3, 3) of all body frames for `qpos` (n, nq)."""
    qpos = np.asarray(qpos, dtype=float)
    count, bodies = len(qpos), len(skeleton.body_names)
    position = np.empty((count, bodies, 3))
    rotation = np.empty((count, bodies, 3, 3))
    position[:, 0] = qpos[:, :3]
    rotation[:, 0] = matrix_from_quaternion(qpos[:, 3:7])
    fixed = matrix_from_quaternion(skeleton.rotation)
    for body in range(1, bodies):
        parent = skeleton.parent[body]
        position[:, body] = position[:, parent] + rotation[:, parent] @ skeleton.offset[body]
        turned = rotation[:, parent] @ fixed[body]
        for joint in np.flatnonzero(skeleton.joint_body == body):
            axis = "xyz"[int(np.argmax(skeleton.joint_axis[joint]))]
            turned = turned @ rotation_about(axis, qpos[:, skeleton.joint_qpos[joint]])
        rotation[:, body] = turned
    return position, rotation


def centre_of_mass(skeleton: Skeleton, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Return the centre of mass (n, 3) [m] of bodies at `position` (n, 20, 3) with `rotation` (n, 20, 3, 3)."""
    centres = position + np.einsum("nbij,bj->nbi", rotation, skeleton.com)
    return np.einsum("b,nbi->ni", skeleton.mass, centres) / skeleton.mass.sum()
