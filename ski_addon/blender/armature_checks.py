"""What an armature must be to be baked on: read its rest pose, or say in one line what is wrong with it."""

from __future__ import annotations

import math

import bpy
import numpy as np

from ..animation.bone_map import BoneMap
from ..animation.target import TargetBody, TargetRest, main_bones
from ..errors import SpecError
from ..frames import Array

LEG_LENGTHS = (0.35, 1.8)
"""Lengths of a leg [m] from hip to ankle that a figure can have."""
STANDING = math.cos(math.radians(45.0))
"""Cosine of how far from upright an armature may stand that does not carry the motion itself."""


def target_rest(armature: bpy.types.Object) -> TargetRest:
    """Return the rest pose of `armature`, in its own space and units."""
    bones = list(armature.data.bones)
    index = {bone.name: i for i, bone in enumerate(bones)}
    return TargetRest(
        bones=tuple(index),
        parent=np.array([index[bone.parent.name] if bone.parent else -1 for bone in bones], dtype=int),
        matrix=np.array([bone.matrix_local for bone in bones], dtype=float),
        tail=np.array([bone.tail_local for bone in bones], dtype=float),
        turns=np.array([bone.use_inherit_rotation for bone in bones], dtype=bool),
    )


def check_object(armature: bpy.types.Object) -> None:
    """Raise `SpecError` unless `armature` is an armature with bones that can be keyed here."""
    name = armature.name
    if armature.type != "ARMATURE":
        raise SpecError(name, armature.type, "ARMATURE", "choose a character's armature", problem="is not an")
    if armature.library is not None:
        hint = "make a library override of it (Object > Library Override > Make)"
        library = bpy.path.basename(armature.library.filepath)
        raise SpecError(name, library, "", hint, problem="is linked from another file")
    if armature.mode == "EDIT":
        raise SpecError(name, None, "", "leave it with Tab", problem="is in edit mode")
    if not armature.data.bones:
        raise SpecError(name, None, "", "choose a character's armature", problem="has no bones")


def check_scale(armature: bpy.types.Object, place: Array) -> float:
    """Return the scale of an armature at `place` (4, 4); raise `SpecError` unless it is one positive number."""
    columns = place[:3, :3]
    size = np.linalg.norm(columns, axis=0)
    field, own = f"scale of {armature.name}", tuple(round(value, 4) for value in armature.scale)
    apply_it = "apply its scale (Ctrl+A > Scale), that of its parents too"
    if size.min() < 1e-9:
        raise SpecError(field, own, "", "give it the same scale along all axes", problem="makes it flat")
    if np.linalg.det(columns) < 0.0:
        raise SpecError(field, own, "", apply_it, problem="mirrors it (negative)")
    slanted = np.abs(columns.T @ columns / np.outer(size, size) - np.eye(3)).max() > 1e-3
    if size.max() / size.min() > 1.001 or slanted:
        raise SpecError(field, own, "", apply_it, problem="is not uniform")
    return float(size.mean())


def check_size(name: str, scale: float, target: TargetBody) -> None:
    """Raise `SpecError` unless the legs of `target` are as long as a person's, in metres."""
    leg = scale * target.leg
    if not LEG_LENGTHS[0] <= leg <= LEG_LENGTHS[1]:
        better = scale * 10.0 ** round(math.log10(0.85 / leg))
        better = better if LEG_LENGTHS[0] <= leg * better / scale <= LEG_LENGTHS[1] else scale * 0.85 / leg
        hint = f"set its scale to {better:.3g} (it is {scale:.3g})"
        raise SpecError(f"leg length of {name}", round(leg, 3), f"{LEG_LENGTHS[0]}..{LEG_LENGTHS[1]} m", hint)


def check_upright(name: str, place: Array, target: TargetBody) -> None:
    """Raise `SpecError` unless the figure at rest stands along the world's Z axis."""
    up = place[:3, :3] @ target.frame["pelvis"][:, 2]
    up = up / np.linalg.norm(up)
    if up[2] < STANDING:
        hint = "turn it upright (R X 90), or let the object carry the motion"
        raise SpecError(f"up axis of {name}", tuple(np.round(up, 2).tolist()), "(0, 0, 1)", hint, problem="is far from")


def check_free(armature: bpy.types.Object, bone_map: BoneMap, root: str) -> None:
    """Raise `SpecError` unless the bones that move freely can: the pelvis, and the root bone if that is `root`."""
    moving = [main_bones(bone_map)["pelvis"], *([bone_map.root] if root == "bone" else [])]
    for name in moving:
        bone = armature.data.bones[name]
        if bone.parent and bone.use_connect:
            problem = "is a connected bone and cannot move"
            raise SpecError(f"bone {name} of {armature.name}", None, "", "turn its Connected off", problem=problem)
        if not bone.use_local_location:
            problem = "moves along the armature's axes instead of its own"
            raise SpecError(f"bone {name} of {armature.name}", None, "", "turn its Local Location on", problem=problem)
    if root == "object" and armature.parent is not None:
        hint = "clear its parent (Alt+P), or let pelvis or bone carry the motion"
        raise SpecError(armature.name, armature.parent.name, "", hint, problem="has a parent that carries it:")
