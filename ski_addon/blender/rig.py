"""The skier's armature: one bone a body, named after it, under one root bone that nothing animates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..animation.bone_map import BoneMap
from ..animation.keyframes import RestPose
from .bone_shapes import bone_shape
from .meshes import part_object, skin_to
from .skier.build import EQUIPMENT, body_part, equipment_part
from .skier.figure import Figure, build_figure

if TYPE_CHECKING:
    from ..body.skeleton import Skeleton

ROOT = "root"
FREE_BONES = ("pelvis", "ski.L", "ski.R", "pole.L", "pole.R", "upper_arm.L", "upper_arm.R", "thigh.L", "thigh.R")
"""Bones that are not joined to the end of their parent."""


@dataclass(frozen=True)
class Rig:
    """The objects of one skier: `armature`, `body` mesh and `equipment` meshes by body name."""

    armature: bpy.types.Object
    body: bpy.types.Object
    equipment: dict[str, bpy.types.Object]

    @property
    def meshes(self) -> tuple[bpy.types.Object, ...]:
        """All mesh objects of the skier."""
        return (self.body, *self.equipment.values())


def build_rig(skeleton: Skeleton, scene: bpy.types.Scene, name: str = "Skier") -> Rig:
    """Make the skier of `skeleton` in a new collection of `scene`; selection and active object stay as they are."""
    figure = build_figure(skeleton)
    collection = bpy.data.collections.new(name)
    scene.collection.children.link(collection)
    armature = _armature_object(figure, name)
    collection.objects.link(armature)
    body = part_object(f"{name} body", body_part(figure), collection)
    equipment = {key: part_object(f"{name} {key}", equipment_part(figure, key), collection) for key in EQUIPMENT}
    for obj in (body, *equipment.values()):
        skin_to(obj, armature)
    return Rig(armature, body, equipment)


def find_rig(armature: bpy.types.Object) -> Rig:
    """Return the rig around an `armature` that `build_rig` made, wherever its meshes are linked."""
    children = {obj.vertex_groups[0].name if len(obj.vertex_groups) == 1 else "body": obj for obj in armature.children}
    return Rig(armature, children["body"], {name: children[name] for name in EQUIPMENT})


def rest_pose(armature: bpy.types.Object, bone_map: BoneMap, skeleton: Skeleton) -> RestPose:
    """Return the rest pose of `armature` (parents first) beside the bodies of `skeleton` at rest."""
    bones = list(armature.data.bones)
    names = [bone.name for bone in bones]
    figure = build_figure(skeleton)
    return RestPose(
        bones=tuple(names),
        parent=np.array([names.index(bone.parent.name) if bone.parent else -1 for bone in bones]),
        bone_matrix=np.array([bone.matrix_local for bone in bones], dtype=float),
        body_matrix={entry.body: _body_matrix(figure, entry.body) for entry in bone_map.entries},
    )


def _body_matrix(figure: Figure, body: str) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = figure.turn[body]
    matrix[:3, 3] = figure.place[body]
    return matrix


def bone_line(figure: Figure, body: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return head and tail [m] of the bone of `body` at rest, and the direction of its z axis."""
    part, _, side = body.partition(".")
    place, h = figure.place, figure.h
    up, fore = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    following = {
        "pelvis": "abdomen",
        "abdomen": "chest",
        "chest": "head",
        "upper_arm": f"forearm.{side}",
        "forearm": f"hand.{side}",
        "thigh": f"shank.{side}",
        "shank": f"foot.{side}",
    }
    head = place[body]
    if part in following:
        return head, place[following[part]], -fore if part in ("pelvis", "abdomen", "chest") else fore
    ends = {
        "head": (head + 0.124 * h * up, -fore),
        "hand": (head - 0.085 * h * up, fore),
        "foot": (head + np.array([0.11 * h, 0.0, 0.0]), up),
        "ski": (head + 0.35 * figure.skeleton.ski_length * fore, up),
        "pole": (head - figure.turn[body][:, 2] * 0.9 * figure.skeleton.pole_length, figure.turn[body][:, 0]),
    }
    tail, z_axis = ends[part]
    return head, tail, z_axis


def _armature_object(figure: Figure, name: str) -> bpy.types.Object:
    data = bpy.data.armatures.new(name)
    armature = bpy.data.objects.new(name, data)
    workshop = bpy.data.scenes.new("Ski Addon workshop")  # edit mode needs a scene; the user's stays untouched
    try:
        workshop.collection.objects.link(armature)
        layer = workshop.view_layers[0]
        layer.objects.active = armature
        with bpy.context.temp_override(scene=workshop, view_layer=layer, active_object=armature, object=armature):
            bpy.ops.object.mode_set(mode="EDIT")
            _edit_bones(data, figure)
            bpy.ops.object.mode_set(mode="OBJECT")
        workshop.collection.objects.unlink(armature)
    finally:
        bpy.data.scenes.remove(workshop)
    _dress_bones(armature, figure)
    return armature


def _edit_bones(data: bpy.types.Armature, figure: Figure) -> None:
    root = data.edit_bones.new(ROOT)
    root.head, root.tail = Vector((0.0, 0.0, 0.0)), Vector((0.3 * figure.h, 0.0, 0.0))
    root.align_roll(Vector((0.0, 0.0, 1.0)))
    root.use_deform = False
    names = figure.skeleton.body_names
    for index, name in enumerate(names):
        bone = data.edit_bones.new(name)
        head, tail, z_axis = bone_line(figure, name)
        bone.head, bone.tail = Vector(head), Vector(tail)
        bone.align_roll(Vector(z_axis))
        parent = figure.skeleton.parent[index]
        bone.parent = data.edit_bones[names[parent]] if parent >= 0 else root
        bone.use_connect = name not in FREE_BONES


def _dress_bones(armature: bpy.types.Object, figure: Figure) -> None:
    data = armature.data
    data.display_type = "STICK"
    armature.show_in_front = True
    groups = {name: data.collections.new(name) for name in ("Root", "Body", "Equipment")}
    for pose_bone in armature.pose.bones:
        name = pose_bone.name
        pose_bone.rotation_mode = "QUATERNION"
        group = "Root" if name == ROOT else "Equipment" if name in EQUIPMENT else "Body"
        groups[group].assign(pose_bone.bone)
        side = name[-2:]
        pose_bone.bone.color.palette = {".L": "THEME01", ".R": "THEME04"}.get(side, "THEME09")
        shape, scale = bone_shape(name, pose_bone.bone.length, figure.h)
        pose_bone.custom_shape = shape
        pose_bone.use_custom_shape_bone_size = False
        pose_bone.custom_shape_scale_xyz = scale
        if name not in EQUIPMENT and name not in (ROOT, "foot.L", "foot.R"):
            pose_bone.custom_shape_translation = (0.0, 0.5 * pose_bone.bone.length, 0.0)


def pose_matrix(armature: bpy.types.Object, bone: str) -> Matrix:
    """Return the evaluated world matrix of `bone`."""
    return armature.matrix_world @ armature.pose.bones[bone].matrix
