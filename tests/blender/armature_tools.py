"""Foreign armatures made by edit bones with the names that other programs give, and how Blender shows them."""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.animation.foreign_armatures import JOINTS, with_right_side
from tests.blender.blender_tools import make_recording

MIXAMO = {
    "pelvis": "Hips",
    "spine_01": "Spine",
    "spine_02": "Spine1",
    "spine_03": "Spine2",
    "neck_01": "Neck",
    "head": "Head",
    "clavicle": "Shoulder",
    "upperarm": "Arm",
    "lowerarm": "ForeArm",
    "hand": "Hand",
    "thigh": "UpLeg",
    "calf": "Leg",
    "foot": "Foot",
    "ball": "ToeBase",
}
UNREAL_BODIES = {"thigh": "thigh", "calf": "shank", "foot": "foot", "upperarm": "upper_arm", "lowerarm": "forearm"}


def unreal_joints() -> dict[str, Any]:
    """A mannequin in a T-pose that faces -y, in metres."""
    return with_right_side(JOINTS)


def mixamo_joints(prefix: str = "mixamorig:") -> dict[str, Any]:
    """The same person as Mixamo names it: no root bone, y up and centimetres as an imported file has it."""
    out = {}
    for name, (parent, *ends) in unreal_joints().items():
        if name != "root":
            over = prefix + mixamo_name(parent) if parent != "root" else ""
            out[prefix + mixamo_name(name)] = (over, *(tuple(100.0 * np.array([x, z, -y])) for x, y, z in ends))
    return out


def mixamo_name(name: str) -> str:
    """Mixamo's name of a bone of Unreal's mannequin."""
    if name[-2:] in ("_l", "_r"):
        return ("Left" if name.endswith("_l") else "Right") + MIXAMO[name[:-2]]
    return MIXAMO[name]


def build_armature(scene: Any, joints: dict[str, Any], name: str = "Hero", roll: float = 0.4) -> Any:
    """An armature object of `joints` {bone: (parent, head, tail)} in `scene`, each bone with a roll of its own."""
    import bpy

    armature = bpy.data.objects.new(name, bpy.data.armatures.new(name))
    scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    for i, (bone, (parent, head, tail)) in enumerate(joints.items()):
        edit = armature.data.edit_bones.new(bone)
        edit.head, edit.tail = head, tail
        edit.roll = roll * i
        edit.parent = armature.data.edit_bones[parent] if parent else None
    bpy.ops.object.mode_set(mode="OBJECT")
    return armature


def mixamo_armature(scene: Any, prefix: str = "mixamorig:") -> Any:
    """A Mixamo character as Blender imports it: centimetres, turned upright by its object."""
    import bpy

    armature = build_armature(scene, mixamo_joints(prefix))
    armature.scale = (0.01,) * 3
    armature.rotation_euler = (0.5 * np.pi, 0.0, 0.0)
    bpy.context.view_layer.update()
    return armature


def world_pose(obj: Any, bone: str) -> np.ndarray:
    """The world matrix (4, 4) of a bone as Blender evaluates it now, without the object's scale."""
    import bpy

    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return without_scale(np.array(evaluated.matrix_world @ evaluated.pose.bones[bone].matrix))


def world_matrix(obj: Any) -> np.ndarray:
    """The world matrix (4, 4) of an object as Blender evaluates it now."""
    import bpy

    return np.array(obj.evaluated_get(bpy.context.evaluated_depsgraph_get()).matrix_world)


def without_scale(matrix: np.ndarray) -> np.ndarray:
    """A matrix (4, 4) with axes of length one."""
    out = matrix.copy()
    out[:3, :3] /= np.linalg.norm(out[:3, :3], axis=0)
    return out


def unreal(scene: Any) -> Any:
    return build_armature(scene, unreal_joints())


def metarig(scene: Any) -> Any:
    return _rigify(scene, basic=False, generate=False)


def basic_rig(scene: Any) -> Any:
    return _rigify(scene, basic=True, generate=True)


def human_rig(scene: Any) -> Any:
    return _rigify(scene, basic=False, generate=True)


def _rigify(scene: Any, *, basic: bool, generate: bool) -> Any:
    import addon_utils
    import bpy

    addon_utils.enable("rigify", default_set=True)
    add = bpy.ops.object.armature_basic_human_metarig_add if basic else bpy.ops.object.armature_human_metarig_add
    add()
    if generate:
        bpy.ops.pose.rigify_generate()
        bpy.ops.object.mode_set(mode="OBJECT")
    return bpy.context.view_layer.objects.active


def bake(core: Any, scene: Any, armature: Any, recording: Any = None, bake_options: Any = None, **options: Any) -> Any:
    """Bake a recording (default: of one second) on `armature` with `options`."""
    tools = core("blender.armatures")
    recording = recording or make_recording(core)
    return tools.bake_on_armature(
        recording, scene, armature, None, tools.ArmatureOptions(**options), bake_options or core("spec").BakeSpec()
    )
