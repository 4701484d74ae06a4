"""Armatures that cannot be baked on are refused in one line, before anything is changed."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.armature_tools import (
    bake,
    build_armature,
    unreal,
    unreal_joints,
)
from tests.blender.blender_tools import make_recording


def spoil_scale(armature):
    armature.scale = (1.0, 1.0, 1.2)


def mirror(armature):
    armature.scale = (-1.0, 1.0, 1.0)


def centimetres(armature):
    armature.scale = (100.0,) * 3


def flat(armature):
    armature.rotation_euler = (0.5 * np.pi, 0.0, 0.0)


@pytest.mark.parametrize(
    ("spoil", "named"),
    [
        (spoil_scale, r"scale of Hero = \(1\.0, 1\.0, 1\.2\) is not uniform: apply its scale"),
        (mirror, r"scale of Hero = \(-1\.0, 1\.0, 1\.0\) mirrors it.*: apply its scale"),
        (centimetres, r"leg length of Hero = 86\.\d+ is outside 0\.35\.\.1\.8 m: set its scale to 1 "),
        (flat, r"up axis of Hero = .* is far from \(0, 0, 1\): turn it upright"),
    ],
)
def test_an_armature_that_cannot_be_used_is_refused(core, scene, spoil, named: str) -> None:
    import bpy

    armature = unreal(scene)
    spoil(armature)
    bpy.context.view_layer.update()
    with pytest.raises(core("errors").SpecError, match=named):
        bake(core, scene, armature)
    assert len(bpy.data.actions) == 0
    assert len(bpy.data.objects) == 1


def test_missing_bones_are_named(core, scene) -> None:
    joints = {bone: row for bone, row in unreal_joints().items() if not bone.startswith(("calf", "foot", "ball"))}
    with pytest.raises(core("errors").SpecError, match=r"Hero fits no bone map.*unreal_mannequin\.toml, misses calf_l"):
        bake(core, scene, build_armature(scene, joints))


def test_a_map_of_another_armature_is_refused(core, scene) -> None:
    tools = core("blender.armatures")
    bone_map = core("animation.bone_map").BoneMap.load(core("blender.bake").BONE_MAP.with_name("mixamo.toml"))
    with pytest.raises(core("errors").SpecError, match='Hero = "pelvis" has no bone for'):
        tools.bake_on_armature(make_recording(core), scene, unreal(scene), bone_map)


def test_arms_may_be_missing(core, scene) -> None:
    joints = {n: row for n, row in unreal_joints().items() if not n.startswith(("clav", "upper", "lower", "hand"))}
    result = bake(core, scene, build_armature(scene, joints))
    assert [note for note in result.notes if "upperarm_l" in note]
    assert {obj["ski_addon_gear"] for obj in result.gear} == {"ski.L", "ski.R"}


def test_a_connected_pelvis_is_refused(core, scene) -> None:
    joints = unreal_joints()
    joints["root"] = ("", (0, 0.01, 0), joints["pelvis"][1])
    armature = build_armature(scene, joints)
    import bpy

    bpy.ops.object.mode_set(mode="EDIT")
    armature.data.edit_bones["pelvis"].use_connect = True
    bpy.ops.object.mode_set(mode="OBJECT")
    with pytest.raises(core("errors").SpecError, match="bone pelvis of Hero is a connected bone"):
        bake(core, scene, armature)


def test_an_object_with_a_parent_cannot_carry_the_motion(core, scene) -> None:
    import bpy

    armature = unreal(scene)
    armature.parent = bpy.data.objects.new("Lift", None)
    scene.collection.objects.link(armature.parent)
    with pytest.raises(core("errors").SpecError, match='Hero = "Lift" has a parent'):
        bake(core, scene, armature, root="object")


def test_a_linked_armature_is_refused(core, scene, tmp_path) -> None:
    import bpy

    unreal(scene)
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {scene.objects["Hero"]})
    bpy.data.objects.remove(scene.objects["Hero"])
    with bpy.data.libraries.load(path, link=True) as (there, here):
        here.objects = there.objects
    armature = here.objects[0]
    scene.collection.objects.link(armature)
    with pytest.raises(core("errors").SpecError, match=r'Hero = "library\.blend" is linked.*override'):
        bake(core, scene, armature)


def test_what_is_no_armature_is_refused(core, scene) -> None:
    import bpy

    cube = bpy.data.objects.new("Cube", bpy.data.meshes.new("Cube"))
    empty = bpy.data.objects.new("Nothing", bpy.data.armatures.new("Nothing"))
    scene.collection.objects.link(empty)
    with pytest.raises(core("errors").SpecError, match="Cube.*is not an ARMATURE"):
        bake(core, scene, cube)
    with pytest.raises(core("errors").SpecError, match="Nothing has no bones"):
        bake(core, scene, empty)


def test_maps_of_the_user_come_first_and_bad_ones_are_told(core, scene, tmp_path) -> None:
    tools = core("blender.armatures")
    shipped = core("blender.bake").BONE_MAP.parent
    (tmp_path / "bad.toml").write_text("[bones\n")
    (tmp_path / "mine.toml").write_text((shipped / "unreal_mannequin.toml").read_text())
    found = tools.detect_bone_map(unreal(scene), (tmp_path, shipped))
    assert found.path.name == "mine.toml"
    assert len(found.unreadable) == 1 and "bad.toml" in found.unreadable[0]


@pytest.mark.parametrize(
    "changes", [{"equipment": "some"}, {"root": "hips"}, {"tolerance_deg": -1.0}, {"tolerance_mm": 1e4}]
)
def test_bad_options_are_refused(core, extension: str, changes: dict) -> None:
    with pytest.raises(core("errors").SpecError, match=next(iter(changes))):
        core("blender.armatures").ArmatureOptions(**changes)
