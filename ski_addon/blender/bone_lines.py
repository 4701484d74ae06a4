"""Where the bones of a figure lie at rest: along limbs, along skis and boards, along the axles of what rolls."""

from __future__ import annotations

import numpy as np

from ..frames import Array
from .skier.figure import Figure

JOINED = ("abdomen", "chest", "head", "forearm", "hand", "shank", "foot")
"""Parts whose bones begin at the end of their parent."""
_FOLLOWING = {
    "pelvis": "abdomen",
    "abdomen": "chest",
    "chest": "head",
    "upper_arm": "forearm",
    "forearm": "hand",
    "thigh": "shank",
    "shank": "foot",
}
_AXLE_BONES = {"wheel_rear": 0.16, "wheel_front": 0.16, "crank": 0.11}
"""Length of the bones that lie along an axle [m]: turning such a bone about itself rolls the wheel."""


def is_joined(figure: Figure, body: str) -> bool:
    """Return whether the bone of `body` is connected to its parent's."""
    return body.partition(".")[0] in JOINED and body not in figure.free


def bone_line(figure: Figure, body: str) -> tuple[Array, Array, Array]:
    """Return head and tail [m] of the bone of `body` at rest, and the direction of its z axis."""
    part, _, side = body.partition(".")
    place = figure.place
    up, fore = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    if part in _FOLLOWING:
        following = _FOLLOWING[part]
        tail = place[f"{following}.{side}" if side else following]
        return place[body], tail, -fore if part in ("pelvis", "abdomen", "chest") else fore
    if body in figure.gear:
        return _gear_line(figure, body)
    h, head = figure.h, place[body]
    ends = {
        "head": (head + 0.124 * h * up, -fore),
        "hand": (head - 0.085 * h * up, fore),
        "foot": (head + np.array([0.11 * h, 0.0, 0.0]), up),
    }
    tail, z_axis = ends[part]
    return head, tail, z_axis


def _gear_line(figure: Figure, body: str) -> tuple[Array, Array, Array]:
    part = body.partition(".")[0]
    head, turn, sizes = figure.place[body], figure.turn[body], figure.sizes
    fore, left, up = turn.T
    if part in _AXLE_BONES:
        return head, head + _AXLE_BONES[part] * left, up
    ends = {
        "ski": lambda: (0.35 * figure.skeleton.ski_length * fore, up),
        "pole": lambda: (-0.9 * figure.skeleton.pole_length * up, fore),
        "board": lambda: (0.35 * sizes["length"] * fore, up),
        "frame": lambda: (0.5 * sizes["wheelbase"] * fore, up),
        "fork": lambda: (1.8 * sizes["wheel_radius"] * up, fore),
        "pedal": lambda: (0.07 * fore, up),
    }
    tail, z_axis = ends[part]()
    return head, head + tail, z_axis
