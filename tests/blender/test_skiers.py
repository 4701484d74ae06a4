"""Several skiers in a scene, each with a run of its own, through saving, appending and undo."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture
def skiers(core, scene):
    return core("blender.skiers")


def shown(core, scene, obj=None):
    return core("blender.shown").skier_of(SimpleNamespace(scene=scene, object=obj))


def test_a_new_skier_is_active_and_shown(core, scene) -> None:
    import bpy

    assert bpy.ops.ski.add_skier(preset="slalom") == {"FINISHED"}
    skier = bpy.context.object
    assert skier.ski.is_skier and skier.select_get()
    assert scene.ski_skier == skier
    properties = core("blender.properties")
    assert properties.read_spec(skier.ski) == properties.preset_specs()["slalom"]


def test_two_skiers_have_two_runs(core, scene, skiers) -> None:
    one, other = skiers.add_skier(scene, preset="slalom"), skiers.add_skier(scene, preset="moguls")
    one.ski.skier.mass = 90.0
    read = core("blender.properties").read_spec
    assert read(one.ski).course.kind == "gates" and read(one.ski).skier.mass == 90.0
    assert read(other.ski).course.kind == "bumps" and read(other.ski).skier.mass != 90.0


def test_the_tab_shows_the_selected_skier_s_run_or_the_chosen_one(core, scene, skiers) -> None:
    import bpy

    assert shown(core, scene) is None
    one = skiers.add_skier(scene)
    assert shown(core, scene) == one
    other = skiers.add_skier(scene)
    assert shown(core, scene, one) == one
    assert shown(core, scene, one.children[0]) == one  # a ski of it
    assert shown(core, scene, one.ski.start) == one
    assert shown(core, scene) == other  # the one chosen in the scene
    cube = bpy.data.objects.new("Cube", None)
    scene.collection.objects.link(cube)
    scene.ski_skier = one
    assert shown(core, scene, cube) == one


def test_without_a_skier_the_buttons_say_what_to_do(scene) -> None:
    import bpy

    for operator in (bpy.ops.ski.plan, bpy.ops.ski.simulate):
        with pytest.raises(RuntimeError, match="the skier is missing: press Add Skier"):
            operator()


def test_the_motion_lies_where_the_start_is(core, scene, skiers) -> None:
    """Baked in the run's frame, the skier goes with the start object."""
    import bpy

    scene.cursor.location = (100.0, 50.0, 7.0)
    skier = skiers.add_skier(scene, preset="beginner_turns")
    skier.ski.start.rotation_euler.z = math.radians(90.0)
    bpy.ops.ski.bake(source="PREVIEW")
    scene.frame_set(1)
    first = np.array(skier.matrix_world @ skier.pose.bones["pelvis"].head)
    scene.frame_set(120)
    later = np.array(skier.matrix_world @ skier.pose.bones["pelvis"].head)
    assert np.hypot(*(first[:2] - (100.0, 50.0))) < 1.0 and 7.0 < first[2] < 8.5
    moved = later - first
    assert moved[1] > 10.0 and abs(moved[0]) < 0.5 * moved[1]  # the fall line is +y now
    assert moved[2] < -1.0
    slope = skier.ski.ground.objects["Slope"]
    low, high = (np.array(slope.matrix_world @ slope.data.vertices[i].co) for i in (0, -1))
    assert low[1] != pytest.approx(high[1])


def test_an_armature_of_one_s_own_becomes_a_skier(core, scene, skiers) -> None:
    import bpy

    armature = bpy.data.objects.new("Hero", bpy.data.armatures.new("Hero"))
    scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    assert bpy.ops.ski.use_armature() == {"FINISHED"}
    assert armature.ski.is_skier and armature.ski.is_own
    assert armature.parent is None and armature.ski.start is not None
    assert not bpy.ops.ski.use_armature.poll()


def test_what_is_no_armature_cannot_be_a_skier(core, scene, skiers) -> None:
    import bpy

    mesh = bpy.data.objects.new("Cube", bpy.data.meshes.new("Cube"))
    scene.collection.objects.link(mesh)
    with pytest.raises(core("errors").SpecError, match='Cube = "MESH" is not an ARMATURE'):
        skiers.adopt_armature(mesh, scene)
    bpy.context.view_layer.objects.active = mesh
    assert not bpy.ops.ski.use_armature.poll()


def test_settings_come_with_an_appended_skier(core, scene, skiers, tmp_path) -> None:
    import bpy

    skier = skiers.add_skier(scene, preset="short_turns")
    skier.ski.course.turn_radius = 11.5
    path = tmp_path / "skiers.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    with bpy.data.libraries.load(str(path)) as (source, target):
        target.objects = [skier_name for skier_name in source.objects if skier_name == "Skier"]
    appended = target.objects[0]
    bpy.context.scene.collection.objects.link(appended)
    assert core("blender.shown").skiers(bpy.context.scene) == [appended]
    assert core("blender.properties").read_spec(appended.ski).course.turn_radius == 11.5


def test_each_step_can_be_undone(core, scene) -> None:
    import bpy

    bpy.ops.ed.undo_push(message="Start")
    bpy.ops.ski.add_skier(preset="slalom")
    bpy.ops.ed.undo_push(message="Add Skier")
    bpy.ops.ski.apply_preset(kind="snow", preset="icy")
    bpy.ops.ed.undo_push(message="Snow")
    icy = core("blender.properties").read_spec(bpy.context.scene.ski_skier.ski).snow
    bpy.ops.ski.bake(source="PREVIEW")
    bpy.ops.ed.undo_push(message="Bake")
    assert "Slope" in bpy.data.objects
    bpy.ops.ed.undo()
    assert "Slope" not in bpy.data.objects
    assert core("blender.properties").read_spec(bpy.context.scene.ski_skier.ski).snow == icy
    bpy.ops.ed.undo()
    assert core("blender.properties").read_spec(bpy.context.scene.ski_skier.ski).snow != icy
    bpy.ops.ed.undo()
    assert not [obj for obj in bpy.data.objects if obj.type == "ARMATURE"]


def test_another_kind_of_figure_takes_the_place_of_the_first(core, scene, skiers) -> None:
    import bpy

    skier = skiers.add_skier(scene)
    helmet = bpy.data.objects.new("My camera", None)
    scene.collection.objects.link(helmet)
    helmet.parent = skier
    bpy.ops.ski.apply_preset(kind="runs", preset="snowboard_carving")
    assert "board" in skier.data.bones and "ski.L" not in skier.data.bones
    assert helmet.parent == skier
    assert bpy.ops.ski.bake(source="PREVIEW") == {"FINISHED"}
    bpy.ops.ski.apply_preset(kind="runs", preset="slalom")
    assert "ski.L" in skier.data.bones
    assert all(bone.custom_shape for bone in skier.pose.bones if bone.name.startswith("ski"))
