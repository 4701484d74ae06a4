"""Legs of other lengths on the recorded skis: where the pelvis goes, and how hip and knee bend. Batched."""

from __future__ import annotations

import numpy as np

from ..frames import Array, matrix_from_columns, normalized

STRAIGHTEST = 0.99999
"""A leg is at most this part of its length long from hip to ankle, so that its knee keeps a direction."""
MARGIN = 4e-6
ROUNDS = 40
"""Steps that bring a pelvis within reach of both ankles; each halves what is missing, or better."""


def place_pelvis(hip_wanted: Array, hip_from_pelvis: Array, ankle: Array, length: Array | None) -> Array:
    """Return the pelvis (m, 3) [m] that serves both legs equally.

    `hip_wanted` (m, 2, 3) is where each leg would have its hip, `hip_from_pelvis` (m, 2, 3) where the hips are against
    the pelvis, `ankle` (m, 2, 3). With the `length` (2,) of the legs the pelvis is moved, as little as need be, until
    both reach their ankles.
    """
    pelvis = (hip_wanted - hip_from_pelvis).mean(axis=1)
    if length is None:
        return pelvis
    limit = (STRAIGHTEST - MARGIN) * length
    for _ in range(ROUNDS):
        line = pelvis[:, None] + hip_from_pelvis - ankle
        distance = np.linalg.norm(line, axis=-1)
        excess = np.maximum(distance - limit, 0.0)
        if excess.max() < MARGIN * limit.min():
            break
        pelvis = pelvis - 0.5 * (line * (excess / distance)[..., None]).sum(axis=1)
    return pelvis


def reach(hip: Array, ankle: Array, knee_axis: Array, thigh: float, shank: float) -> tuple[Array, Array, Array]:
    """Return the world axes (m, 3, 3) of thigh and shank that lead from `hip` to `ankle` (m, 3), and the miss (m,) [m].

    The knee lies ahead in the plane across `knee_axis` (m, 3), the left axis of the recorded thigh. Lengths in m.
    """
    line = hip - ankle
    distance = np.linalg.norm(line, axis=-1)
    held = np.clip(distance, abs(thigh - shank) + 1e-3 * (thigh + shank), STRAIGHTEST * (thigh + shank))
    up = line / distance[:, None]
    axis = normalized(knee_axis - np.sum(knee_axis * up, axis=-1, keepdims=True) * up)
    cosine = np.clip((held**2 + shank**2 - thigh**2) / (2.0 * held * shank), -1.0, 1.0)
    sine = np.sqrt(1.0 - cosine**2)
    shank_up = cosine[:, None] * up + sine[:, None] * np.cross(axis, up)
    thigh_up = normalized(held[:, None] * up - shank * shank_up)
    return _axes(axis, thigh_up), _axes(axis, shank_up), np.abs(distance - held)


def _axes(left: Array, up: Array) -> Array:
    return matrix_from_columns(np.cross(left, up), left, up)
