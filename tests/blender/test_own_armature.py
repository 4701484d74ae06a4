"""One's own character by the buttons: Use My Armature, Find Bones, Simulate, Bake."""

from __future__ import annotations

import numpy as np
import pytest

from tests.blender.blender_tools import curves


@pytest.fixture
def hero(core, scene):
    """A Rigify metarig as the skier of a short run."""
    import addon_utils
    import bpy

    addon_utils.enable("rigify", default_set=True)
    bpy.ops.object.armature_human_metarig_add()
    armature = bpy.context.object
    assert bpy.ops.ski.use_armature() == {"FINISHED"}
    properties = core("blender.properties")
    short = {"course.turn_count": 1, "course.turn_duration": 0.4, "course.transition_duration": 0.5}
    properties.write_spec(armature.ski, properties.preset_specs()["paper_main"].with_overrides(short))
    yield armature
    addon_utils.disable("rigify", default_set=True)


def test_the_bones_are_found_and_listed(hero) -> None:
    import bpy

    assert bpy.ops.ski.find_bones() == {"FINISHED"}
    rows = {row.wanted: (row.body, row.bone) for row in hero.ski.bones}
    assert rows["thigh.L"] == ("thigh.L", "thigh.L")
    assert all(bone for _, bone in rows.values())


def test_the_run_is_baked_on_it(core, hero, scene) -> None:
    import bpy

    bpy.ops.ski.find_bones()
    bpy.ops.ski.simulate()
    assert bpy.ops.ski.bake() == {"FINISHED"}
    action = hero.animation_data.action
    assert any('pose.bones["thigh.L"]' in path for path, _ in curves(action))
    hips = []
    for frame in (scene.frame_start, scene.frame_end):
        scene.frame_set(frame)
        evaluated = hero.evaluated_get(bpy.context.evaluated_depsgraph_get())
        hips.append(np.array(evaluated.matrix_world @ evaluated.pose.bones["spine"].head))
    assert np.linalg.norm(hips[1] - hips[0]) > 3.0
    before = action
    bpy.ops.ski.bake()
    assert hero.animation_data.action == before


def test_the_run_goes_where_the_start_is(core, hero, scene) -> None:
    import bpy

    hero.ski.start.location = (50.0, 10.0, 3.0)
    bpy.ops.ski.simulate()
    bpy.ops.ski.bake()
    scene.frame_set(scene.frame_start)
    evaluated = hero.evaluated_get(bpy.context.evaluated_depsgraph_get())
    place = evaluated.matrix_world @ evaluated.pose.bones["spine"].head
    assert abs(place.x - 50.0) < 1.0 and abs(place.y - 10.0) < 1.0 and 3.0 < place.z < 5.0


def test_a_bone_can_be_left_out_and_a_wrong_one_is_named(hero) -> None:
    import bpy

    bpy.ops.ski.find_bones()
    bpy.ops.ski.simulate()
    rows = {row.wanted: row for row in hero.ski.bones}
    rows["hand.L"].bone = ""
    bpy.ops.ski.bake()
    assert not any('pose.bones["hand.L"]' in path for path, _ in curves(hero.animation_data.action))
    rows["hand.L"].bone = "claw"
    with pytest.raises(RuntimeError, match=r"bones\.hand\.L = .claw. is not a bone of the armature"):
        bpy.ops.ski.bake()


def test_the_table_is_kept_as_a_map(core, hero, tmp_path, monkeypatch) -> None:
    import bpy

    maps = core("blender.armature_maps")
    monkeypatch.setattr(maps, "user_map_folder", lambda: tmp_path)
    bpy.ops.ski.find_bones()
    whole = core("blender.bone_tables").own_map(hero)
    assert bpy.ops.ski.save_bone_map(name="My hero") == {"FINISHED"}
    again = core("animation.bone_map").BoneMap.load(tmp_path / "my_hero.toml")
    assert (again.entries, again.root, again.settings) == (whole.entries, whole.root, whole.settings)


def test_the_preview_is_not_for_it(hero) -> None:
    import bpy

    with pytest.raises(RuntimeError, match="cannot be baked on an armature of your own: simulate"):
        bpy.ops.ski.bake(source="PREVIEW")


def test_an_armature_that_fits_no_map_is_named(core, scene) -> None:
    import bpy

    armature = bpy.data.objects.new("Snake", bpy.data.armatures.new("Snake"))
    scene.collection.objects.link(armature)
    bpy.context.view_layer.objects.active = armature
    bpy.ops.ski.use_armature()
    with pytest.raises(RuntimeError, match="Snake"):
        bpy.ops.ski.find_bones()
    assert not len(armature.ski.bones)
