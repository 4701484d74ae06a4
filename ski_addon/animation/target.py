"""The measures of a foreign armature at rest: where its joints are and how each part of its body is turned."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..body.skeleton import BODY_NAMES, SIDES
from ..errors import SpecError
from ..frames import Array, matrix_from_columns, normalized
from .bone_map import BoneMap

REQUIRED = ("pelvis", *(f"{part}.{side}" for side in SIDES for part in ("thigh", "shank", "foot")))
"""Bodies that need a bone: without them a figure cannot be put on its skis."""
UPRIGHT = np.cos(np.radians(20.0))
"""Cosine of how far the legs at rest may lean away from an axis of the armature."""
USUAL_ANKLE = (0.02, 0.35)
"""Heights of the ankle at rest, in leg lengths, between which the armature's origin is taken for the floor."""


@dataclass(frozen=True)
class TargetRest:
    """An armature at rest, in armature space: `bones` (n,) names with parents before children, `parent` (n,) or -1,
    `matrix` (n, 4, 4) rest matrices, `tail` (n, 3), and `turns` (n,) whether a bone turns with its parent.
    """

    bones: tuple[str, ...]
    parent: Array
    matrix: Array
    tail: Array
    turns: Array

    def head(self, bone: str) -> Array:
        """Return where `bone` begins (3,)."""
        return self.matrix[self.bones.index(bone), :3, 3]

    def end(self, bone: str) -> Array:
        """Return where `bone` ends (3,)."""
        return self.tail[self.bones.index(bone)]


@dataclass(frozen=True)
class TargetBody:
    """The body of an armature at rest, in armature space and units.

    `main` {body: bone that is the body}; `frame` {body: (3, 3)} its axes fore, left and up of the upright figure with
    hanging arms, as they lie in the rest pose (in a T-pose the arm's up axis points from hand to shoulder); `thigh`,
    `shank` (2,) lengths, left first; `ankle_height` of the ankles above the soles; `ground` (3,) between the soles.
    """

    main: Mapping[str, str]
    frame: Mapping[str, Array]
    thigh: Array
    shank: Array
    ankle_height: float
    ground: Array

    @property
    def leg(self) -> float:
        """Mean length of a leg from hip to ankle."""
        return float(np.mean(self.thigh + self.shank))


def measure_target(bone_map: BoneMap, rest: TargetRest, name: str = "the armature") -> TargetBody:
    """Return the measures of an armature whose bones `bone_map` names all exist; `name` is for messages.

    Raises `SpecError` if a leg has no bone or no length, or if the rest pose does not stand upright facing forwards.
    """
    bone_map.check(rest.bones, BODY_NAMES)
    main = main_bones(bone_map)
    for body in REQUIRED:
        if body not in main:
            hint = f"name it in the bone map {bone_map.name}, or choose the map made for this armature"
            raise SpecError(name, body, "", hint, problem="has no bone for")
    hip, knee, ankle = (np.array([rest.head(main[f"{p}.{s}"]) for s in SIDES]) for p in ("thigh", "shank", "foot"))
    thigh, shank = np.linalg.norm(hip - knee, axis=1), np.linalg.norm(knee - ankle, axis=1)
    if min(thigh.min(), shank.min()) < 1e-6 or np.linalg.norm(hip[0] - hip[1]) < 1e-6:
        raise SpecError(name, None, "", "check which bones the map calls thigh, shank and foot", problem="has no legs")
    standing = _standing_frame(hip, ankle, name)
    frame = _frames(bone_map, rest, main, standing)
    _check_facing(frame, standing, name)
    height = _ankle_height(bone_map, rest, ankle, standing[:, 2], float(np.mean(thigh + shank)))
    ground = ankle.mean(axis=0) - height * standing[:, 2]
    return TargetBody(main, frame, thigh, shank, height, ground)


def main_bones(bone_map: BoneMap) -> dict[str, str]:
    """Return {body: bone}: of the bones that turn fully with a body, the first."""
    main: dict[str, str] = {}
    for entry in bone_map.entries:
        if entry.share == 1.0:
            main.setdefault(entry.body, entry.bone)
    return main


def _standing_frame(hip: Array, ankle: Array, name: str) -> Array:
    """Return fore, left and up of the figure as columns: up is the armature's axis along which the legs stand."""
    up = normalized((hip - ankle).mean(axis=0))
    axis = int(np.argmax(np.abs(up)))
    if abs(up[axis]) < UPRIGHT:
        hint = "its legs must stand along X, Y or Z: apply the rest pose upright"
        raise SpecError(name, tuple(np.round(up, 2).tolist()), "", hint, problem="at rest has its legs along")
    up = np.sign(up[axis]) * np.eye(3)[axis]
    left = hip[0] - hip[1]
    left = normalized(left - (left @ up) * up)
    return matrix_from_columns(np.cross(left, up), left, up)


def _frames(bone_map: BoneMap, rest: TargetRest, main: Mapping[str, str], standing: Array) -> dict[str, Array]:
    """Return the axes of every body: each limb is its parent's frame swung, without twist, to its own line."""
    frame = dict.fromkeys(BODY_NAMES, standing)
    for side in SIDES:
        upper = standing
        for part, following in (("upper_arm", "forearm"), ("forearm", "hand")):
            upper = frame[f"{part}.{side}"] = _swing(upper, _line(rest, main, f"{part}.{side}", f"{following}.{side}"))
        frame[f"hand.{side}"] = upper
        upper = standing
        for part, following in (("thigh", "shank"), ("shank", "foot")):
            upper = frame[f"{part}.{side}"] = _swing(upper, _line(rest, main, f"{part}.{side}", f"{following}.{side}"))
        frame[f"foot.{side}"] = frame[f"ski.{side}"] = _foot_frame(bone_map, rest, main[f"foot.{side}"], side, standing)
        frame[f"pole.{side}"] = _swing(standing, _line(rest, main, f"pole.{side}", ""))
    return frame


def _line(rest: TargetRest, main: Mapping[str, str], body: str, following: str) -> Array | None:
    """Return the direction (3,) from the far joint of `body` to the near one, or None for a body without a bone."""
    if body not in main:
        return None
    far = rest.head(main[following]) if following in main else rest.end(main[body])
    return normalized(rest.head(main[body]) - far)


def _swing(frame: Array, up: Array | None) -> Array:
    """Return `frame` (3, 3) turned the shortest way that lays its up axis along `up`."""
    if up is None:
        return frame
    axis, cosine = np.cross(frame[:, 2], up), float(frame[:, 2] @ up)
    if cosine < -1.0 + 1e-9:  # an arm straight up: every way is as short, raising it sideways is the natural one
        return frame @ np.diag([1.0, -1.0, -1.0])
    cross = np.array([[0.0, -axis[2], axis[1]], [axis[2], 0.0, -axis[0]], [-axis[1], axis[0], 0.0]])
    return (np.eye(3) + cross + cross @ cross / (1.0 + cosine)) @ frame


def _foot_frame(bone_map: BoneMap, rest: TargetRest, foot: str, side: str, standing: Array) -> Array:
    """Return the axes of a foot that stands flat, fore towards its toes."""
    fore, up = standing[:, 0], standing[:, 2]
    toes = [rest.head(e.bone) for e in bone_map.entries if e.body == f"foot.{side}" and e.bone != foot]
    for point in (*toes, rest.end(foot)):
        line = point - rest.head(foot)
        level = line - (line @ up) * up
        if np.linalg.norm(level) > 0.3 * np.linalg.norm(line):  # imported bones may point anywhere, straight up too
            fore = normalized(level)
            break
    return matrix_from_columns(fore, np.cross(up, fore), up)


def _check_facing(frame: Mapping[str, Array], standing: Array, name: str) -> None:
    ahead = (frame["foot.L"][:, 0] + frame["foot.R"][:, 0]) @ standing[:, 0]
    if ahead < 0.0:
        hint = "swap left and right in the bone map, or turn the feet at rest forwards"
        raise SpecError(name, None, "", hint, problem="has its left bones on its right side")


def _ankle_height(bone_map: BoneMap, rest: TargetRest, ankle: Array, up: Array, leg: float) -> float:
    height = float((ankle @ up).mean())
    if USUAL_ANKLE[0] * leg < height < USUAL_ANKLE[1] * leg:
        return height
    feet = [entry.bone for entry in bone_map.entries if entry.body.startswith("foot.")]
    lowest = min(float(point @ up) for bone in feet for point in (rest.head(bone), rest.end(bone)))
    return max(height - lowest, USUAL_ANKLE[0] * leg)
