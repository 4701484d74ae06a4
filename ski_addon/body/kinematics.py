"""Forward kinematics of the skeleton for many configurations at once, in plain numpy.

Frames are carried as their axes, each (3, n): a hinge then turns two axes within their plane, which takes a fraction
of the time of multiplying small matrices.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ..frames import matrix_from_quaternion
from .skeleton import Skeleton

CHUNK = 512
"""Configurations that are worked out at a time: more would not stay in the processor's cache."""
Axes = tuple[np.ndarray, np.ndarray, np.ndarray]


def forward_kinematics(skeleton: Skeleton, qpos: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return world positions (n, 20, 3) [m] and rotations (n, 20, 3, 3) of all body frames for `qpos` (n, nq)."""
    qpos = np.asarray(qpos, dtype=float)
    count, bodies = len(qpos), len(skeleton.body_names)
    position = np.empty((count, bodies, 3))
    rotation = np.empty((count, bodies, 3, 3))
    for first in range(0, count, CHUNK):
        part = slice(first, first + CHUNK)
        for body, (origin, axes) in body_frames(skeleton, qpos[part], range(bodies)).items():
            position[part, body] = origin.T
            for column, axis in enumerate(axes):
                rotation[part, body, :, column] = axis.T
    return position, rotation


def body_frames(skeleton: Skeleton, qpos: np.ndarray, bodies: Iterable[int]) -> dict[int, tuple[np.ndarray, Axes]]:
    """Return {body: (origin (3, n) [m], its axes x, y, z (3, n) each)} in the world for `qpos` (n, nq).

    `bodies` has every body's parent before it.
    """
    by_hinge = np.ascontiguousarray(qpos.T)
    fixed = matrix_from_quaternion(skeleton.rotation)
    frames: dict[int, tuple[np.ndarray, Axes]] = {}
    for body in bodies:
        if body == 0:
            matrix = matrix_from_quaternion(qpos[:, 3:7])
            x, y, z = (np.ascontiguousarray(matrix[:, :, column].T) for column in range(3))
            frames[0] = by_hinge[:3], (x, y, z)
            continue
        origin, axes = frames[int(skeleton.parent[body])]
        origin = origin + _combined(axes, skeleton.offset[body])
        if not np.array_equal(fixed[body], np.eye(3)):
            axes = tuple(_combined(axes, column) for column in fixed[body].T)  # type: ignore[assignment]
        for joint in np.flatnonzero(skeleton.joint_body == body):
            axes = _turned(axes, int(np.argmax(skeleton.joint_axis[joint])), by_hinge[skeleton.joint_qpos[joint]])
        frames[body] = origin, axes
    return frames


def moment_of_mass(skeleton: Skeleton, qpos: np.ndarray, bodies: Iterable[int]) -> np.ndarray:
    """Return the sum (3, n) [kg m] of mass times place of the centre of mass of `bodies`, as for `body_frames`."""
    moment = np.zeros((3, len(qpos)))
    for body, (origin, axes) in body_frames(skeleton, qpos, bodies).items():
        moment += skeleton.mass[body] * (origin + _combined(axes, skeleton.com[body]))
    return moment


def centre_of_mass(skeleton: Skeleton, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """Return the centre of mass (n, 3) [m] of bodies at `position` (n, 20, 3) with `rotation` (n, 20, 3, 3)."""
    centres = position + np.einsum("nbij,bj->nbi", rotation, skeleton.com)
    return np.einsum("b,nbi->ni", skeleton.mass, centres) / skeleton.mass.sum()


def _combined(axes: Axes, share: np.ndarray) -> np.ndarray:
    """Return the vectors (3, n) that have the components `share` (3,) along `axes`."""
    total = np.zeros_like(axes[0])
    for axis, part in zip(axes, share.tolist(), strict=True):
        if part:
            total += part * axis
    return total


def _turned(axes: Axes, about: int, angle: np.ndarray) -> Axes:
    """Return `axes` turned about one of themselves, number `about`, by `angle` (n,) [rad]."""
    first, second = (about + 1) % 3, (about + 2) % 3
    c, s = np.cos(angle), np.sin(angle)
    out = list(axes)
    out[first] = c * axes[first] + s * axes[second]
    out[second] = c * axes[second] - s * axes[first]
    return out[0], out[1], out[2]
