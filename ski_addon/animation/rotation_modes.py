"""Rotations in the modes that Blender's bones can have: quaternion, six orders of Euler angles, axis and angle."""

from __future__ import annotations

import numpy as np

from ..frames import Array, components, matrix_from_quaternion, quaternion_multiply

EULER_ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
PATHS = {"QUATERNION": "rotation_quaternion", "AXIS_ANGLE": "rotation_axis_angle"}


def rotation_path(mode: str) -> str:
    """Return the name of the property that turns a bone of rotation mode `mode`."""
    return PATHS.get(mode, "rotation_euler")


def to_mode(quaternion: Array, mode: str) -> Array:
    """Return unit quaternions (m, 4) without jumps as values (m, 4 or 3) of rotation mode `mode`, without jumps.

    Euler angles are in radians as x, y, z; axis and angle are (angle, x, y, z).
    """
    if mode == "QUATERNION":
        return quaternion
    if mode == "AXIS_ANGLE":
        half = np.arccos(np.clip(quaternion[:, :1], -1.0, 1.0))
        sine = np.sin(half)
        axis = np.where(sine > 1e-9, quaternion[:, 1:] / np.maximum(sine, 1e-9), [0.0, 1.0, 0.0])
        return np.hstack((2.0 * half, axis))
    return _euler(quaternion, mode)


def from_mode(values: Array, mode: str) -> Array:
    """Return the unit quaternions (m, 4) that `values` (m, 4 or 3) of rotation mode `mode` stand for."""
    if mode == "QUATERNION":
        return values / np.linalg.norm(values, axis=1, keepdims=True)
    if mode == "AXIS_ANGLE":
        axis = values[:, 1:] / np.maximum(np.linalg.norm(values[:, 1:], axis=1, keepdims=True), 1e-12)
        half = 0.5 * values[:, :1]
        return np.hstack((np.cos(half), np.sin(half) * axis))
    out = np.zeros((len(values), 4))
    out[:, 0] = 1.0
    for letter in mode:  # the first letter turns first
        axis = "XYZ".index(letter)
        turn = np.zeros((len(values), 4))
        turn[:, 0], turn[:, 1 + axis] = np.cos(0.5 * values[:, axis]), np.sin(0.5 * values[:, axis])
        out = quaternion_multiply(turn, out)
    return out


def _euler(quaternion: Array, order: str) -> Array:
    i, j, k = ("XYZ".index(letter) for letter in order)
    sign = 1.0 if (j - i) % 3 == 1 else -1.0
    entry = components(matrix_from_quaternion(quaternion).reshape(-1, 9)).reshape(3, 3, -1)
    middle = np.arcsin(np.clip(-sign * entry[k, i], -1.0, 1.0))
    first = np.arctan2(sign * entry[k, j], entry[k, k])
    last = np.arctan2(sign * entry[j, i], entry[i, i])
    found = np.empty((2, len(quaternion), 3))
    found[0, :, i], found[0, :, j], found[0, :, k] = first, middle, last
    found[1, :, i], found[1, :, j], found[1, :, k] = first + np.pi, np.pi - middle, last + np.pi
    out = found[0].copy()
    for row in range(1, len(out)):  # of the two ways to say a rotation, and their whole turns, the nearest
        near = found[:, row] + 2.0 * np.pi * np.round((out[row - 1] - found[:, row]) / (2.0 * np.pi))
        out[row] = near[np.argmin(np.abs(near - out[row - 1]).sum(axis=1))]
    return out
