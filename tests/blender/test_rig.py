"""The skier's armature and meshes."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.blender_tools import make_recording, skeleton_of


@pytest.fixture
def skeleton(core):
    return skeleton_of(core, make_recording(core, duration=0.0))


@pytest.fixture
def rig(core, scene, skeleton):
    return core("blender.rig").build_rig(skeleton, scene)


def test_there_is_a_bone_for_every_body(rig, skeleton) -> None:
    assert set(rig.armature.data.bones.keys()) == {"root", *skeleton.body_names}


def test_bones_start_where_the_bodies_are(core, rig, skeleton) -> None:
    figure = core("blender.skier.figure").build_figure(skeleton)
    for name in skeleton.body_names:
        np.testing.assert_allclose(rig.armature.data.bones[name].head_local, figure.place[name], atol=1e-6)


def test_bones_that_move_are_not_connected(rig) -> None:
    for name in ("root", "pelvis", "ski.L", "ski.R", "pole.L", "pole.R"):
        assert not rig.armature.data.bones[name].use_connect


def test_left_and_right_bones_mirror_each_other(rig) -> None:
    import bpy

    bones = rig.armature.data.bones
    for bone in bones:
        other = bones[bpy.utils.flip_name(bone.name)]
        np.testing.assert_allclose(np.array(other.head_local) * (1, -1, 1), bone.head_local, atol=1e-6)
        np.testing.assert_allclose(np.array(other.tail_local) * (1, -1, 1), bone.tail_local, atol=1e-6)


def test_knees_bend_about_the_same_axis_on_both_sides(rig) -> None:
    left, right = (np.array(rig.armature.data.bones[f"shank.{side}"].matrix_local) for side in "LR")
    np.testing.assert_allclose(left[:3, :3], right[:3, :3], atol=1e-6)
    np.testing.assert_allclose(np.abs(left[:3, 0]), [0.0, 1.0, 0.0], atol=1e-6)


def test_bones_have_collections_and_shapes(rig) -> None:
    bones = rig.armature.data.bones
    assert set(rig.armature.data.collections.keys()) == {"Root", "Body", "Equipment"}
    assert {bone.name for bone in rig.armature.data.collections["Equipment"].bones} == {
        *("ski.L", "ski.R", "pole.L", "pole.R")
    }
    assert all(bone.custom_shape is not None for bone in rig.armature.pose.bones)
    assert all(len(bone.collections) == 1 for bone in bones)


def test_every_vertex_follows_a_bone(rig) -> None:
    for obj in rig.meshes:
        names = {group.name for group in obj.vertex_groups}
        assert names <= set(rig.armature.data.bones.keys())
        for vertex in obj.data.vertices:
            assert sum(group.weight for group in vertex.groups) == pytest.approx(1.0, abs=0.02)


def test_materials_are_there_once_and_shared_by_a_second_skier(core, scene, rig, skeleton) -> None:
    import bpy

    before = set(bpy.data.materials.keys())
    for part in ("jacket", "trousers", "helmet", "goggles lens", "skin", "gloves", "boots", "skis", "poles"):
        assert f"Ski {part}" in before
    core("blender.rig").build_rig(skeleton, scene)
    assert set(bpy.data.materials.keys()) == before


def test_at_rest_the_mesh_is_as_it_was_drawn(core, rig, skeleton) -> None:
    import bpy

    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    parts = core("blender.skier.build").build_parts(skeleton)
    for obj, name in ((rig.body, "body"), *((mesh, key) for key, mesh in rig.equipment.items())):
        mesh = obj.evaluated_get(graph).data
        places = np.array([vertex.co for vertex in mesh.vertices])
        np.testing.assert_allclose(places, parts[name].vertices, atol=2e-6)


def test_a_bent_knee_takes_the_boot_along(core, rig, skeleton) -> None:
    import bpy

    rig.armature.pose.bones["shank.L"].rotation_quaternion = (np.cos(0.5), np.sin(0.5), 0.0, 0.0)
    bpy.context.view_layer.update()
    mesh = rig.equipment["ski.L"].evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    moved = np.array([vertex.co for vertex in mesh.vertices])
    drawn = core("blender.skier.build").build_parts(skeleton)["ski.L"].vertices
    assert np.min(np.linalg.norm(moved - drawn, axis=1)) > 0.2
    distances = [np.linalg.norm(points[0] - points[-1]) for points in (moved, drawn)]
    assert distances[0] == pytest.approx(distances[1], abs=1e-5)


def test_building_leaves_no_scene_and_no_mode_behind(scene, rig) -> None:
    import bpy

    assert list(bpy.data.scenes) == [scene]
    assert bpy.context.mode == "OBJECT"
    assert not bpy.context.selected_objects


def test_a_skier_can_be_built_while_another_object_is_edited(core, scene, skeleton) -> None:
    """Bake is pressed in the middle of other work."""
    import bpy

    bpy.ops.mesh.primitive_cube_add()
    bpy.ops.object.mode_set(mode="EDIT")
    core("blender.rig").build_rig(skeleton, scene)
    assert bpy.context.mode == "EDIT_MESH"
    assert len(bpy.data.armatures[0].bones) == 21
    bpy.ops.object.mode_set(mode="OBJECT")
