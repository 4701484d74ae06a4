"""The person of a figure: trunk, arms and legs placed by a few angles and by where hands and feet are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import Skeleton
from .vectors import Array, columns, cross, dot, smoothstep, turn_yxz, unit

Frames = dict[str, tuple[Array, Array]]
"""Place (m, 3) [m, world] and turn (m, 3, 3) of each body by its name."""
TRUNK = ("pelvis", "abdomen", "chest", "head")
STRAIGHT = np.deg2rad(10.0)
"""Least bend of knees and elbows: a limb straighter than this would snap through."""


@dataclass(frozen=True)
class Trunk:
    """Pelvis, abdomen, chest and head: `place` (m, 4, 3) [m, world] and `turn` (m, 4, 3, 3)."""

    place: Array
    turn: Array

    def moved(self, way: Array) -> Trunk:
        """Return the trunk moved by `way` (m, 3) [m]."""
        return Trunk(self.place + way[:, None], self.turn)


@dataclass(frozen=True)
class Limbs:
    """Arms or legs, left and right: `upper` (m, 2, 3, 3) and `lower` rotations, `joint` (m, 2, 3) of elbow or knee and
    `end` (m, 2, 3) of wrist or ankle [m, world], `last` (m, 2, 3, 3) rotation of hand or foot.
    """

    upper: Array
    lower: Array
    joint: Array
    end: Array
    last: Array


def trunk_at_origin(skeleton: Skeleton, frame: Array, roll: Array, yaw: Array, pitch: Array) -> Trunk:
    """Return the trunk with the pelvis in the origin, turned in `frame` (m, 3, 3) by angles (m, 4) [rad].

    Each body leans to the left by `roll`, then turns to the left by `yaw`, then bends forward by `pitch`, all against
    `frame`, not against the body below.
    """
    turn = frame[:, None] @ _turn_xzy(-roll, yaw, pitch)
    place = np.zeros((len(frame), 4, 3))
    for i, name in enumerate(TRUNK[1:], start=1):
        place[:, i] = place[:, i - 1] + turn[:, i - 1] @ skeleton.offset[skeleton.body(name)]
    return Trunk(place, turn)


def _turn_xzy(x: Array, z: Array, y: Array) -> Array:
    """Return rotations (..., 3, 3) Rx Rz Ry."""
    cx, sx, cz, sz, cy, sy = np.cos(x), np.sin(x), np.cos(z), np.sin(z), np.cos(y), np.sin(y)
    out = np.empty((*x.shape, 3, 3))
    out[..., 0, 0] = cz * cy
    out[..., 0, 1] = -sz
    out[..., 0, 2] = cz * sy
    out[..., 1, 0] = cx * sz * cy + sx * sy
    out[..., 1, 1] = cx * cz
    out[..., 1, 2] = cx * sz * sy - sx * cy
    out[..., 2, 0] = sx * sz * cy - cx * sy
    out[..., 2, 1] = sx * cz
    out[..., 2, 2] = sx * sz * sy + cx * cy
    return out


def sockets(skeleton: Skeleton, trunk: Trunk, part: str) -> Array:
    """Return the hips (`part` "thigh") or shoulders ("upper_arm") (m, 2, 3) [m, world]."""
    body = 0 if part == "thigh" else 2
    offset = np.stack([skeleton.offset[skeleton.body(f"{part}.{side}")] for side in "LR"])
    return trunk.place[:, body, None] + offset @ np.swapaxes(trunk.turn[:, body], -1, -2)


def solve_legs(skeleton: Skeleton, hip: Array, ankle: Array, foot: Array, twist_limit: float) -> Limbs:
    """Return legs from `hip` to `ankle` (m, 2, 3) [m, world] over feet turned as `foot` (m, 2, 3, 3).

    The knee lies ahead of the line from hip to ankle, as the foot points. It swings about that line, by `twist_limit`
    [rad] at most, until the shank stands straight over the foot: this twist of the leg takes up the difference between
    the tilt of the foot and the lean of the leg [VP93 sec. 7]. The shank turns about itself to face as the foot does.
    """
    thigh, shank = skeleton.lengths["thigh"], skeleton.lengths["shank"]
    line = hip - ankle
    distance = np.sqrt(dot(line, line))
    up = line / distance[..., None]
    toes, side = foot[..., 0], foot[..., 1]
    ahead = unit(toes - dot(toes, up)[..., None] * up)
    left = cross(up, ahead)
    along = (shank**2 - thigh**2 + distance**2) / (2.0 * distance)
    out = np.sqrt(np.maximum(shank**2 - along**2, 1e-12))
    need = -along * dot(up, side) / np.maximum(out * dot(left, side), 0.02)
    twist = twist_limit * np.tanh(need / twist_limit)
    outward = np.cos(twist)[..., None] * ahead + np.sin(twist)[..., None] * left
    knee = ankle + along[..., None] * up + out[..., None] * outward
    axis = cross(up, outward)
    lower_up = (knee - ankle) / shank
    lower_side = unit(side - dot(side, lower_up)[..., None] * lower_up)
    return Limbs(
        upper=_along(unit(hip - knee), axis),
        lower=_along(lower_up, lower_side),
        joint=knee,
        end=ankle,
        last=foot,
    )


def solve_arms(skeleton: Skeleton, shoulder: Array, grip: Array, elbow: Array, wrist: Array) -> Limbs:
    """Return arms from `shoulder` to the hands' middles at `grip` (m, 2, 3) [m, world].

    Elbows bend towards `elbow` (m, 2, 3); `wrist` (m, 2) [rad] is the hinge angle of the hand. A grip out of reach is
    not reached: the hand then lies on the way to it.
    """
    upper, fore, palm = skeleton.lengths["upper_arm"], skeleton.lengths["forearm"], 0.5 * skeleton.lengths["hand"]
    lower = np.sqrt(fore**2 + palm**2 + 2.0 * fore * palm * np.cos(wrist))
    line = grip - shoulder
    distance = np.sqrt(dot(line, line))
    ahead = line / distance[..., None]
    reach = np.sqrt(upper**2 + lower**2 + 2.0 * upper * lower * np.cos(STRAIGHT))
    distance = np.minimum(distance, reach)
    along = (upper**2 - lower**2 + distance**2) / (2.0 * distance)
    out = np.sqrt(np.maximum(upper**2 - along**2, 1e-12))
    bend = unit(elbow - dot(elbow, ahead)[..., None] * ahead)
    joint = shoulder + along[..., None] * ahead + out[..., None] * bend
    axis = cross(ahead, bend)
    reached = shoulder + distance[..., None] * ahead
    upper_turn = _along((shoulder - joint) / upper, axis)
    skew = np.arctan2(palm * np.sin(wrist), fore + palm * np.cos(wrist))
    lower_turn = _along((joint - reached) / lower[..., None], axis) @ turn_yxz(-skew)
    hand = lower_turn @ turn_yxz(wrist)
    return Limbs(upper_turn, lower_turn, joint, joint - fore * lower_turn[..., 2], hand)


def grips(skeleton: Skeleton, arms: Limbs) -> Array:
    """Return the hands' middles (m, 2, 3) [m, world], where poles and bars are held."""
    return arms.end - 0.5 * skeleton.lengths["hand"] * arms.last[..., 2]


def _along(up: Array, axis: Array) -> Array:
    """Return rotations whose z is `up` and whose y is `axis`, unit vectors (..., 3) at right angles."""
    return columns(cross(axis, up), axis, up)


def person_frames(skeleton: Skeleton, trunk: Trunk, arms: Limbs, legs: Limbs) -> Frames:
    """Return {body: (place (m, 3), turn (m, 3, 3))} of the person's 16 bodies."""
    frames = {name: (trunk.place[:, i], trunk.turn[:, i]) for i, name in enumerate(TRUNK)}
    for limb, parts in ((arms, ("upper_arm", "forearm", "hand")), (legs, ("thigh", "shank", "foot"))):
        root = sockets(skeleton, trunk, parts[0])
        for i, side in enumerate("LR"):
            frames[f"{parts[0]}.{side}"] = root[:, i], limb.upper[:, i]
            frames[f"{parts[1]}.{side}"] = limb.joint[:, i], limb.lower[:, i]
            frames[f"{parts[2]}.{side}"] = limb.end[:, i], limb.last[:, i]
    return frames


def eased(weight: Array, first: Array | float, second: Array | float) -> Array:
    """Return `first` where `weight` (...) is 0, `second` where it is 1, with an eased way between."""
    share = smoothstep(weight)
    return first + share * (second - first)
