"""Baked figures: bones and meshes are where the core's poses have the bodies, for every kind."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.blender.blender_tools import curves, keys

KINDS = ("alpine", "snowboard", "telemark", "bicycle")
MILLIMETRE = 1e-3


class Instant:
    """A figure and its motion on a short run, with the modules of the extension."""

    def __init__(self, core, kind: str, **changes: object) -> None:
        self.core = core
        short = {"figure.kind": kind, "course.turn_count": 2, "slope.angle_deg": 8.0, "bake.fps": 24}
        self.spec = core("spec").RunSpec().with_overrides(short | changes)
        self.model = core("turning.figures").build_figure(self.spec)
        self.motion = core("turning.preview").preview_motion(self.spec)

    def bake(self, scene, **options):
        return self.core("blender.figures").bake_figure(self.model, self.spec, self.motion, scene, **options)

    def bodies(self, time: float) -> dict[str, np.ndarray]:
        terrain = self.core("terrain").build_terrain(self.spec.slope)
        poses = self.core("turning.figures").poses_at(
            self.model, self.spec, self.motion, np.array([time]), terrain=terrain
        )
        return dict(zip(poses.body_names, poses.matrices()[0], strict=True))


@pytest.fixture(params=KINDS)
def instant(core, extension, request) -> Instant:
    return Instant(core, request.param)


def evaluated_bones(instant: Instant, armature) -> dict[str, np.ndarray]:
    """The world matrix that each body has if it goes with its bone, evaluated at the current frame."""
    import bpy

    evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    world = np.array(evaluated.matrix_world)
    found = {}
    for name, place, turn in zip(instant.model.body_names, instant.model.place, instant.model.turn, strict=True):
        rest_body = np.eye(4)
        rest_body[:3, :3], rest_body[:3, 3] = turn, place
        rest_bone = np.array(armature.data.bones[name].matrix_local)
        found[name] = world @ np.array(evaluated.pose.bones[name].matrix) @ np.linalg.inv(rest_bone) @ rest_body
    return found


def mesh_points(obj) -> np.ndarray:
    import bpy

    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    places = np.array([vertex.co for vertex in evaluated.data.vertices])
    matrix = np.array(evaluated.matrix_world)
    return places @ matrix[:3, :3].T + matrix[:3, 3]


def test_every_body_is_where_the_core_has_it(scene, instant: Instant) -> None:
    armature = instant.bake(scene).armature
    for frame in np.linspace(scene.frame_start, scene.frame_end, 7).astype(int):
        scene.frame_set(int(frame))
        wanted, found = instant.bodies((frame - 1) / 24.0), evaluated_bones(instant, armature)
        for name, matrix in wanted.items():
            apart = np.linalg.norm(found[name][:3, 3] - matrix[:3, 3])
            assert apart < MILLIMETRE, f"{name} at frame {frame}: {1e3 * apart:.2f} mm"
            np.testing.assert_allclose(found[name][:3, :3], matrix[:3, :3], atol=2e-5, err_msg=f"{name} at {frame}")


def test_gear_meshes_go_with_their_bodies(core, scene, instant: Instant) -> None:
    armature = instant.bake(scene).armature
    rig = core("blender.rig").find_rig(armature)
    parts = core("blender.skier.build").figure_parts(core("blender.skier.figure").figure_of(instant.model))
    frame = (scene.frame_start + scene.frame_end) // 2
    scene.frame_set(frame)
    wanted = instant.bodies((frame - 1) / 24.0)
    for name, obj in rig.equipment.items():
        index = instant.model.body_names.index(name)
        local = (parts[name].vertices - instant.model.place[index]) @ instant.model.turn[index]
        expected = local @ wanted[name][:3, :3].T + wanted[name][:3, 3]
        assert np.abs(mesh_points(obj) - expected).max() < MILLIMETRE, name


def test_soles_stand_on_what_carries_them(core, scene, instant: Instant) -> None:
    """The soles' lowest points lie on the board or the ski's plate, or at the pedals' axles."""
    armature = instant.bake(scene).armature
    rig = core("blender.rig").find_rig(armature)
    figure = core("blender.skier.figure").figure_of(instant.model)
    body = core("blender.skier.build").body_part(figure)
    for frame in np.linspace(scene.frame_start, scene.frame_end, 5).astype(int):
        scene.frame_set(int(frame))
        points, wanted = mesh_points(rig.body), instant.bodies((frame - 1) / 24.0)
        for side in "LR":
            carrier, height = {
                "snowboard": ("board", 0.034),
                "bicycle": (f"pedal.{side}", 0.0),
            }.get(instant.model.kind, (f"ski.{side}", 0.034))
            on = body.weights[f"foot.{side}"]
            if instant.model.kind == "telemark":
                on = body.weights[f"ski.{side}"]  # the toes, which stay on the ski
            matrix = wanted[carrier]
            sole = (body.vertices[:, 2] < figure.sole + 1e-6) & (on > 0.999)
            assert sole.sum() > 2
            local = (points[sole] - matrix[:3, 3]) @ matrix[:3, :3]
            if instant.model.kind == "bicycle":  # the foot is pitched: its ball is on the axle
                ball = instant.core("blender.skier.shoes").ball_of(figure, side)
                foot = wanted[f"foot.{side}"]
                at = foot[:3, :3] @ ball + foot[:3, 3]
                assert np.linalg.norm((at - matrix[:3, 3])[[0, 2]]) < MILLIMETRE
            else:
                assert np.abs(local[:, 2] - height).max() < MILLIMETRE, f"{carrier} at frame {frame}"


def test_hands_are_on_the_bar(core, scene) -> None:
    instant = Instant(core, "bicycle")
    armature = instant.bake(scene).armature
    rig = core("blender.rig").find_rig(armature)
    fork = rig.equipment["fork"]
    materials = [material.name for material in fork.data.materials]
    grip = {v for face in fork.data.polygons if materials[face.material_index] == "Ski grips" for v in face.vertices}
    grip_index = np.array(sorted(grip))
    half = 0.5 * instant.model.skeleton.lengths["hand"]
    for frame in np.linspace(scene.frame_start, scene.frame_end, 5).astype(int):
        scene.frame_set(int(frame))
        points, bones = mesh_points(fork)[grip_index], evaluated_bones(instant, armature)
        hands = [bones[f"hand.{s}"][:3, 3] - half * bones[f"hand.{s}"][:3, 2] for s in "LR"]
        nearest = np.argmin([np.linalg.norm(points - hand, axis=1) for hand in hands], axis=0)
        for side, hand in enumerate(hands):
            assert np.linalg.norm(points[nearest == side].mean(axis=0) - hand) < MILLIMETRE


def test_wheels_touch_the_ground(core, scene) -> None:
    instant = Instant(core, "bicycle")
    rig = core("blender.rig").find_rig(instant.bake(scene).armature)
    terrain = core("terrain").build_terrain(instant.spec.slope)
    for frame in np.linspace(scene.frame_start, scene.frame_end, 5).astype(int):
        scene.frame_set(int(frame))
        for name in ("wheel_rear", "wheel_front"):
            points = mesh_points(rig.equipment[name])
            above = points[:, 2] - terrain.height(points[:, 0], points[:, 1])
            assert -0.012 < above.min() < 0.003, name  # a tyre that leans stands on its shoulder


def test_every_bone_has_keys_on_every_frame_and_every_number_too(core, scene, instant: Instant) -> None:
    result = instant.bake(scene)
    found = curves(result.action)
    count = scene.frame_end - scene.frame_start + 1
    assert {len(curve.keyframe_points) for curve in found.values()} == {count}
    turned = {path.split('"')[1] for path, _ in found if path.endswith("rotation_quaternion")}
    moved = {path.split('"')[1] for path, _ in found if path.endswith("location")}
    assert turned == set(instant.model.body_names)
    assert moved == set(instant.model.free)
    channels = core("turning.figures").figure_channels(instant.model, instant.spec, instant.motion, np.array([0.0]))
    assert len(channels) >= 4
    for channel in channels:
        assert channel.name in result.armature
        assert len(keys(found[f'["{channel.name}"]', 0])) == count


def test_quaternions_do_not_jump(scene, instant: Instant) -> None:
    """Keys lie so near to each other that what is between them is right; wheels turn fastest."""
    found = curves(instant.bake(scene).action)
    for path in {path for path, _ in found if path.endswith("rotation_quaternion")}:
        quaternion = np.stack([keys(found[path, i])[:, 1] for i in range(4)], axis=1)
        step = np.linalg.norm(np.diff(quaternion, axis=0), axis=1).max()
        assert step < (0.8 if "wheel" in path else 0.35), path


def test_baking_again_replaces_its_own_keys_and_touches_nothing_else(core, scene, instant: Instant) -> None:
    import bpy

    cube = bpy.data.objects.new("Cube", None)
    scene.collection.objects.link(cube)
    handlers = list(bpy.app.handlers.frame_change_post)
    first = instant.bake(scene)
    objects = set(bpy.data.objects.keys())
    second = instant.bake(scene, armature=first.armature)
    assert second.action == first.action and len(bpy.data.actions) == 1
    assert set(bpy.data.objects.keys()) == objects
    assert list(bpy.app.handlers.frame_change_post) == handlers
    assert list(bpy.data.scenes) == [scene] and cube.animation_data is None


def test_a_figure_fits_the_run_it_was_made_for_only(core, scene, instant: Instant) -> None:
    figures = core("blender.figures")
    armature = instant.bake(scene).armature
    assert figures.figure_fits(armature, instant.spec)
    assert not figures.figure_fits(armature, instant.spec.with_overrides({"skier.height": 1.9}))
    other = "bicycle" if instant.model.kind != "bicycle" else "snowboard"
    assert not figures.figure_fits(armature, instant.spec.with_overrides({"figure.kind": other}))


def test_an_armature_of_another_figure_is_refused(core, scene) -> None:
    board, bicycle = Instant(core, "snowboard"), Instant(core, "bicycle")
    armature = board.bake(scene).armature
    with pytest.raises(core("errors").SpecError, match=r"bones\.frame"):
        bicycle.bake(scene, armature=armature)


def test_a_written_file_is_plain_data(core, scene, instant: Instant, tmp_path: Path) -> None:
    import bpy

    target = tmp_path / "figure.blend"
    core("blender.figures").preview_file(instant.spec, instant.motion, target)
    bpy.ops.wm.open_mainfile(filepath=str(target))
    armature = next(obj for obj in bpy.data.objects if obj.type == "ARMATURE")
    assert armature.animation_data.action is not None
    assert bpy.context.scene.camera is not None and "Slope" in bpy.data.objects
    assert not bpy.data.texts and not bpy.data.libraries
    bpy.context.scene.frame_set(12)
    found = evaluated_bones(instant, armature)
    for name, matrix in instant.bodies(11 / 24.0).items():
        assert np.linalg.norm(found[name][:3, 3] - matrix[:3, 3]) < MILLIMETRE, name
    assert [path.name for path in tmp_path.iterdir()] == ["figure.blend"]


def test_a_picture_shows_the_figure_at_several_instants(core, scene, instant: Instant, tmp_path: Path) -> None:
    import bpy

    ride = core("blender.ride").instant_ride(instant.model, instant.spec, instant.motion)
    target = tmp_path / "figure.png"
    core("blender.strobe").render_ride(ride, instant.spec, target, 4, size=(64, 36), samples=1)
    assert len([obj for obj in bpy.context.scene.objects if "body instant" in obj.name]) == 4
    assert bpy.data.images.load(str(target)).size[0] == 64
