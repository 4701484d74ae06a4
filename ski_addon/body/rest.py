"""The skeleton at rest: upright, arms hanging, ski bases on z = 0, the pelvis above the origin."""

from __future__ import annotations

import numpy as np

from .kinematics import forward_kinematics
from .skeleton import Skeleton


def rest_configuration(skeleton: Skeleton) -> np.ndarray:
    """Return the zero configuration (nq,) with the ski bases at z = 0 and the pelvis above the origin."""
    qpos = np.zeros(skeleton.nq)
    qpos[3] = 1.0
    position, _ = forward_kinematics(skeleton, qpos[None])
    qpos[2] = -float(position[0, skeleton.body("ski.L"), 2])
    return qpos


def rest_frames(skeleton: Skeleton) -> tuple[np.ndarray, np.ndarray]:
    """Return `place` (20, 3) [m] and `turn` (20, 3, 3) of all body frames at rest."""
    position, rotation = forward_kinematics(skeleton, rest_configuration(skeleton)[None])
    return position[0], rotation[0]
