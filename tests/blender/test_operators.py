"""The three buttons: they give what the library gives, and say in one line what is wrong."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.blender.blender_tools import curves, keys


@pytest.fixture
def ski(core, scene):
    """The settings of a short run that can be skied."""
    settings = core("blender.skiers").add_skier(scene, preset="paper_main").ski
    settings.course.turn_count = 1
    settings.course.turn_duration = 0.4
    settings.course.transition_duration = 0.5
    return settings


@pytest.fixture
def recording(core, ski):
    """The same run by the library."""
    pipeline = core("pipeline")
    found, _ = pipeline.run_simulation(pipeline.make_plan(core("blender.properties").read_spec(ski)))
    return found


def test_plan_says_what_the_library_plans(core, ski) -> None:
    import bpy

    assert bpy.ops.ski.plan() == {"FINISHED"}
    spec = core("blender.properties").read_spec(ski)
    plan = core("pipeline").make_plan(spec).plan
    assert ski.plan_text.split("\n") == core("blender.words").plan_lines(plan)
    assert ski.plan_hash == spec.content_hash()
    assert not ski.plan_failed


def test_plan_names_where_a_track_cannot_be_skied(ski) -> None:
    import bpy

    ski.course.turn_radius, ski.course.start_speed = 5.0, 15.0
    with pytest.raises(RuntimeError, match="cannot be skied at .* would work"):
        bpy.ops.ski.plan()
    assert ski.plan_failed
    assert "cannot be skied at turn 1" in ski.plan_text
    assert "m/s" in ski.plan_text
    assert "\n" not in ski.plan_text


def test_simulate_gives_the_library_s_recording(core, ski, recording, tmp_path: Path) -> None:
    import bpy

    assert bpy.ops.ski.simulate() == {"FINISHED"}
    found = core("blender.cache").load_recording(ski.recording)
    for name in ("time", "qpos", "tau", "snow_force"):
        np.testing.assert_allclose(getattr(found, name), getattr(recording, name), rtol=1e-6, atol=1e-6)
    assert ski.simulation_text.startswith("Skied to the end")
    assert not ski.simulation_failed


def test_simulate_says_where_a_plan_is_infeasible(ski) -> None:
    import bpy

    ski.course.turn_radius, ski.course.start_speed = 5.0, 15.0
    with pytest.raises(RuntimeError, match="cannot be skied at turn 1"):
        bpy.ops.ski.simulate()
    assert ski.simulation_failed
    assert ski.recording == ""


def test_a_longer_course_goes_on_from_the_recording(core, ski, scene) -> None:
    import bpy

    bpy.ops.ski.simulate()
    load = core("blender.cache").load_recording
    before = load(ski.recording)
    ski.course.turn_count = 2
    scene.frame_set(1 + int(0.7 * before.duration * 24))
    assert bpy.ops.ski.simulate(begin="FRAME") == {"FINISHED"}
    after = load(ski.recording)
    kept = int((scene.frame_current - 1) / 24 / 0.001)
    np.testing.assert_array_equal(after.qpos[:kept], before.qpos[:kept])
    assert after.duration > before.duration + 0.5 and after.status == "finished"


def test_a_moment_after_the_recording_is_refused_and_the_recording_stays(ski, scene) -> None:
    import bpy

    bpy.ops.ski.simulate()
    kept = Path(ski.recording).read_bytes()
    scene.frame_set(900)
    with pytest.raises(RuntimeError, match="resume time = .* is outside"):
        bpy.ops.ski.simulate(begin="FRAME")
    assert Path(ski.recording).read_bytes() == kept


def test_going_on_needs_a_recording(ski) -> None:
    import bpy

    with pytest.raises(RuntimeError, match="press Simulate"):
        bpy.ops.ski.simulate(begin="END")


def test_a_huge_run_is_not_started(ski) -> None:
    import bpy

    ski.course.turn_count, ski.course.turn_duration = 500, 30.0
    with pytest.raises(RuntimeError, match="would take .* shorten the course"):
        bpy.ops.ski.simulate()


def test_the_recording_lies_beside_a_saved_file(ski, tmp_path: Path) -> None:
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "my shot.blend"))
    bpy.ops.ski.simulate()
    assert ski.recording == "//ski_cache/my_shot_Skier.npz"
    assert (tmp_path / "ski_cache" / "my_shot_Skier.npz").is_file()


def test_the_recording_of_an_unsaved_file_lies_in_the_user_s_cache(core, extension, ski) -> None:
    import bpy

    bpy.ops.ski.simulate()
    folder = Path(bpy.utils.extension_path_user(extension, path="cache"))
    assert Path(ski.recording).parent == folder


def test_bake_gives_what_the_library_bakes(core, scene, ski, recording) -> None:
    import bpy

    bpy.ops.ski.simulate()
    assert bpy.ops.ski.bake() == {"FINISHED"}
    by_button = ski.id_data
    spec = core("blender.properties").read_spec(ski)
    by_call = core("blender.bake").bake_recording(recording, scene, options=spec.bake)
    one, other = (curves(armature.animation_data.action) for armature in (by_button, by_call.armature))
    assert one.keys() == other.keys()
    for key in one:
        np.testing.assert_allclose(keys(one[key]), keys(other[key]), rtol=1e-5, atol=1e-5, err_msg=str(key))
    assert ski.bake_text.startswith("Baked frames 1 to")


def test_bake_before_simulate_is_refused(ski) -> None:
    import bpy

    with pytest.raises(RuntimeError, match="press Simulate"):
        bpy.ops.ski.bake()


def test_a_recording_that_went_away_is_named(ski) -> None:
    import bpy

    ski.recording = "//ski_cache/gone.npz"
    with pytest.raises(RuntimeError, match=r"gone\.npz.*press Simulate again"):
        bpy.ops.ski.bake()


def test_a_broken_recording_is_named(ski, tmp_path: Path) -> None:
    import bpy

    path = tmp_path / "broken.npz"
    path.write_bytes(b"PK\x03\x04 not much")
    ski.recording = str(path)
    with pytest.raises(RuntimeError, match=r"cannot read the recording .*broken\.npz"):
        bpy.ops.ski.bake()


def test_baking_again_keeps_one_skier_and_one_slope(ski, scene) -> None:
    import bpy

    bpy.ops.ski.simulate()
    bpy.ops.ski.bake()
    before = set(scene.objects.keys())
    bpy.ops.ski.bake()
    assert set(scene.objects.keys()) == before
    assert {"Slope", "Ski track L", "Ski track R"} <= before
    assert len(bpy.data.actions) == 1


@pytest.mark.parametrize(("tracks", "kinds"), [("mesh", {"MESH"}), ("curve", {"CURVE"}), ("none", set())])
def test_tracks_and_spray_are_as_asked(ski, scene, tracks, kinds) -> None:
    import bpy

    ski.tracks, ski.spray = tracks, True
    bpy.ops.ski.simulate()
    bpy.ops.ski.bake()
    bpy.ops.ski.bake()
    assert {obj.type for obj in scene.objects if obj.name.startswith("Ski track")} == kinds
    (spray,) = [obj for obj in scene.objects if obj.name.startswith("Snow spray")]
    assert spray.parent == ski.start and spray.animation_data.action is not None
    assert "strength" in spray


def test_fewer_keys_and_a_strip(ski) -> None:
    import bpy

    bpy.ops.ski.simulate()
    bpy.ops.ski.bake()
    action = ski.id_data.animation_data.action
    before = sum(len(curve.keyframe_points) for curve in curves(action).values())
    ski.tolerance_deg, ski.tolerance_mm, ski.as_strip = 0.5, 2.0, True
    bpy.ops.ski.bake()
    data = ski.id_data.animation_data
    (strip,) = [strip for track in data.nla_tracks for strip in track.strips]
    assert data.action is None and strip.action == action
    after = sum(len(curve.keyframe_points) for curve in curves(action).values())
    assert after < 0.6 * before
    ski.as_strip = False
    bpy.ops.ski.bake()
    assert ski.id_data.animation_data.action == action and not len(ski.id_data.animation_data.nla_tracks)


def test_another_person_refits_the_same_skier(core, ski, scene) -> None:
    import bpy

    bpy.ops.ski.simulate()
    bpy.ops.ski.bake()
    skier, action = ski.id_data, ski.id_data.animation_data.action
    before = skier.data.bones["head"].head_local.z
    ski.skier.height, ski.skier.mass = 1.8, 80.0
    bpy.ops.ski.simulate()
    bpy.ops.ski.bake()
    assert ski.id_data == skier and skier.animation_data.action == action
    assert skier.data.bones["head"].head_local.z > before + 0.1
    assert len([child for child in skier.children if child.type == "MESH"]) == 5
    assert [obj for obj in scene.objects if obj.type == "ARMATURE"] == [skier]


def test_bake_shows_the_run_that_was_simulated(ski) -> None:
    """What was changed after the simulation is not in the keys, and the sidebar can tell."""
    import bpy

    bpy.ops.ski.simulate()
    ski.course.turn_radius = 25.0
    bpy.ops.ski.bake()
    assert ski.bake_hash == ski.simulation_hash


def test_a_bake_is_old_after_another_simulation(ski) -> None:
    import bpy

    bpy.ops.ski.simulate()
    bpy.ops.ski.bake()
    assert ski.bake_hash == ski.simulation_hash
    bpy.ops.ski.simulate()
    assert ski.bake_hash != ski.simulation_hash


def test_resetting_goes_back_to_the_preset(core, scene, ski) -> None:
    import bpy

    bpy.ops.ski.reset_to_preset()
    properties = core("blender.properties")
    assert properties.read_spec(ski) == properties.preset_specs()["paper_main"]


def test_a_missing_library_is_said_in_one_line(core, ski, monkeypatch) -> None:
    import bpy

    def lost(_spec):
        raise ModuleNotFoundError("No module named 'mujoco'", name="mujoco")

    monkeypatch.setattr(core("pipeline"), "make_plan", lost)
    with pytest.raises(RuntimeError, match="mujoco") as caught:
        bpy.ops.ski.plan()
    assert "Traceback" not in str(caught.value)


def test_an_unexpected_failure_is_one_line_too(core, ski, monkeypatch) -> None:
    import bpy

    def broken(_spec):
        raise ZeroDivisionError("oh\nno")

    monkeypatch.setattr(core("pipeline"), "make_plan", broken)
    with pytest.raises(RuntimeError, match="unexpected ZeroDivisionError: oh no") as caught:
        bpy.ops.ski.plan()
    assert "Traceback" not in str(caught.value)
