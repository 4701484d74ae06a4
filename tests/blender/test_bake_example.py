"""The example that bakes into a file of the user's: what it adds, and that it leaves the rest alone."""

from __future__ import annotations

import bpy
import pytest

import ski_addon
from ski_addon.errors import SpecError
from tests.examples.running import run_example

SHORT = {"course.turn_count": 1, "simulation.time_step": 0.004}


@pytest.fixture
def shot(scene, tmp_path):
    """A file with a cube that moves, a camera and an armature that nobody skis."""
    bpy.ops.mesh.primitive_cube_add(location=(3.0, 0.0, 0.0))
    bpy.context.object.name = "Cube"
    bpy.context.object.keyframe_insert("location", frame=1)
    bpy.ops.object.camera_add()
    bpy.context.object.name = "Camera"
    bpy.ops.object.armature_add()
    bpy.context.object.name = "Hero"
    scene.render.fps = 25
    path = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    return path


def open_again(path):
    bpy.ops.wm.open_mainfile(filepath=str(path))
    return bpy.data.objects


def test_a_skier_joins_a_file_of_the_user_s(shot, tmp_path):
    before = shot.read_bytes()
    assert run_example("bake_into_file.py", shot, tmp_path / "skied.blend") == []
    assert shot.read_bytes() == before
    objects = open_again(tmp_path / "skied.blend")
    assert {"Cube", "Camera", "Hero", "Skier"} <= set(objects.keys())
    assert tuple(objects["Cube"].location) == (3.0, 0.0, 0.0) and objects["Cube"].animation_data.action
    skier = objects["Skier"]
    action = skier.animation_data.action
    assert action.name == "Carving" and action.frame_range[0] == 101.0
    assert bpy.context.scene.render.fps == 25
    pelvis = skier.pose.bones["pelvis"]
    places = []
    for frame in (101, 151):
        bpy.context.scene.frame_set(frame)
        places.append((skier.matrix_world @ pelvis.matrix).translation.copy())
    assert 10.0 < (places[1] - places[0]).length < 30.0  # two seconds at about 8 m/s


def test_an_armature_that_is_not_there_is_named_and_the_file_kept(shot, tmp_path):
    recording = ski_addon.simulate(
        ski_addon.load_run("paper_main", {"course.turn_count": 1, "simulation.time_step": 0.004})
    )
    before = shot.read_bytes()
    with pytest.raises(SpecError, match='armature = "Heroine" is no armature of shot.blend: its armatures are: Hero'):
        ski_addon.bake(recording, shot, "Heroine")
    with pytest.raises(SpecError):  # one bone is nobody
        ski_addon.bake(recording, shot, "Hero")
    assert shot.read_bytes() == before
    with pytest.raises(ski_addon.SkiAddonError, match="no such file"):
        ski_addon.bake(recording, tmp_path / "none.blend", "Hero")
    (tmp_path / "broken.blend").write_bytes(b"BLENDER nonsense")
    with pytest.raises(ski_addon.SkiAddonError, match=r"cannot read .*broken\.blend"):
        ski_addon.bake(recording, tmp_path / "broken.blend")


def test_a_file_that_is_not_there_becomes_a_film(tmp_path):
    recording = ski_addon.simulate(
        ski_addon.load_run("paper_main", {"course.turn_count": 1, "simulation.time_step": 0.004})
    )
    made = ski_addon.bake(recording, tmp_path / "film.blend")
    objects = open_again(made)
    assert "Skier" in objects and bpy.context.scene.camera is not None
