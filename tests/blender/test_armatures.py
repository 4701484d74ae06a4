"""Bake on users' armatures: Blender's own evaluation shows the recorded directions, with the feet on the skis."""

from __future__ import annotations

import numpy as np
import pytest

from tests.animation.foreign_armatures import angle_between
from tests.blender.armature_tools import (
    bake,
    basic_rig,
    human_rig,
    metarig,
    mixamo_armature,
    mixamo_name,
    unreal,
    world_matrix,
    world_pose,
)
from tests.blender.blender_tools import body_matrices, bone_matrices, make_recording

FRAMES = (1, 9, 20)


UNREAL = {
    "upper_arm.L": ("upperarm_l", "lowerarm_l"),
    "forearm.R": ("lowerarm_r", "hand_r"),
    "thigh.L": ("thigh_l", "calf_l"),
    "shank.R": ("calf_r", "foot_r"),
}
META = {
    "upper_arm.L": ("upper_arm.L", "forearm.L"),
    "forearm.R": ("forearm.R", "hand.R"),
    "thigh.L": ("thigh.L", "shin.L"),
    "shank.R": ("shin.R", "foot.R"),
}
# kind: (maker, map, limbs by the bones at their two joints, bones of the trunk and feet)
KINDS = {
    "unreal": (unreal, "unreal_mannequin", UNREAL, {"pelvis": "pelvis", "chest": "spine_03", "head": "head"}),
    "mixamo": (
        mixamo_armature,
        "mixamo",
        {body: tuple("mixamorig:" + mixamo_name(bone) for bone in ends) for body, ends in UNREAL.items()},
        {"pelvis": "mixamorig:Hips", "chest": "mixamorig:Spine2", "head": "mixamorig:Head"},
    ),
    "metarig": (metarig, "rigify_metarig", META, {"pelvis": "spine", "chest": "spine.003", "head": "spine.006"}),
    "rig": (
        basic_rig,
        "rigify_rig",
        {body: tuple("DEF-" + bone for bone in ends) for body, ends in META.items()},
        {"pelvis": "ORG-spine", "chest": "ORG-spine.003", "head": "DEF-spine.006"},
    ),
}
KINDS["human rig"] = (human_rig, *KINDS["rig"][1:])
ALL = pytest.mark.parametrize(
    "kind", ["unreal", "mixamo", "metarig", "rig", pytest.param("human rig", marks=pytest.mark.slow)]
)
FOOT = {"unreal": "foot_l", "mixamo": "mixamorig:LeftFoot", "metarig": "foot.L", "rig": "DEF-foot.L"}


@ALL
def test_the_map_is_found(core, scene, kind: str) -> None:
    maker, name, _, _ = KINDS[kind]
    found = core("blender.armatures").detect_bone_map(maker(scene))
    assert found.path.stem == name
    assert found.missing == ()


@ALL
@pytest.mark.parametrize("legs", ["angles", "reach"])
def test_parts_point_as_recorded(core, scene, kind: str, legs: str) -> None:
    maker, _, limbs, trunk = KINDS[kind]
    armature = maker(scene)
    rest = {bone: np.array(armature.matrix_world @ armature.data.bones[bone].matrix_local) for bone in trunk.values()}
    recording = make_recording(core)
    result = bake(core, scene, armature, recording, legs=legs)
    for frame in FRAMES:
        scene.frame_set(frame)
        want = body_matrices(core, recording, (frame - 1) / 24)
        for body, (near, far) in limbs.items():
            line = world_pose(armature, near)[:3, 3] - world_pose(armature, far)[:3, 3]
            if legs == "angles" or body[:5] not in ("thigh", "shank"):
                assert angle_between(line, want[body][:3, 2]) < 0.5, (body, frame)
            else:
                assert angle_between(line, want[body][:3, 2]) < 20.0, (body, frame)
        for body, bone in trunk.items():
            own = rest[bone][:3, :3] / np.linalg.norm(rest[bone][:3, :3], axis=0)
            moved = world_pose(armature, bone)[:3, :3] @ own.T
            assert angle_between(moved @ [0.0, 0.0, 1.0], want[body][:3, 2]) < 0.5, (body, frame)
            assert angle_between(moved @ [0.0, -1.0, 0.0], want[body][:3, 0]) < 0.5, (body, frame)
    assert (result.foot_error < 1e-4) == (legs == "reach")


@ALL
def test_limbs_twist_as_recorded(core, scene, kind: str) -> None:
    """The axes of every body at rest, carried along by its bone, lie on the recorded axes: twist included."""
    armature = KINDS[kind][0](scene)
    tools, checks = core("blender.armatures"), core("blender.armature_checks")
    rest = checks.target_rest(armature)
    target = core("animation.target").measure_target(tools.detect_bone_map(armature).bone_map, rest)
    assert len(target.main) >= 15
    recording = make_recording(core)
    bake(core, scene, armature, recording, legs="angles")
    for frame in FRAMES:
        scene.frame_set(frame)
        want = body_matrices(core, recording, (frame - 1) / 24)
        for body, bone in target.main.items():
            own = rest.matrix[rest.bones.index(bone), :3, :3]
            shown = world_pose(armature, bone)[:3, :3] @ own.T @ target.frame[body]
            for axis in range(3):
                assert angle_between(shown[:, axis], want[body][:3, axis]) < 0.5, (body, frame)


def test_a_skier_made_here_moves_as_its_own_bake_moves_it(core, scene) -> None:
    recording = make_recording(core)
    armature = core("blender.bake").bake_recording(recording, scene).armature
    assert core("blender.armatures").detect_bone_map(armature).path.stem == "skier"
    result = bake(core, scene, armature, recording)
    assert result.gear == ()
    for frame in FRAMES:
        scene.frame_set(frame)
        want, got = body_matrices(core, recording, (frame - 1) / 24), bone_matrices(core, armature, recording)
        for body, matrix in want.items():
            np.testing.assert_allclose(got[body], matrix, atol=2e-3, err_msg=f"{body} at frame {frame}")


@ALL
def test_skis_lie_where_they_were_recorded_and_poles_are_in_the_hands(core, scene, kind: str) -> None:
    armature = KINDS[kind][0](scene)
    recording = make_recording(core)
    result = bake(core, scene, armature, recording)
    gear = {obj["ski_addon_gear"]: obj for obj in result.gear}
    assert set(gear) == {"ski.L", "ski.R", "pole.L", "pole.R"}
    for frame in FRAMES:
        scene.frame_set(frame)
        want = body_matrices(core, recording, (frame - 1) / 24)
        for body in ("ski.L", "ski.R"):
            found = world_matrix(gear[body])
            np.testing.assert_allclose(found[:3, 3], want[body][:3, 3], atol=0.005, err_msg=body)
            np.testing.assert_allclose(found[:3, :3], want[body][:3, :3], atol=0.005, err_msg=body)
        for body in ("pole.L", "pole.R"):
            found = world_matrix(gear[body])
            np.testing.assert_allclose(found[:3, :3], want[body][:3, :3], atol=0.005, err_msg=body)
            hand = world_pose(armature, gear[body].parent_bone)[:3, 3]
            assert 0.02 < np.linalg.norm(found[:3, 3] - hand) < 0.15
    assert np.ptp(np.array(gear["ski.L"].data.vertices[0].co)) < 3.0


@pytest.mark.parametrize("kind", ["unreal", "mixamo", "metarig", "rig"])
def test_soles_stand_on_the_snow_without_skis(core, scene, kind: str) -> None:
    armature = KINDS[kind][0](scene)
    rest = np.array(armature.matrix_world @ armature.data.bones[FOOT[kind]].matrix_local)
    recording = make_recording(core)
    result = bake(core, scene, armature, recording, equipment="none")
    assert result.gear == () and not armature.children
    for frame in FRAMES:
        scene.frame_set(frame)
        ski = body_matrices(core, recording, (frame - 1) / 24)["ski.L"]
        height = (world_pose(armature, FOOT[kind])[:3, 3] - ski[:3, 3]) @ ski[:3, 2]
        assert height == pytest.approx(rest[2, 3], abs=0.005)


@pytest.mark.parametrize("kind", ["unreal", "rig", "mixamo"])
@pytest.mark.parametrize("root", ["bone", "object"])
def test_root_or_object_carry_the_motion(core, scene, kind: str, root: str) -> None:
    maker, _, limbs, trunk = KINDS[kind]
    armature = maker(scene)
    if kind == "mixamo" and root == "bone":
        with pytest.raises(core("errors").SpecError, match="Hero has no root bone"):
            bake(core, scene, armature, root=root)
        return
    recording = make_recording(core)
    bones = [*trunk.values(), *(near for near, _ in limbs.values())]
    start = np.array(armature.matrix_world)
    poses = []
    for carrier in ("pelvis", root, "pelvis"):
        bake(core, scene, armature, recording, root=carrier)
        scene.frame_set(20)
        poses.append(np.array([world_pose(armature, bone) for bone in bones]))
        carried = world_matrix(armature) if carrier == "object" else None
        if carrier == "object":
            skis = body_matrices(core, recording, 19 / 24)
            between = 0.5 * (skis["ski.L"] + skis["ski.R"])[:3, 3]
            assert np.linalg.norm(carried[:3, 3] - between) < 0.2
    np.testing.assert_allclose(poses[1], poses[0], atol=2e-4)
    np.testing.assert_allclose(poses[2], poses[0], atol=2e-4)
    np.testing.assert_allclose(world_matrix(armature), start, atol=1e-5)


def test_a_moved_armature_still_follows_the_world(core, scene) -> None:
    import bpy

    recording = make_recording(core)
    armature = unreal(scene)
    armature.location, armature.rotation_euler, armature.scale = (3.0, -2.0, 1.0), (0.2, 0.1, 1.0), (0.8,) * 3
    bpy.context.view_layer.update()
    gear = bake(core, scene, armature, recording).gear
    scene.frame_set(20)
    want = body_matrices(core, recording, 19 / 24)
    for obj in gear[:2]:
        np.testing.assert_allclose(world_matrix(obj), want[obj["ski_addon_gear"]], atol=1e-4)


def test_another_units_file_may_be_in_centimetres(core, scene) -> None:
    armature = mixamo_armature(scene, prefix="")
    assert core("blender.armatures").detect_bone_map(armature).path.stem == "mixamo"
    assert bake(core, scene, armature).foot_error < 1e-4


def test_bones_may_carry_their_children_relatively(core, scene) -> None:
    armature = unreal(scene)
    for bone in armature.data.bones:
        bone.use_relative_parent = True
    recording = make_recording(core)
    gear = bake(core, scene, armature, recording).gear
    scene.frame_set(20)
    want = body_matrices(core, recording, 19 / 24)
    for obj in gear[:2]:
        np.testing.assert_allclose(world_matrix(obj), want[obj["ski_addon_gear"]], atol=1e-4)
