"""A figure's armature: one bone a body, named after it, under one root bone that nothing animates."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..animation.bone_map import BoneMap
from ..animation.keyframes import RestPose
from .bone_lines import bone_line, is_joined
from .bone_shapes import bone_shape
from .meshes import part_object, skin_to
from .skier.build import body_part, equipment_part
from .skier.figure import Figure, build_figure, figure_of

if TYPE_CHECKING:
    from ..body.skeleton import Skeleton
    from ..turning.figures import FigureModel

ROOT = "root"
PART_PROPERTY = "ski_part"
"""Custom property of a figure's mesh objects: which part of it they are."""
NAMES = {"alpine": "Skier", "snowboard": "Snowboarder", "telemark": "Telemark skier", "bicycle": "Cyclist"}
"""What the armature of each kind of figure is called."""


@dataclass(frozen=True)
class Rig:
    """The objects of one figure: `armature`, `body` mesh and `equipment` meshes by body name."""

    armature: bpy.types.Object
    body: bpy.types.Object
    equipment: dict[str, bpy.types.Object]

    @property
    def meshes(self) -> tuple[bpy.types.Object, ...]:
        """All mesh objects of the figure."""
        return (self.body, *self.equipment.values())


def build_rig(skeleton: Skeleton, scene: bpy.types.Scene, name: str = NAMES["alpine"]) -> Rig:
    """Make the skier of `skeleton` in a new collection of `scene`; selection and active object stay as they are."""
    return build_rig_of(build_figure(skeleton), scene, name)


def build_figure_rig(model: FigureModel, scene: bpy.types.Scene, name: str | None = None) -> Rig:
    """Make a figure of any kind in a new collection of `scene`, as `build_rig` makes the alpine skier."""
    return build_rig_of(figure_of(model), scene, name)


def build_rig_of(figure: Figure, scene: bpy.types.Scene, name: str | None = None) -> Rig:
    """Make a figure of these measures in a new collection of `scene`."""
    name = name or NAMES[figure.kind]
    collection = bpy.data.collections.new(name)
    scene.collection.children.link(collection)
    armature = _armature_object(figure, name)
    collection.objects.link(armature)
    return _dressed(armature, figure, name, collection)


def refit(armature: bpy.types.Object, figure: Figure) -> Rig:
    """Give the armature of a figure that was built here other measures, or another kind; settings and keys stay.

    Its own meshes are replaced; what else hangs on it stays.
    """
    for child in [child for child in armature.children if child.get(PART_PROPERTY)]:
        mesh = child.data
        bpy.data.objects.remove(child)
        if mesh.users == 0:
            bpy.data.meshes.remove(mesh)
    made, before = _armature_object(figure, armature.name), armature.data
    armature.data = made.data
    bpy.data.objects.remove(made)
    if before.users == 0:
        bpy.data.armatures.remove(before)
    for pose_bone in armature.pose.bones:
        _dress_bone(pose_bone, figure)
    collections = armature.users_collection or (bpy.context.scene.collection,)
    return _dressed(armature, figure, armature.name, collections[0])


def _dressed(armature: bpy.types.Object, figure: Figure, name: str, collection: bpy.types.Collection) -> Rig:
    """Make the meshes of `figure` around `armature`."""
    body = part_object(f"{name} body", body_part(figure), collection)
    equipment = {key: part_object(f"{name} {key}", equipment_part(figure, key), collection) for key in figure.gear}
    for key, obj in (("body", body), *equipment.items()):
        skin_to(obj, armature)
        obj[PART_PROPERTY] = key
    return Rig(armature, body, equipment)


def find_rig(armature: bpy.types.Object) -> Rig:
    """Return the rig around an `armature` that was built here, wherever its meshes are linked."""
    children = {obj.vertex_groups[0].name if len(obj.vertex_groups) == 1 else "body": obj for obj in armature.children}
    body = children.pop("body")
    return Rig(
        armature, body, {bone.name: children[bone.name] for bone in armature.data.bones if bone.name in children}
    )


def rest_pose(armature: bpy.types.Object, bone_map: BoneMap, figure: Skeleton | Figure) -> RestPose:
    """Return the rest pose of `armature` (parents first) beside the bodies of `figure` (or of a skier) at rest."""
    figure = figure if isinstance(figure, Figure) else build_figure(figure)
    bones = list(armature.data.bones)
    names = [bone.name for bone in bones]
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
    for name, parent in figure.parent.items():
        bone = data.edit_bones.new(name)
        head, tail, z_axis = bone_line(figure, name)
        bone.head, bone.tail = Vector(head), Vector(tail)
        bone.align_roll(Vector(z_axis))
        bone.parent = data.edit_bones[parent] if parent else root
        bone.use_connect = is_joined(figure, name)


def _dress_bones(armature: bpy.types.Object, figure: Figure) -> None:
    data = armature.data
    data.display_type = "STICK"
    armature.show_in_front = True
    groups = {name: data.collections.new(name) for name in ("Root", "Body", "Equipment")}
    for pose_bone in armature.pose.bones:
        name = pose_bone.name
        group = "Root" if name == ROOT else "Equipment" if name in figure.gear else "Body"
        groups[group].assign(pose_bone.bone)
        pose_bone.bone.color.palette = {".L": "THEME01", ".R": "THEME04"}.get(name[-2:], "THEME09")
        _dress_bone(pose_bone, figure)


def _dress_bone(pose_bone: bpy.types.PoseBone, figure: Figure) -> None:
    """Give a bone what belongs to the object, not to the armature's data: how it turns, and its shape."""
    name = pose_bone.name
    pose_bone.rotation_mode = "QUATERNION"
    shape, scale = bone_shape(name, pose_bone.bone.length, figure.h, figure.sizes)
    pose_bone.custom_shape = shape
    pose_bone.use_custom_shape_bone_size = False
    pose_bone.custom_shape_scale_xyz = scale
    if name not in figure.gear and name not in (ROOT, "foot.L", "foot.R"):
        pose_bone.custom_shape_translation = (0.0, 0.5 * pose_bone.bone.length, 0.0)
    else:
        pose_bone.custom_shape_translation = (0.0, 0.0, 0.0)


def pose_matrix(armature: bpy.types.Object, bone: str) -> Matrix:
    """Return the evaluated world matrix of `bone`."""
    return armature.matrix_world @ armature.pose.bones[bone].matrix
