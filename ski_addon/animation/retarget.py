"""A recording on a foreign armature: the skier's motion becomes keys of bones of other lengths, rests and rolls.

Every part of the body is turned as it was recorded, whatever the rest pose: the axes of the part at rest (see
`TargetBody.frame`) are laid on the axes of the recorded body. The feet stand where the recorded boots stood; the pelvis
goes where both legs serve it best, and hips and knees give what other proportions need.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..body.skeleton import PARENT_PART, SIDES
from ..errors import SpecError
from ..frames import Array, continuous_quaternions, matrix_from_quaternion, quaternion_from_matrix, rotation_about
from .bone_map import BoneEntry, BoneMap
from .interpolation import slerp
from .keyframes import BoneChannels, BoneKeyframes
from .leg_reach import place_pelvis, reach
from .poses import BodyPoses
from .target import TargetBody, TargetRest, measure_target

if TYPE_CHECKING:
    from ..body.skeleton import Skeleton

ROOTS = ("pelvis", "bone", "object")
LEGS = ("reach", "angles")


@dataclass(frozen=True)
class RetargetOptions:
    """How a recording is laid on an armature.

    `root`: what carries the figure down the slope, "pelvis" (its bone moves), "bone" (the map's root bone) or "object".
    `legs`: "reach" puts the feet exactly where they were, "angles" keeps the recorded angles of hip and knee exactly.
    `sole_height` [m] is the height of the soles above the bases of the skis.
    """

    root: str = "pelvis"
    legs: str = "reach"
    sole_height: float = 0.0

    def __post_init__(self) -> None:
        for name, known in (("root", ROOTS), ("legs", LEGS)):
            if getattr(self, name) not in known:
                raise SpecError(f"retarget.{name}", getattr(self, name), ", ".join(known), problem="is not one of")
        if not 0.0 <= self.sole_height <= 0.3:
            raise SpecError("retarget.sole_height", self.sole_height, "0..0.3 m", "0 for feet without skis")


@dataclass(frozen=True)
class Retargeted:
    """Keys of a foreign armature.

    `keyframes` of its bones; `ground_motion` (m, 4, 4) is the armature object's world matrix, or None if it stands
    still; `turn` {body: (m, 3, 3)} the world axes of every mapped body; `foot_error` (m, 2) [m] how far each ankle is
    from where it belongs; `size` is the target's leg in lengths of the skier's.
    """

    keyframes: BoneKeyframes
    ground_motion: Array | None
    turn: dict[str, Array]
    foot_error: Array
    size: float


def retarget(
    poses: BodyPoses,
    skeleton: Skeleton,
    bone_map: BoneMap,
    rest: TargetRest,
    world_from_armature: Array | None = None,
    options: RetargetOptions | None = None,
    name: str = "the armature",
) -> Retargeted:
    """Return the keys that make the armature `rest` do what `poses` of the skier `skeleton` show.

    `world_from_armature` (4, 4) places the armature object, with one scale for all axes; `name` is for messages.
    Raises `SpecError` for a map or a rest pose that cannot be used.
    """
    options = options or RetargetOptions()
    target = measure_target(bone_map, rest, name)
    place = np.eye(4) if world_from_armature is None else np.asarray(world_from_armature, dtype=float)
    scale = float(np.linalg.norm(place[:3, 0]))
    recorded = {body: matrix_from_quaternion(poses.quaternion[:, i]) for i, body in enumerate(poses.body_names)}
    pelvis, turn, error = _place_body(poses, skeleton, recorded, target, rest, scale, options)
    ground = _ground_motion(poses, recorded, target, scale)
    if options.root == "object":
        armature_from_world = np.linalg.inv(ground)
    else:
        armature_from_world = np.broadcast_to(np.linalg.inv(place), ground.shape)
    carried = None
    if options.root == "bone":
        if not bone_map.root:
            hint = f"name one as root in the bone map {bone_map.name}, or let pelvis or object carry the motion"
            raise SpecError(name, None, "", hint, problem="has no root bone")
        carried = armature_from_world @ ground
    keyframes = _keyframes(poses.frame, bone_map, rest, target, turn, pelvis, armature_from_world, carried)
    moved = ground if options.root == "object" else None
    size = scale * target.leg / (skeleton.lengths["thigh"] + skeleton.lengths["shank"])
    return Retargeted(keyframes, moved, turn, error, size)


def ski_in_foot(skeleton: Skeleton, target: TargetBody, scale: float, size: float, sole_height: float) -> Array:
    """Return the middle of the ski's base (3,) [m] seen from the ankle, in the axes of the foot."""
    return np.array([size * skeleton.ankle_setback, 0.0, -scale * target.ankle_height - sole_height])


def _place_body(
    poses: BodyPoses,
    skeleton: Skeleton,
    recorded: dict[str, Array],
    target: TargetBody,
    rest: TargetRest,
    scale: float,
    options: RetargetOptions,
) -> tuple[Array, dict[str, Array], Array]:
    """Return the pelvis bone's head (m, 3) [m, world], the axes of all bodies, and the feet's errors (m, 2) [m]."""
    turn = dict(recorded)
    size = scale * target.leg / (skeleton.lengths["thigh"] + skeleton.lengths["shank"])
    on_ski = ski_in_foot(skeleton, target, scale, size, options.sole_height)
    ankle, wanted, hips = [], [], []
    for i, side in enumerate(SIDES):
        ski = poses.position[:, poses.body_names.index(f"ski.{side}")]
        ankle.append(ski - recorded[f"ski.{side}"] @ on_ski)
        leg = scale * target.thigh[i] * recorded[f"thigh.{side}"][..., 2]
        leg = leg + scale * target.shank[i] * recorded[f"shank.{side}"][..., 2]
        wanted.append(ankle[i] + leg)
        offset = rest.head(target.main[f"thigh.{side}"]) - rest.head(target.main["pelvis"])
        hips.append(recorded["pelvis"] @ (scale * target.frame["pelvis"].T @ offset))
    ankles, hip_wanted, hip_offset = (np.stack(rows, axis=1) for rows in (ankle, wanted, hips))
    length = scale * (target.thigh + target.shank) if options.legs == "reach" else None
    pelvis = place_pelvis(hip_wanted, hip_offset, ankles, length)
    hip = pelvis[:, None] + hip_offset
    if options.legs == "angles":
        return pelvis, turn, np.linalg.norm(hip - hip_wanted, axis=-1)
    error = np.empty(ankles.shape[:2])
    for i, side in enumerate(SIDES):
        lengths = scale * float(target.thigh[i]), scale * float(target.shank[i])
        axis = recorded[f"thigh.{side}"][..., 1]
        turn[f"thigh.{side}"], turn[f"shank.{side}"], error[:, i] = reach(hip[:, i], ankles[:, i], axis, *lengths)
    return pelvis, turn, error


def _ground_motion(poses: BodyPoses, recorded: dict[str, Array], target: TargetBody, scale: float) -> Array:
    """Return the world matrix (m, 4, 4) of an armature that slides along between the skis, facing as the pelvis."""
    skis = [poses.body_names.index(f"ski.{side}") for side in SIDES]
    fore = recorded["pelvis"][..., 0]
    heading = np.arctan2(np.ascontiguousarray(fore[:, 1]), np.ascontiguousarray(fore[:, 0]))
    out = np.zeros((len(heading), 4, 4))
    out[:, :3, :3] = scale * rotation_about("z", heading) @ target.frame["pelvis"].T
    out[:, :3, 3] = poses.position[:, skis].mean(axis=1) - out[:, :3, :3] @ target.ground
    out[:, 3, 3] = 1.0
    return out


def _keyframes(
    frame: Array,
    bone_map: BoneMap,
    rest: TargetRest,
    target: TargetBody,
    turn: dict[str, Array],
    pelvis: Array,
    armature_from_world: Array,
    carried: Array | None,
) -> BoneKeyframes:
    """Return the local channels of all mapped bones; `carried` (m, 4, 4) is how the root bone moves from its rest."""
    unscaled = armature_from_world[:, :3, :3] / np.linalg.norm(armature_from_world[:, :3, :1], axis=1, keepdims=True)
    motion = {entry.bone: unscaled @ _entry_motion(entry, turn, target) for entry in bone_map.entries}
    entries = {entry.bone: entry for entry in bone_map.entries}
    if carried is not None:
        motion[bone_map.root] = carried[:, :3, :3]
    head = np.einsum("mij,mj->mi", armature_from_world[:, :3, :3], pelvis) + armature_from_world[:, :3, 3]
    channels = []
    for index, bone in enumerate(rest.bones):
        if bone not in motion:
            continue
        own = rest.matrix[index, :3, :3]
        carrier = _carrier(index, rest, entries.get(bone), motion)
        parent = np.eye(3) if carrier is None else np.swapaxes(motion[carrier], -1, -2)
        local = np.broadcast_to(own.T @ parent @ motion[bone] @ own, (len(frame), 3, 3))
        location = None
        if carried is not None and bone == bone_map.root:
            location = (carried[:, :3, :3] @ rest.head(bone) + carried[:, :3, 3] - rest.head(bone)) @ own
        elif bone == target.main["pelvis"]:
            _check_pelvis(bone, carrier, bone_map.root if carried is not None else None)
            rooted = head if carried is None else _seen_from(carried, head)
            location = (rooted - rest.head(bone)) @ own
        rotation = continuous_quaternions(quaternion_from_matrix(local))
        channels.append(BoneChannels(bone, rotation, location))
    return BoneKeyframes(frame, tuple(channels))


def _check_pelvis(bone: str, carrier: str | None, root: str | None) -> None:
    if carrier != root:
        hint = "the pelvis must hang on the root bone, or on bones that the map does not move"
        raise SpecError(f"bones.{bone}", carrier or "no bone", "", hint, problem="is carried by")


def _seen_from(carried: Array, point: Array) -> Array:
    return np.einsum("mji,mj->mi", carried[:, :3, :3], point - carried[:, :3, 3])


def _entry_motion(entry: BoneEntry, turn: dict[str, Array], target: TargetBody) -> Array:
    """Return how a bone is turned from its rest (m, 3, 3), world from armature: as its body, or a share of the way."""
    motion = turn[entry.body] @ target.frame[entry.body].T
    part, _, side = entry.body.partition(".")
    if entry.share == 1.0 or part not in PARENT_PART:
        return motion
    parent = PARENT_PART[part]
    parent = f"{parent}.{side}" if f"{parent}.{side}" in turn else parent
    start = quaternion_from_matrix(turn[parent] @ target.frame[parent].T)
    return matrix_from_quaternion(slerp(start, quaternion_from_matrix(motion), np.full(len(start), entry.share)))


def _carrier(index: int, rest: TargetRest, entry: BoneEntry | None, motion: dict[str, Array]) -> str | None:
    """Return the moving bone that turns bone `index`: the one its entry names, or its nearest moving ancestor."""
    if entry is not None and entry.parent:
        return entry.parent if entry.parent in motion else None
    while rest.turns[index] and rest.parent[index] >= 0:
        index = int(rest.parent[index])
        if rest.bones[index] in motion:
            return rest.bones[index]
    return None
