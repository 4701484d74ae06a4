"""Bake on users' armatures: Blender's own evaluation shows the recorded directions, with the feet on the skis."""

from __future__ import annotations

import numpy as np
import pytest

from tests.animation.foreign_armatures import angle_between
from tests.blender.armature_tools import (
    build_armature,
    mixamo_armature,
    mixamo_name,
    unreal_joints,
    world_matrix,
    world_pose,
)
from tests.blender.blender_tools import body_matrices, bone_matrices, curves, keys, make_recording

FRAMES = (1, 9, 20)


def unreal(scene):
    return build_armature(scene, unreal_joints())


def metarig(scene):
    return _rigify(scene, basic=False, generate=False)


def basic_rig(scene):
    return _rigify(scene, basic=True, generate=True)


def human_rig(scene):
    return _rigify(scene, basic=False, generate=True)


def _rigify(scene, *, basic: bool, generate: bool):
    import addon_utils
    import bpy

    addon_utils.enable("rigify", default_set=True)
    add = bpy.ops.object.armature_basic_human_metarig_add if basic else bpy.ops.object.armature_human_metarig_add
    add()
    if generate:
        bpy.ops.pose.rigify_generate()
        bpy.ops.object.mode_set(mode="OBJECT")
    return bpy.context.view_layer.objects.active


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


def bake(core, scene, armature, recording=None, bake_options=None, **options):
    tools = core("blender.armatures")
    recording = recording or make_recording(core)
    return tools.bake_on_armature(
        recording, scene, armature, None, tools.ArmatureOptions(**options), bake_options or core("spec").BakeSpec()
    )


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
