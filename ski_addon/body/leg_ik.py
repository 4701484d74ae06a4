"""Analytic inverse kinematics of the six-axis leg (hip 3, knee 1, ankle 2), batched.

The knee axis is perpendicular to the line from hip to ankle and to the ankle's side axis, which is the ski's long
axis, so it is their cross product; the rest follows by the law of cosines. When the boot's side axis would leave its
range it is held at the bound and the ski keeps an edging error, which is returned.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..frames import components, matrix_from_columns, normalized
from .skeleton import Skeleton

MINIMUM_KNEE = np.deg2rad(8.0)
"""A leg straighter than this is singular: it is held here, and the missing length is reported."""
DEEPEST_KNEE = np.deg2rad(150.0)
"""No knee bends further."""
SIDE_LIMIT = np.deg2rad(5.0)
"""How far a boot lets the ankle's side axis turn."""


@dataclass(frozen=True)
class LegAngles:
    """Hinge angles of one leg, (n,) each [rad], and how far the request was out of reach.

    `thigh` (n, 3) in the order y, x, z; `shank`; `foot_y`, `foot_x`; `edge_error` [rad] is the roll of the ski that the
    boot's side axis cannot give; `length_error` [m] is how much too far (or, negative, too near) the hip is.
    """

    thigh: np.ndarray
    shank: np.ndarray
    foot_y: np.ndarray
    foot_x: np.ndarray
    edge_error: np.ndarray
    length_error: np.ndarray


def ankle_from_ski(skeleton: Skeleton, ski_position: np.ndarray, ski_rotation: np.ndarray) -> np.ndarray:
    """Return the ankle (n, 3) [m, world] above a ski at `ski_position` (n, 3) with `ski_rotation` (n, 3, 3)."""
    local = np.array([-skeleton.ankle_setback, 0.0, skeleton.ankle_height])
    return ski_position + ski_rotation @ local


def reach_of(skeleton: Skeleton) -> tuple[float, float]:
    """Return the least and the largest distance [m] from hip to ankle."""
    thigh, shank = skeleton.lengths["thigh"], skeleton.lengths["shank"]
    return _distance_at(thigh, shank, DEEPEST_KNEE), _distance_at(thigh, shank, MINIMUM_KNEE)


def solve_leg(
    skeleton: Skeleton,
    hip: np.ndarray,
    pelvis_rotation: np.ndarray,
    ankle: np.ndarray,
    foot_rotation: np.ndarray,
    side_limit: float = SIDE_LIMIT,
) -> LegAngles:
    """Solve legs from `hip` (n, 3) to `ankle` (n, 3) [m, world] for pelvis and foot rotations (n, 3, 3).

    `side_limit` [rad] bounds the ankle's side axis.
    """
    thigh_length, shank_length = skeleton.lengths["thigh"], skeleton.lengths["shank"]
    line = hip - ankle
    distance = np.linalg.norm(line, axis=-1)
    held = np.clip(distance, *reach_of(skeleton))
    up = line / distance[:, None]
    knee_axis = normalized(np.cross(up, foot_rotation[..., 0]))
    _, axis_y, axis_z = components(np.einsum("nji,nj->ni", foot_rotation, knee_axis))
    wanted_side = np.arctan2(-axis_z, axis_y)
    foot_x = np.clip(wanted_side, -side_limit, side_limit)
    cos_knee = (thigh_length**2 + shank_length**2 - held**2) / (2 * thigh_length * shank_length)
    shank_angle = np.pi - np.arccos(np.clip(cos_knee, -1.0, 1.0))
    at_ankle = np.arctan2(thigh_length * np.sin(shank_angle), shank_length + thigh_length * np.cos(shank_angle))
    forward = np.cross(knee_axis, up)
    shank_up = np.cos(at_ankle)[:, None] * up + np.sin(at_ankle)[:, None] * forward
    knee = ankle + shank_length * shank_up
    thigh_up = normalized(hip - knee)
    shank_rotation = _frame(knee_axis, shank_up)
    thigh_in_pelvis = np.swapaxes(pelvis_rotation, -1, -2) @ _frame(knee_axis, thigh_up)
    up_x, up_y, up_z = components(np.einsum("nji,nj->ni", foot_rotation, shank_rotation[..., 2]))
    foot_y = np.arctan2(-up_x, up_y * np.sin(wanted_side) + up_z * np.cos(wanted_side))
    return LegAngles(
        thigh=_euler_yxz(thigh_in_pelvis),
        shank=shank_angle,
        foot_y=foot_y,
        foot_x=foot_x,
        edge_error=wanted_side - foot_x,
        length_error=distance - held,
    )


def _distance_at(thigh: float, shank: float, knee: float) -> float:
    """Return the hip-ankle distance [m] at a knee angle [rad]."""
    return float(np.sqrt(thigh**2 + shank**2 + 2 * thigh * shank * np.cos(knee)))


def _frame(y_axis: np.ndarray, z_axis: np.ndarray) -> np.ndarray:
    return matrix_from_columns(np.cross(y_axis, z_axis), y_axis, z_axis)


def _euler_yxz(rotation: np.ndarray) -> np.ndarray:
    """Return angles (n, 3) with `rotation` = Ry Rx Rz."""
    entry = components(rotation.reshape(-1, 9))  # row by row
    x = np.arcsin(np.clip(-entry[5], -1.0, 1.0))
    y = np.arctan2(entry[2], entry[8])
    z = np.arctan2(entry[3], entry[4])
    return np.stack((y, x, z), axis=-1)
