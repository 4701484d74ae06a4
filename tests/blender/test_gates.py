"""Gates stand on the snow, where the course has them, plumb, by name and colour."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.blender.blender_tools import make_recording


def gate_spec(core: Any, **changes: Any) -> Any:
    keys = {"course.kind": "gates", "course.gate_count": 5, "slope.angle_deg": 15.0}
    return core("spec").RunSpec().with_overrides({**keys, **changes})


def built(core: Any, scene: Any, spec: Any) -> tuple[dict[str, Any], Any, Any]:
    terrain = core("terrain").build_terrain(spec.slope)
    objects = core("blender.gates").build_gates(spec, terrain, scene.collection)
    scene.view_layers[0].update()
    return {obj.name: obj for parts in objects for obj in parts}, core("course").course_gates(spec, terrain), terrain


def world_vertices(obj: Any) -> np.ndarray:
    return np.array([obj.matrix_world @ vertex.co for vertex in obj.data.vertices])


def test_slalom_gates_are_single_poles_by_number(core, scene) -> None:
    objects, _, _ = built(core, scene, gate_spec(core))
    assert list(objects) == [f"Gate {number}" for number in range(1, 6)]
    colours = [[material.name for material in obj.data.materials][-1] for obj in objects.values()]
    assert colours == ["Ski gate red", "Ski gate blue"] * 2 + ["Ski gate red"]
    assert len({obj.data.name for obj in objects.values()}) == 2  # meshes are shared


@pytest.mark.parametrize("ground", [{}, {"slope.kind": "grid", "slope.grid_file": "rolling_hill"}])
def test_poles_stand_on_the_snow_where_the_course_has_them(core, scene, ground) -> None:
    objects, gates, terrain = built(core, scene, gate_spec(core, **ground))
    for index, foot in enumerate(gates.position):
        vertices = world_vertices(objects[f"Gate {index + 1}"])
        np.testing.assert_allclose(vertices[:, :2].mean(axis=0), foot[:2], atol=1e-3)
        height = vertices[:, 2] - float(terrain.height(foot[0], foot[1]))
        assert height.max() == pytest.approx(1.8, abs=0.01)
        assert height.min() < -0.1  # no gap where the snow falls away


def test_poles_are_plumb_and_thin(core, scene) -> None:
    objects, _, _ = built(core, scene, gate_spec(core))
    for obj in objects.values():
        width = np.ptp(world_vertices(obj)[:, :2], axis=0)
        assert np.all((width > 0.03) & (width < 0.033))


def test_giant_slalom_gates_have_a_panel_on_the_far_side(core, scene) -> None:
    spec = gate_spec(core, **{"course.gate_setting": "giant_slalom"})
    objects, gates, terrain = built(core, scene, spec)
    assert len(objects) == 15
    for index, (foot, side) in enumerate(zip(gates.position, gates.side.tolist(), strict=True)):
        outer = np.array(objects[f"Gate {index + 1} outer"].location)
        assert (outer[1] - foot[1]) * side == pytest.approx(0.75, abs=1e-5)
        assert outer[2] == pytest.approx(float(terrain.height(outer[0], outer[1])), abs=1e-4)
        panel = world_vertices(objects[f"Gate {index + 1} panel"])
        assert panel[:, 1].mean() == pytest.approx(0.5 * (foot[1] + outer[1]), abs=1e-3)
        assert 1.0 < panel[:, 2].min() - foot[2] < panel[:, 2].max() - foot[2] < 1.8


def test_other_courses_have_no_gates(core, scene) -> None:
    spec = core("spec").RunSpec()
    assert core("blender.gates").build_gates(spec, core("terrain").build_terrain(spec.slope), scene.collection) == []
    assert len(scene.collection.objects) == 0


def test_gates_are_renewed_by_a_bake_and_what_is_mine_stays(core, scene) -> None:
    import bpy

    update = core("blender.ground").update_ground
    recording = make_recording(core, duration=1.0, **{"course.kind": "gates", "course.gate_count": 4})
    spec = core("blender.bake").recorded_run(recording)
    ground = update(recording, spec, scene, None)
    (gates,) = ground.children
    mine = bpy.data.objects.new("Flag", None)
    gates.objects.link(mine)
    counts = len(bpy.data.meshes), len(bpy.data.objects)
    update(recording, spec, scene, ground)
    assert list(ground.children) == [gates]
    assert sorted(obj.name for obj in gates.objects) == ["Flag", *(f"Gate {number}" for number in range(1, 5))]
    assert (len(bpy.data.meshes), len(bpy.data.objects)) == counts


def test_gates_are_keyed_while_they_swing_and_plumb_else(core, scene) -> None:
    import bpy

    tools, motion = core("blender.gates"), core("animation.gate_motion")
    spec = gate_spec(core, **{"course.gate_setting": "giant_slalom", "course.gate_count": 2})
    gates = tools.build_gates(spec, core("terrain").build_terrain(spec.slope), scene.collection)
    time = np.linspace(2.0, 3.0, 101)
    swing = motion.GateSwing(time, 0.8 * np.sin(np.pi * (time - 2.0)), 0.0 * time, np.array([0.6, 0.8]))
    tools.bake_gates(gates, [swing, None], 24.0, 5)
    assert [len([obj for obj in objects if obj.animation_data]) for objects in gates] == [3, 0]
    assert len(bpy.data.actions) == 1  # pole, outer pole and panel move as one
    for frame, tilt in ((1, 0.0), (5 + 60, 0.8), (200, 0.0)):
        scene.frame_set(frame)
        for obj in gates[0]:
            up = np.array(obj.matrix_world)[:3, 2]
            np.testing.assert_allclose(up, [0.6 * np.sin(tilt), 0.8 * np.sin(tilt), np.cos(tilt)], atol=2e-3)


def test_a_strobe_picture_s_gates_lie_clear_of_every_skier(core, scene) -> None:
    tools, motion = core("blender.gates"), core("animation.gate_motion")
    spec = gate_spec(core, **{"course.gate_count": 2})
    gates = tools.build_gates(spec, core("terrain").build_terrain(spec.slope), scene.collection)
    time = np.linspace(0.0, 4.0, 101)
    swing = motion.GateSwing(time, 0.3 * time, 0.2 * time, np.array([1.0, 0.0]))
    tools.pose_gates(gates, [None, swing], np.array([0.5, 3.0, 1.0]))
    scene.view_layers[0].update()
    tilts = [float(np.arccos(obj.matrix_world[2][2])) for (obj,) in gates]
    np.testing.assert_allclose(tilts, [0.0, 0.6], atol=1e-3)


def run_into_a_gate(core: Any) -> tuple[Any, Any]:
    """A recording, and the run document of a course whose first gate stands in the skier's way and second far off."""
    recording = make_recording(core, duration=3.0, **{"course.kind": "gates", "course.gate_setting": "list"})
    text = core("blender.bake").recorded_run(recording).to_toml()
    rows = "[[gate]]\nx = 9.0\ny = 1.8\n[[gate]]\nx = 20.0\ny = -6.0\n"
    return recording, core("spec").RunSpec.from_text(text + rows, "gates")


def test_a_bake_s_gates_give_way_where_the_skier_leans_into_them(core, scene) -> None:
    import bpy

    update, channels = core("blender.ground").update_ground, core("blender.channels")
    recording, spec = run_into_a_gate(core)
    ground = update(recording, spec, scene, None)
    assert [obj.name for obj in ground.all_objects if obj.animation_data] == ["Gate 1"]
    update(recording, spec, scene, ground)
    assert len([action for action in bpy.data.actions if action.get(channels.MARK)]) == 1


def test_a_baked_file_s_gates_swing_when_the_skier_passes(core, scene, tmp_path) -> None:
    import bpy

    recording, spec = run_into_a_gate(core)
    core("blender.headless").bake_file(recording, spec.with_overrides({"bake.frame_start": 101}), tmp_path / "a.blend")
    now, tilts = bpy.context.scene, []
    for frame in range(101, 174):  # 3 s at 24 frames a second
        now.frame_set(frame)
        tilts.append(np.degrees(np.arccos(min(bpy.data.objects["Gate 1"].matrix_world[2][2], 1.0))))
    assert max(tilts) > 45.0
    assert abs(int(np.argmax(tilts)) - 24 * 9.0 * np.cos(np.radians(10.0)) / 6.0) < 6.0
    assert tilts[0] < 0.1


def test_a_stage_has_its_gates(core, scene) -> None:
    recording = make_recording(core, duration=1.0, **{"course.kind": "gates", "course.gate_count": 3})
    core("blender.stage").build_stage(recording, core("blender.bake").recorded_run(recording), scene)
    assert [obj.name for obj in scene.collection.children["Gates"].objects] == ["Gate 1", "Gate 2", "Gate 3"]
