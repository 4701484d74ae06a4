"""A part of the run is baked: keys, numbers, strips, gear, spray and gates lie in it, and a later bake replaces it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.blender.blender_tools import curves, keys


@pytest.fixture
def ski(core, scene):
    """The settings of a short run whose preview can be baked: 24 frames a second from frame 11 on."""
    settings = core("blender.skiers").add_skier(scene, preset="beginner_turns").ski
    settings.course.turn_count, settings.bake.frame_start = 1, 11
    return settings


def spans(action: Any) -> set[tuple[float, float]]:
    """First and last frame of every curve of an action."""
    found = [keys(curve)[[0, -1], 0] for curve in curves(action).values()]
    return {(float(first), float(last)) for first, last in found}


def test_seconds_of_the_preview_are_baked_where_the_whole_run_has_them(ski, scene) -> None:
    import bpy

    bpy.ops.ski.bake(source="PREVIEW")
    action = ski.id_data.animation_data.action
    whole = {key: keys(curve) for key, curve in curves(action).items()}
    assert bpy.ops.ski.bake(source="PREVIEW", part="SECONDS", begin=1.0, end=2.0) == {"FINISHED"}
    assert ski.id_data.animation_data.action == action and len(bpy.data.actions) == 1
    assert spans(action) == {(35.0, 59.0)}
    assert (scene.frame_start, scene.frame_end) == (action.frame_start, action.frame_end) == (35, 59)
    for key, curve in curves(action).items():
        among = whole[key][24:49]
        sign = -1.0 if "quaternion" in key[0] and among[0, 1] * keys(curve)[0, 1] < 0.0 else 1.0
        np.testing.assert_allclose(keys(curve)[:, 1], sign * among[:, 1], atol=1e-5, err_msg=str(key))
    bpy.ops.ski.bake(source="PREVIEW")
    assert spans(action) == {(11.0, float(next(iter(whole.values()))[-1, 0]))}


def test_the_tab_s_frames_are_baked_unless_a_script_says(ski, scene) -> None:
    import bpy

    ski.part, ski.part_first, ski.part_last = "FRAMES", 20, 30
    bpy.ops.ski.bake(source="PREVIEW")
    action = ski.id_data.animation_data.action
    assert spans(action) == {(20.0, 30.0)}
    assert ski.bake_text.startswith("Baked frames 20 to 30")
    bpy.ops.ski.bake(source="PREVIEW", part="WHOLE")
    assert scene.frame_start == 11 and scene.frame_end > 100


def test_a_part_of_a_simulation_with_its_spray_as_a_strip(core, ski, scene) -> None:
    import bpy

    ski.course.turn_duration, ski.course.transition_duration, ski.course.start_speed = 0.8, 0.6, 5.0
    ski.spray, ski.as_strip = True, True
    bpy.ops.ski.simulate()
    ski.part, ski.part_begin, ski.part_end = "SECONDS", 0.5, 1.0
    bpy.ops.ski.bake()
    data = ski.id_data.animation_data
    (strip,) = [strip for track in data.nla_tracks for strip in track.strips]
    assert (strip.frame_start, strip.frame_end) == (23.0, 35.0)
    assert spans(strip.action) == {(23.0, 35.0)}
    spray = next(obj for obj in scene.objects if "strength" in obj)
    assert spans(spray.animation_data.action) == {(23.0, 35.0)}
    ski.part = "WHOLE"
    bpy.ops.ski.bake()
    (strip,) = [strip for track in data.nla_tracks for strip in track.strips]
    assert strip.frame_start == 11.0 and strip.frame_end > 35.0


@pytest.mark.parametrize(
    ("begin", "end", "words"),
    [(3.0, 2.0, "ends before it begins"), (900.0, 901.0, "is not in the run"), (1.0, 1.001, "fewer than two frames")],
)
def test_a_part_that_cannot_be_changes_nothing(ski, begin: float, end: float, words: str) -> None:
    import bpy

    bpy.ops.ski.bake(source="PREVIEW")
    action = ski.id_data.animation_data.action
    before = spans(action)
    with pytest.raises(RuntimeError, match=f"the part to bake = .*{words}"):
        bpy.ops.ski.bake(source="PREVIEW", part="SECONDS", begin=begin, end=end)
    assert ski.id_data.animation_data.action == action and spans(action) == before


def test_numbers_have_fewer_keys_within_a_share_of_their_range(ski) -> None:
    import bpy

    bpy.ops.ski.bake(source="PREVIEW")
    action = ski.id_data.animation_data.action
    before = {path: keys(curve) for (path, _), curve in curves(action).items() if path.startswith('["')}
    bones = {key: len(keys(curve)) for key, curve in curves(action).items() if not key[0].startswith('["')}
    ski.tolerance_percent = 2.0
    bpy.ops.ski.bake(source="PREVIEW")
    left = 0
    for (path, index), curve in curves(action).items():
        if (path, index) in bones:
            assert len(keys(curve)) == bones[path, index], "poses have tolerances of their own"
            continue
        now, true = keys(curve), before[path]
        error = np.abs(np.interp(true[:, 0], now[:, 0], now[:, 1]) - true[:, 1]).max()
        assert error <= 0.02 * np.ptp(true[:, 1]) + 1e-4, path
        left += len(now)
    assert left < 0.5 * sum(map(len, before.values()))


def swinging(core, count: int = 2) -> list[Any]:
    """Swings of gates, the first one knocked over between 2 and 3 s."""
    time = np.arange(2.0, 3.0, 0.005)
    swing = core("animation.gate_motion").GateSwing(
        time, 0.8 * np.sin(np.pi * (time - 2.0)), 0.0 * time, np.array([0.8, 0.6])
    )
    return [swing, *[None] * (count - 1)]


@pytest.fixture
def gates(core, ski) -> list[list[Any]]:
    """Two gates of giant slalom that stand in the scene, each with an outer pole and a panel."""
    import bpy

    bpy.ops.ski.set_gates(discipline="giant_slalom", count=2)
    spec = core("blender.properties").read_spec(ski)
    return core("blender.course_objects").gate_objects(ski, spec)


def test_gates_swing_within_the_part_only_and_stale_keys_go(core, ski, gates) -> None:
    import bpy

    tools, fewer, span = core("blender.gates"), core("blender.fewer_keys"), core("animation.span")
    tools.bake_gates(gates, swinging(core), 24.0, 1)
    assert spans(gates[0][0].animation_data.action) == {(49.0, 73.0)}
    options = fewer.KeyOptions(span=span.FrameSpan(60, 65))
    tools.bake_gates(gates, swinging(core), 24.0, 1, keys=options)
    assert spans(gates[0][0].animation_data.action) == {(60.0, 65.0)}
    assert len(bpy.data.actions) == 2, (
        "the gate's and its outer pole's: what an earlier bake made is gone, not kept beside it"
    )
    tools.bake_gates(gates, [None, None], 24.0, 1)
    assert len(bpy.data.actions) == 0
    assert all(tuple(obj.rotation_quaternion) == (1.0, 0.0, 0.0, 0.0) for objects in gates for obj in objects)


def test_a_gate_s_own_action_is_left_alone(core, ski, gates) -> None:
    import bpy

    mine = bpy.data.actions.new("Mine")
    gates[1][0].animation_data_create().action = mine
    core("blender.gates").bake_gates(gates, swinging(core), 24.0, 1)
    assert gates[1][0].animation_data.action == mine


def test_a_standing_gate_tilts_as_one(core, ski, gates, scene) -> None:
    """Outer pole and panel hang on the turning pole: they must not be tilted a second time."""
    import bpy

    core("blender.gates").bake_gates(gates, swinging(core), 24.0, 1)
    scene.frame_set(61)  # half a second after the touch: tilted by 0.8
    bpy.context.view_layer.update()
    for obj in gates[0]:
        up = np.array(obj.matrix_world)[:3, 2]
        assert np.arccos(up[2]) == pytest.approx(0.8, abs=0.01), obj.name
    outer = gates[0][1]
    now = np.array(outer.matrix_world.translation)
    scene.frame_set(1)
    np.testing.assert_allclose(now, outer.matrix_world.translation, atol=1e-4, err_msg="its foot stays in the snow")
