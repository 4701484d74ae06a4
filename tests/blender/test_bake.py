"""Bake: Blender's own evaluation of the keys puts every bone where the recording has its body."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.blender_tools import body_matrices, bone_matrices, curves, keys, make_recording


def set_rate(scene, fps: int, base: float = 1.0) -> None:
    scene.render.fps, scene.render.fps_base = fps, base


def assert_follows(core, scene, armature, recording, frame: float, time: float) -> None:
    """Every bone is where its body is, to 1e-5 [m, and in matrix elements]."""
    whole = int(np.floor(frame))
    scene.frame_set(whole, subframe=frame - whole)
    want, got = body_matrices(core, recording, time), bone_matrices(core, armature, recording)
    for body, matrix in want.items():
        np.testing.assert_allclose(got[body], matrix, atol=1e-5, err_msg=f"{body} at frame {frame}")


@pytest.mark.parametrize(("fps", "base"), [(24, 1.0), (24, 1.001), (60, 1.0), (25, 0.5)])
def test_bones_are_where_their_bodies_are(core, scene, fps: int, base: float) -> None:
    set_rate(scene, fps, base)
    recording = make_recording(core)
    result = core("blender.bake").bake_recording(recording, scene)
    for frame in (scene.frame_start, scene.frame_start + 7, scene.frame_end):
        assert_follows(core, scene, result.armature, recording, frame, (frame - 1) * base / fps)


@pytest.mark.parametrize("subframes", [2, 4])
def test_subframes_have_keys_of_their_own(core, scene, subframes: int) -> None:
    set_rate(scene, 24)
    recording = make_recording(core)
    options = core("spec").BakeSpec(subframes=subframes)
    result = core("blender.bake").bake_recording(recording, scene, options=options)
    for part in range(subframes):
        frame = 9 + part / subframes
        assert_follows(core, scene, result.armature, recording, frame, (frame - 1) / 24)


def test_the_first_frame_is_where_it_is_asked_for(core, scene) -> None:
    recording = make_recording(core)
    options = core("spec").BakeSpec(frame_start=101, action="Run at 101")
    result = core("blender.bake").bake_recording(recording, scene, options=options)
    assert (scene.frame_start, scene.frame_end) == (101, 125)
    assert (result.action.frame_start, result.action.frame_end) == (101.0, 125.0)
    assert result.action.use_frame_range
    assert result.action.name == "Run at 101"
    assert_follows(core, scene, result.armature, recording, 113, 0.5)


def test_an_armature_that_was_moved_still_follows_the_world(core, scene) -> None:
    import bpy

    recording = make_recording(core)
    bake = core("blender.bake")
    armature = bake.bake_recording(recording, scene).armature
    armature.location, armature.rotation_euler = (3.0, -2.0, 1.0), (0.2, 0.1, 1.0)
    bpy.context.view_layer.update()
    bake.bake_recording(recording, scene, armature=armature)
    assert_follows(core, scene, armature, recording, 12, 11 / 24)


@pytest.mark.parametrize("changes", [{"skier.height": 1.2, "skier.mass": 30}, {"skier.height": 2.1, "skier.mass": 130}])
def test_any_person_can_be_baked(core, scene, changes: dict) -> None:
    recording = make_recording(core, duration=0.3, **changes)
    result = core("blender.bake").bake_recording(recording, scene)
    assert_follows(core, scene, result.armature, recording, 5, 4 / 24)


def test_quaternions_do_not_jump(core, scene) -> None:
    action = core("blender.bake").bake_recording(make_recording(core, duration=2.0), scene).action
    found = curves(action)
    bones = {path for path, _ in found if path.endswith("rotation_quaternion")}
    assert len(bones) == 20
    for path in bones:
        quaternion = np.stack([keys(found[path, i])[:, 1] for i in range(4)], axis=1)
        assert np.max(np.linalg.norm(np.diff(quaternion, axis=0), axis=1)) < 0.3, path
        np.testing.assert_allclose(np.linalg.norm(quaternion, axis=1), 1.0, atol=1e-5)


def test_keys_are_linear_and_few(core, scene) -> None:
    action = core("blender.bake").bake_recording(make_recording(core), scene).action
    found = curves(action)
    assert {point.interpolation for curve in found.values() for point in curve.keyframe_points} == {"LINEAR"}
    assert {path for path, _ in found if path.endswith("location")} == {'pose.bones["pelvis"].location'}
    assert not [path for path, _ in found if path.endswith("scale")]
    assert len(found) == 20 * 4 + 3 + 7


def test_numbers_to_drive_with_are_animated(core, scene) -> None:
    recording = make_recording(core)
    armature = core("blender.bake").bake_recording(recording, scene).armature
    scene.frame_set(13)  # half a second
    swing = np.sin(2 * np.pi * 0.5 / 3.0)
    assert armature["speed"] == pytest.approx(6.0 + swing**2, rel=1e-5)
    assert armature["inclination"] == pytest.approx(25.0 * swing, rel=1e-5)
    assert armature["edge_angle_left"] == pytest.approx(27.5 * swing, rel=1e-5)
    assert armature["edge_angle_right"] == pytest.approx(30.0 * swing, rel=1e-5)
    assert armature["turn_phase"] == pytest.approx(swing, rel=1e-5)
    assert armature["snow_force_left"] < armature["snow_force_right"]
    assert "[deg]" in armature.id_properties_ui("edge_angle_left").as_dict()["description"]


def test_baking_again_replaces_its_own_keys(core, scene) -> None:
    import bpy

    bake = core("blender.bake")
    first = bake.bake_recording(make_recording(core, duration=2.0), scene)
    second = bake.bake_recording(make_recording(core, duration=1.0), scene, armature=first.armature)
    assert second.action == first.action
    assert len(bpy.data.actions) == 1
    assert {len(curve.keyframe_points) for curve in curves(second.action).values()} == {25}
    assert scene.frame_end == 25


def test_an_action_of_the_user_is_left_alone(core, scene) -> None:
    import bpy

    bake = core("blender.bake")
    recording = make_recording(core, duration=0.5)
    armature = bake.bake_recording(recording, scene).armature
    mine = bpy.data.actions.new("Mine")
    armature.animation_data.action = mine
    result = bake.bake_recording(recording, scene, armature=armature)
    assert result.action != mine
    assert mine.use_fake_user, "the displaced action would be lost on saving"
    assert armature.animation_data.action_slot == result.action.slots[0]


def test_an_action_that_others_use_is_left_alone(core, scene) -> None:
    bake = core("blender.bake")
    recording = make_recording(core, duration=0.5)
    first = bake.bake_recording(recording, scene)
    track = first.armature.animation_data.nla_tracks.new()
    track.strips.new("kept", 200, first.action)
    second = bake.bake_recording(recording, scene, armature=first.armature)
    assert second.action != first.action


def test_bake_touches_nothing_else(core, scene) -> None:
    import bpy

    cube = bpy.data.objects.new("Cube", bpy.data.meshes.new("Cube"))
    scene.collection.objects.link(cube)
    cube.select_set(True)
    bpy.context.view_layer.objects.active = cube
    scene.frame_set(5)
    scenes, handlers = len(bpy.data.scenes), list(bpy.app.handlers.frame_change_post)
    core("blender.bake").bake_recording(make_recording(core, duration=0.2), scene)
    assert [obj.name for obj in bpy.context.selected_objects] == ["Cube"]
    assert bpy.context.view_layer.objects.active == cube
    assert scene.frame_current == 5
    assert len(bpy.data.scenes) == scenes
    assert list(bpy.app.handlers.frame_change_post) == handlers
    assert cube.animation_data is None


def test_an_object_that_is_no_armature_is_refused(core, scene) -> None:
    import bpy

    cube = bpy.data.objects.new("Cube", bpy.data.meshes.new("Cube"))
    with pytest.raises(core("errors").SpecError, match="Cube"):
        core("blender.bake").bake_recording(make_recording(core, duration=0.1), scene, armature=cube)
    assert len(bpy.data.actions) == 0


def test_an_armature_without_the_bones_is_refused(core, scene) -> None:
    import bpy

    other = bpy.data.objects.new("Other", bpy.data.armatures.new("Other"))
    scene.collection.objects.link(other)
    with pytest.raises(core("errors").SpecError, match=r"bones\.pelvis"):
        core("blender.bake").bake_recording(make_recording(core, duration=0.1), scene, armature=other)
    assert len(bpy.data.actions) == 0


def test_a_skier_of_other_measures_does_not_fit(core, scene) -> None:
    bake = core("blender.bake")
    recording = make_recording(core, duration=0.1)
    armature = bake.bake_recording(recording, scene).armature
    assert bake.fits(armature, bake.recorded_skier(recording))
    taller = make_recording(core, duration=0.1, **{"skier.height": 1.8})
    assert not bake.fits(armature, bake.recorded_skier(taller))


def test_a_long_run_is_baked_quickly(core, scene) -> None:
    import time

    recording = make_recording(core, duration=40.0)
    set_rate(scene, 100)
    armature = core("blender.bake").bake_recording(recording, scene).armature
    started = time.perf_counter()
    core("blender.bake").bake_recording(recording, scene, armature=armature)
    assert time.perf_counter() - started < 6.0  # 4000 frames, about 1 s on a quiet machine
