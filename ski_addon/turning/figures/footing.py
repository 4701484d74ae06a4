"""Skis and boards on the ground: every one on its own track, so that none slips sideways."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...snow import edge_lift
from .sampling import STEP, Moments, Run, traverse_lean, uneven
from .vectors import Array, columns, cross, turn_yxz, unit

BEARING = 0.35
"""Share of a ski's length from its middle to where it bears on uneven ground."""
MOST_TILT = np.deg2rad(65.0)
"""Skis and boards are never tilted further."""


@dataclass(frozen=True)
class Footing:
    """Skis or a board: `place` (m, k, 3) [m, world] of the middle of the base, `flat` (m, k, 3, 3) with x along the
    track and z up from the ground, and `turn` (m, k, 3, 3), which is `flat` tilted on edge.
    """

    place: Array
    flat: Array
    turn: Array


def stand_on(run: Run, distance: Array, across: Array, tilt: Array, length: float, width: float) -> Footing:
    """Return skis of `length` and `width` [m], `distance` (m, k) [m] along the path and `across` (k,) [m] to its left.

    `tilt` (m, k) [rad], positive to the left. A ski bridges hollows, as stiff as it is, and points along the way that
    its own middle goes; its lower edge is on the ground.
    """
    ways = np.array([-STEP, 0.0, STEP])
    track = _bridged(run, distance[..., None] + ways, across[None, :, None], BEARING * length)
    forward = unit(track[:, :, 2] - track[:, :, 0])
    place = track[:, :, 1]
    normal = run.normal(place, distance)
    left = unit(cross(normal, forward))
    flat = columns(forward, left, cross(forward, left))
    turn = flat @ turn_yxz(0.0, -tilt)
    lifted = place + edge_lift(tilt, width)[..., None] * flat[..., 2]
    return Footing(lifted, flat, turn)


def _bridged(run: Run, distance: Array, across: Array, bearing: float) -> Array:
    """Return the ground (m, k, 3, 3) that a ski of half length `bearing` [m] feels: hollows are bridged."""
    across = np.broadcast_to(across, distance.shape)
    if not uneven(run):
        return run.ground(distance, across)
    ways = np.array([-bearing, 0.0, bearing])
    places = run.ground(distance[..., None] + ways, np.broadcast_to(across[..., None], (*across.shape, 3)))
    behind, under, ahead = places[..., 0, 2], places[..., 1, 2], places[..., 2, 2]
    over = 0.5 * (behind + ahead) - under
    out = places[..., 1, :].copy()
    out[..., 2] += 0.5 * (over + np.sqrt(over * over + 4e-4)) - 0.01
    return out


def tilt_for_curvature(run: Run, curvature: Array, factor: float) -> Array:
    """Return the tilt (m,) [rad] of skis or board for their `curvature` (m,) [1/m]: linear [VP93 sec. 7].

    The constant is that of the whole motion, so that tilt and lean agree as well as they can, times `factor`.
    """
    return factor * tilt_per_curvature(run) * curvature


def tilt_per_curvature(run: Run) -> float:
    """Return the angle [rad] per curvature [1/m] that is nearest to the lean, over the whole motion (least squares)."""
    motion = run.motion
    left = unit(cross(motion.surface_normal, motion.heading_direction))
    turning = motion.lean - np.arctan2(left[:, 2], motion.surface_normal[:, 2])
    square = float(motion.curvature @ motion.curvature)
    return float(turning @ motion.curvature) / square if square > 1e-9 else 0.0


def edge_angles(moments: Moments, turning: Array, outside: float) -> Array:
    """Return the tilts (m, 2) [rad] of left and right ski for a `turning` tilt (m,), the outside one's being larger."""
    size = outside * (np.sqrt(np.square(turning) + 1e-6) - 1e-3)
    return np.stack((edge_angle(moments, turning - size), edge_angle(moments, turning + size)), axis=1)


def edge_angle(moments: Moments, turning: Array) -> Array:
    """Return the tilt (m,) [rad] from the ground: `turning`, and on a traverse what keeps the body upright.

    Past two thirds of the most a ski can be tilted it grows more slowly.
    """
    tilt = traverse_lean(moments.body) + turning
    knee = 0.67 * MOST_TILT
    past = np.maximum(np.abs(tilt) - knee, 0.0)
    return tilt - np.sign(tilt) * (past - (MOST_TILT - knee) * np.tanh(past / (MOST_TILT - knee)))
