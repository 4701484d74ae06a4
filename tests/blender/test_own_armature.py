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


def world_of(armature, bone: str) -> np.ndarray:
    """Where the head of a bone is in the world at the current frame."""
    import bpy

    evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return np.array(evaluated.matrix_world @ evaluated.pose.bones[bone].head)


def test_the_preview_is_baked_on_it_as_a_simulation_is(core, hero, scene) -> None:
    """Hips go where the instant figure's do, and the skis under the feet are on its skis."""
    import bpy

    hero.ski.start.location = (5.0, 3.0, 1.0)
    bpy.ops.ski.find_bones()
    assert bpy.ops.ski.bake(source="PREVIEW") == {"FINISHED"}
    action = hero.animation_data.action
    assert any('pose.bones["thigh.L"]' in path for path, _ in curves(action))
    assert {path for path, _ in curves(action) if path.startswith('["')} >= {'["speed"]', '["inclination"]'}
    assert len([obj for obj in hero.children if "ski_addon_gear" in obj]) == 4
    spec = core("blender.properties").read_spec(hero.ski)
    figures, preview = core("turning.figures"), core("turning.preview")
    model = figures.build_figure(spec)
    motion = preview.preview_motion(spec)
    for frame in (scene.frame_start, scene.frame_end):
        scene.frame_set(frame)
        poses = figures.poses.poses_at(model, spec, motion, np.array([(frame - 1) / 24.0]))
        poses = poses.moved(core("blender.placing").world_from_run(hero.ski))
        true = dict(zip(poses.body_names, poses.position[0], strict=True))
        assert np.linalg.norm(world_of(hero, "spine") - true["pelvis"]) < 0.35, "the metarig is larger"
        bpy.context.view_layer.update()
        for side in "LR":
            ski = next(obj for obj in hero.children if obj.get("ski_addon_gear") == f"ski.{side}")
            np.testing.assert_allclose(np.array(ski.matrix_world.translation), true[f"ski.{side}"], atol=0.03)


def test_a_part_of_the_preview_replaces_what_was_baked_before(hero, scene) -> None:
    import bpy

    bpy.ops.ski.find_bones()
    bpy.ops.ski.bake(source="PREVIEW")
    action, count, objects = hero.animation_data.action, len(bpy.data.actions), len(bpy.data.objects)
    assert bpy.ops.ski.bake(source="PREVIEW", part="FRAMES", begin=3, end=6) == {"FINISHED"}
    assert hero.animation_data.action == action
    assert (len(bpy.data.actions), len(bpy.data.objects)) == (count, objects)
    assert (scene.frame_start, scene.frame_end) == (3, 6)
    for obj in [hero, *[obj for obj in hero.children if obj.animation_data and obj.animation_data.action]]:
        for curve in curves(obj.animation_data.action).values():
            frames = [key.co[0] for key in curve.keyframe_points]
            assert set(frames) <= {3.0, 4.0, 5.0, 6.0}, curve.data_path
    bpy.ops.ski.simulate()
    assert bpy.ops.ski.bake(part="SECONDS", begin=0.1, end=0.3) == {"FINISHED"}
    assert hero.animation_data.action == action and len(bpy.data.actions) == count


@pytest.mark.parametrize("kind", ["snowboard", "telemark", "bicycle"])
def test_the_preview_of_another_figure_is_not_for_it(hero, kind: str) -> None:
    import bpy

    bpy.ops.ski.find_bones()
    hero.ski.figure.kind = kind
    with pytest.raises(RuntimeError, match=rf"figure.kind = .{kind}. cannot be laid on an armature of your own"):
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
