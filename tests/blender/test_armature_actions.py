"""Bake on users' armatures: what was there is kept, an earlier bake is replaced, as an action or as a strip."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.armature_tools import (
    bake,
    basic_rig,
    unreal,
    world_matrix,
    world_pose,
)
from tests.blender.blender_tools import body_matrices, curves, keys, make_recording


def test_rigify_is_switched_to_fk_by_keys(core, scene) -> None:
    action = bake(core, scene, basic_rig(scene)).action
    found = curves(action)
    for bone in ("thigh_parent.L", "thigh_parent.R", "upper_arm_parent.L", "upper_arm_parent.R"):
        np.testing.assert_allclose(keys(found[f'pose.bones["{bone}"]["IK_FK"]', 0]), [[1.0, 1.0]])


def test_bones_keep_their_rotation_mode(core, scene) -> None:
    armature = unreal(scene)
    modes = {"thigh_l": "XYZ", "calf_l": "ZYX", "spine_03": "AXIS_ANGLE", "head": "YXZ"}
    recording = make_recording(core)
    shown = []
    for given in ({}, modes):
        for bone, mode in given.items():
            armature.pose.bones[bone].rotation_mode = mode
        bake(core, scene, armature, recording)
        scene.frame_set(17)
        shown.append(np.array([world_pose(armature, bone) for bone in modes]))
    np.testing.assert_allclose(shown[1], shown[0], atol=1e-4)
    assert {bone: armature.pose.bones[bone].rotation_mode for bone in modes} == modes


def test_poses_by_hand_do_not_show_through(core, scene) -> None:
    armature = unreal(scene)
    recording = make_recording(core)
    shown = []
    for _ in range(2):
        bake(core, scene, armature, recording)
        scene.frame_set(17)
        shown.append(world_pose(armature, "hand_l"))
        armature.animation_data.action = None
        armature.pose.bones["root"].location = (1.0, 2.0, 3.0)
        armature.pose.bones["root"].rotation_quaternion = (0.7, 0.7, 0.0, 0.0)
        armature.pose.bones["clavicle_l"].scale = (2.0, 2.0, 2.0)
        armature.pose.bones["thigh_l"].location = (0.1, 0.0, 0.0)
    np.testing.assert_allclose(shown[1], shown[0], atol=1e-4)


def test_baking_again_replaces_its_own_result(core, scene) -> None:
    import bpy

    armature = unreal(scene)
    first = bake(core, scene, armature, make_recording(core, duration=2.0))
    names = {obj.name for obj in bpy.data.objects}
    actions, meshes = len(bpy.data.actions), len(bpy.data.meshes)
    second = bake(core, scene, armature, make_recording(core, duration=1.0))
    assert second.action == first.action
    assert {obj.name for obj in bpy.data.objects} == names
    assert (len(bpy.data.actions), len(bpy.data.meshes)) == (actions, meshes)
    assert scene.frame_end == 25
    assert max(len(curve.keyframe_points) for curve in curves(second.action).values()) == 25
    bake(core, scene, armature, make_recording(core), equipment="none")
    assert {obj.name for obj in bpy.data.objects} == {"Hero"}
    assert len(bpy.data.actions) == 1


def test_skis_of_the_users_own_are_kept(core, scene) -> None:
    import bpy

    armature = unreal(scene)
    recording = make_recording(core)
    gear = bake(core, scene, armature, recording).gear
    mine = bpy.data.meshes.new("My ski")
    gear[0].data = mine
    again = bake(core, scene, armature, recording).gear
    assert again[0] == gear[0]
    assert again[0].data == mine


def test_an_action_of_the_user_is_kept(core, scene) -> None:
    import bpy

    armature = unreal(scene)
    mine = bpy.data.actions.new("Mine")
    armature.animation_data_create().action = mine
    result = bake(core, scene, armature)
    assert armature.animation_data.action == result.action != mine
    assert mine.use_fake_user
    assert "Mine" in bpy.data.actions


def test_a_bake_can_be_a_strip_and_an_action_again(core, scene) -> None:
    import bpy

    armature = unreal(scene)
    recording = make_recording(core)
    plain = bake(core, scene, armature, recording)
    scene.frame_set(17)
    shown = world_pose(armature, "hand_l")
    frame_101 = core("spec").BakeSpec(frame_start=101)
    for _ in range(2):
        result = bake(core, scene, armature, recording, frame_101, as_strip=True)
        data = armature.animation_data
        assert result.action == plain.action
        assert data.action is None
        assert [track.name for track in data.nla_tracks] == ["Ski run"]
        assert len(data.nla_tracks[0].strips) == 1
        assert data.nla_tracks[0].strips[0].action_slot == result.action.slots[0]
        scene.frame_set(117)
        np.testing.assert_allclose(world_pose(armature, "hand_l"), shown, atol=1e-5)
    again = bake(core, scene, armature, recording)
    assert again.action == plain.action == armature.animation_data.action
    assert len(armature.animation_data.nla_tracks) == 0
    assert len([action for action in bpy.data.actions if "pole" not in action.name]) == 1


def test_a_strip_leaves_the_users_actions_and_tracks_alone(core, scene) -> None:
    import bpy

    armature = unreal(scene)
    data = armature.animation_data_create()
    mine, walk = bpy.data.actions.new("Mine"), bpy.data.actions.new("Walk")
    data.action = mine
    data.nla_tracks.new().strips.new("Walk", 1, walk)
    for _ in range(2):
        result = bake(core, scene, armature, as_strip=True)
        assert data.action == mine
        assert [track.strips[0].action for track in data.nla_tracks] == [walk, result.action]
        assert [note for note in result.notes if '"Mine" plays over the strip' in note]


def test_a_strip_on_a_track_of_the_user_is_left_alone(core, scene) -> None:
    armature = unreal(scene)
    first = bake(core, scene, armature, as_strip=True)
    armature.animation_data.nla_tracks[0].name = "Kept"
    second = bake(core, scene, armature, as_strip=True)
    assert second.action != first.action
    assert [track.name for track in armature.animation_data.nla_tracks] == ["Kept", "Ski run"]


def test_keys_are_reduced_within_the_tolerance(core, scene) -> None:
    armature = unreal(scene)
    recording = make_recording(core, duration=3.0)
    scene.render.fps = 60
    shown = []
    for tolerance in (0.0, 0.2):
        result = bake(core, scene, armature, recording, tolerance_deg=tolerance, tolerance_mm=5.0 * tolerance)
        scene.frame_set(50)
        shown.append(
            (
                world_pose(armature, "calf_l"),
                len(curves(result.action)['pose.bones["thigh_l"].rotation_quaternion', 0].keyframe_points),
            )
        )
    assert shown[1][1] < 0.5 * shown[0][1]
    np.testing.assert_allclose(shown[1][0][:3, 3], shown[0][0][:3, 3], atol=0.004)


@pytest.mark.parametrize("as_strip", [False, True])
def test_an_override_of_a_linked_armature_is_baked(core, scene, tmp_path, as_strip: bool) -> None:
    import bpy

    unreal(scene)
    path = str(tmp_path / "library.blend")
    bpy.data.libraries.write(path, {scene.objects["Hero"]})
    bpy.data.objects.remove(scene.objects["Hero"])
    with bpy.data.libraries.load(path, link=True) as (there, here):
        here.objects = there.objects
    armature = here.objects[0].override_create()
    scene.collection.objects.link(armature)
    recording = make_recording(core)
    for _ in range(2):
        gear = bake(core, scene, armature, recording, as_strip=as_strip).gear
    scene.frame_set(20)
    want = body_matrices(core, recording, 19 / 24)
    for obj in gear[:2]:
        np.testing.assert_allclose(world_matrix(obj), want[obj["ski_addon_gear"]], atol=1e-4)


def test_the_object_may_have_a_rotation_mode_and_an_action_of_its_own(core, scene) -> None:
    import bpy

    armature = unreal(scene)
    armature.rotation_mode = "YZX"
    mine = bpy.data.actions.new("Mine")
    armature.animation_data_create().action = mine
    armature.keyframe_insert("location", frame=1)
    recording = make_recording(core)
    result = bake(core, scene, armature, recording, root="object")
    assert armature.rotation_mode == "YZX"
    assert mine.use_fake_user
    scene.frame_set(20)
    want = body_matrices(core, recording, 19 / 24)
    for obj in result.gear[:2]:
        np.testing.assert_allclose(world_matrix(obj), want[obj["ski_addon_gear"]], atol=1e-4)


def test_nothing_else_of_the_file_is_changed(core, scene) -> None:
    import bpy

    armature = unreal(scene)
    cube = bpy.data.objects.new("Cube", bpy.data.meshes.new("Cube"))
    scene.collection.objects.link(cube)
    for obj in bpy.context.selected_objects:
        obj.select_set(False)
    cube.select_set(True)
    bpy.context.view_layer.objects.active = cube
    scene.frame_set(5)
    bake(core, scene, armature)
    assert [obj.name for obj in bpy.context.selected_objects] == ["Cube"]
    assert bpy.context.view_layer.objects.active == cube
    assert scene.frame_current == 5
    assert len(bpy.data.scenes) == 1
