"""Figures that stand: legs as springs, and the pelvis where the centre of mass lies on the line of the lean."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import Skeleton
from ...spec import FigureSpec
from .person import Trunk, sockets
from .sampling import Moments
from .vectors import Array, apply, bend_at, distance_at, dot, soft_clip

STRAIGHTEST, DEEPEST = np.deg2rad(14.0), np.deg2rad(106.0)
"""Knee bends between which the legs spring."""
ARM_PLACE = (0.10, 0.0, 0.10)
"""Where the arms' common centre of mass is taken to be in the chest's frame, in statures."""


@dataclass(frozen=True)
class Legs:
    """Legs as springs: the distance from hip to ankle `length` (m,) [m] and the knee bend `knee` (m,) [rad] of a leg of
    that length.
    """

    length: Array
    knee: Array


def spring_legs(skeleton: Skeleton, figure: FigureSpec, moments: Moments, knee: float) -> Legs:
    """Return legs whose knees bend by `knee` [rad] under one body weight and shorten with the force [VP93 sec. 7].

    The length is the static one less (force - 1) / k_s. Bumps shorten them, too: the body keeps to the smooth course.
    """
    thigh, shank = skeleton.lengths["thigh"], skeleton.lengths["shank"]
    rest = float(distance_at(thigh, shank, knee))
    wanted = rest - (moments.force - 1.0) / figure.leg_stiffness + moments.smooth
    low, high = (float(distance_at(thigh, shank, bend)) for bend in (DEEPEST, STRAIGHTEST))
    length = soft_clip(wanted, low, high, 0.01 * skeleton.height)
    return Legs(length, bend_at(thigh, shank, length))


def lean_line(moments: Moments) -> Array:
    """Return the direction (m, 3) from the support to the centre of mass: the leg of the turning body."""
    sine, cosine = np.sin(moments.lean)[:, None], np.cos(moments.lean)[:, None]
    return sine * moments.body[..., 1] + cosine * moments.body[..., 2]


def place_pelvis(
    skeleton: Skeleton, trunk: Trunk, support: Array, line: Array, ankle: Array, foot: Array, length: Array
) -> Array:
    """Return the pelvis (m, 3) [m, world] of a `trunk` at the origin, with the centre of mass on `line` from `support`.

    `ankle` (m, 2, 3) and `foot` (m, 2, 3, 3) are where the feet stand, `length` (m,) [m] how far the hips are from the
    ankles. Legs that would not reach are brought nearer.
    """
    share, rest = _balance(skeleton, trunk, ankle, foot, length)
    hip = sockets(skeleton, trunk, "thigh")  # from the pelvis
    middle_hip, middle = 0.5 * (hip[:, 0] + hip[:, 1]), 0.5 * (ankle[:, 0] + ankle[:, 1])
    start = (support - rest) / share + middle_hip - middle  # hips over the ankles, at 0 along the line
    reach = float(distance_at(skeleton.lengths["thigh"], skeleton.lengths["shank"], STRAIGHTEST))
    along = dot(start, line)
    aside = dot(start, start) - along * along
    held = length
    for _ in range(3):
        rise = -along + np.sqrt(np.maximum(held * held - aside, 0.04 * held * held))
        pelvis = start + rise[:, None] * line + middle - middle_hip
        legs = pelvis[:, None] + hip - ankle
        past = np.sqrt(dot(legs, legs)).max(axis=1) - reach
        if not np.any(past > 0.0):
            break
        held = held - np.maximum(past, 0.0) * 1.3
    return pelvis


def _balance(skeleton: Skeleton, trunk: Trunk, ankle: Array, foot: Array, length: Array) -> tuple[Array, Array]:
    """Return `share` (m, 1) and `rest` (m, 3) with which the centre of mass is share * pelvis + rest."""
    mass = {name: float(skeleton.mass[i]) for i, name in enumerate(skeleton.body_names)}
    arms = 2.0 * sum(mass[f"{part}.L"] for part in ("upper_arm", "forearm", "hand"))
    thigh_mass, shank_mass, foot_mass = (mass[f"{part}.L"] for part in ("thigh", "shank", "foot"))
    weights = [mass[name] for name in ("pelvis", "abdomen", "chest", "head")]
    total = sum(weights) + arms + 2.0 * (thigh_mass + shank_mass + foot_mass)
    rest = weights[0] * apply(trunk.turn[:, 0], skeleton.com[0])
    for i, name in enumerate(("abdomen", "chest", "head"), start=1):
        centre = skeleton.com[skeleton.body(name)]
        rest = rest + weights[i] * (trunk.place[:, i] + apply(trunk.turn[:, i], centre))
    arm = np.array(ARM_PLACE) * skeleton.height
    rest = rest + arms * (trunk.place[:, 2] + apply(trunk.turn[:, 2], arm))
    hips = sockets(skeleton, trunk, "thigh")
    thigh, shank = skeleton.lengths["thigh"], skeleton.lengths["shank"]
    at_knee = (shank**2 - thigh**2 + length**2) / (2.0 * length)
    out = np.sqrt(np.maximum(shank**2 - at_knee**2, 0.0))
    thigh_up = 1.0 + skeleton.com[skeleton.body("thigh.L"), 2] / thigh  # 0 at the knee, 1 at the hip
    shank_up = 1.0 + skeleton.com[skeleton.body("shank.L"), 2] / shank
    knee_share = (at_knee / length)[:, None]
    by_knee = thigh_mass * (1.0 - thigh_up) + shank_mass * shank_up
    pelvis_share = sum(weights) + arms
    by_hip = 2.0 * (thigh_mass * thigh_up) + 2.0 * by_knee * knee_share
    for i in range(2):
        knee = ankle[:, i] + knee_share * (hips[:, i] - ankle[:, i]) + out[:, None] * foot[:, i, :, 0]
        rest = rest + thigh_mass * thigh_up * hips[:, i] + by_knee * knee
        rest = rest + (shank_mass * (1.0 - shank_up) + foot_mass) * ankle[:, i]
    return (pelvis_share + by_hip) / total, rest / total
