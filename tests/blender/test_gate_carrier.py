"""Gates go with the start object of the run, as slope, track and skier do, and stay where the slope is taken anew."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.blender.blender_tools import curves, keys
from tests.blender.test_slope_taking import hill


def poles(ski) -> list:
    """The poles of the gates that stand for a skier, by number."""
    import bpy

    bpy.context.view_layer.update()
    return sorted((obj for obj in ski.gates.all_objects if obj.ski_gate.is_gate), key=lambda pole: pole.name)


def places(ski) -> np.ndarray:
    """Where the gates stand (n, 3) [m, world]."""
    return np.array([pole.matrix_world.translation for pole in poles(ski)])


def ups(ski) -> np.ndarray:
    """Which way the poles point (n, 3) in the world."""
    return np.array([np.array(pole.matrix_world)[:3, 2] for pole in poles(ski)])


def move_start(ski) -> None:
    """Move the run and turn it about the vertical."""
    import bpy

    ski.start.location = (3.0, 40.0, 5.0)
    ski.start.rotation_euler.z += 0.7
    bpy.context.view_layer.update()


@pytest.fixture
def read(core):
    """A function that returns the run document of a skier's settings."""
    return core("blender.properties").read_spec


@pytest.fixture(params=["slalom", "giant_slalom"])
def course(request, ski):
    """Four gates of a discipline."""
    import bpy

    bpy.ops.ski.set_gates(discipline=request.param, count=4)
    bpy.context.view_layer.update()
    return ski


def test_gates_go_with_a_moved_start(core, course, read) -> None:
    before, stood = read(course).gate, places(course)
    move_start(course)
    assert read(course).gate == before
    moved = core("blender.placing").moved(core("blender.placing").world_from_run(course), stood)
    np.testing.assert_allclose(places(course), moved, atol=1e-4)
    np.testing.assert_allclose(ups(course), np.tile((0.0, 0.0, 1.0), (4, 1)), atol=1e-6)
    assert core("blender.live").preview_of(course).off_snow == ()


def test_a_gate_set_after_the_move_stands_where_it_was_clicked(course, read) -> None:
    import bpy

    move_start(course)
    place = course.start.matrix_world @ poles(course)[-1].parent.matrix_basis @ poles(course)[-1].location
    place.x += 4.0
    bpy.ops.ski.add_gate(location=place)
    assert len(read(course).gate) == 5
    assert np.linalg.norm(places(course)[:, :2] - np.array(place)[:2], axis=1).min() < 1e-3
    np.testing.assert_allclose(ups(course), np.tile((0.0, 0.0, 1.0), (5, 1)), atol=1e-6)


def test_one_undo_takes_the_whole_move_back(scene, read) -> None:
    import bpy

    bpy.ops.ski.add_skier()
    bpy.ops.ski.set_gates(discipline="slalom", count=4)
    bpy.ops.ed.undo_push(message="Set Course")
    stood = places(bpy.context.scene.ski_skier.ski)
    move_start(bpy.context.scene.ski_skier.ski)
    bpy.ops.ed.undo_push(message="Move")
    bpy.ops.ed.undo()
    np.testing.assert_allclose(places(bpy.context.scene.ski_skier.ski), stood, atol=1e-6)


def test_the_carrier_is_one_hidden_object(course) -> None:
    """Blender draws a line to a parent that is seen, and hundreds of gates would be hundreds of lines."""
    import bpy

    bpy.ops.ski.set_gates(discipline="slalom", count=6)
    parents = {pole.parent for pole in poles(course)}
    assert len(parents) == 1
    (carrier,) = parents
    assert carrier.hide_viewport and carrier.hide_select and carrier.parent == course.start
    assert len([obj for obj in course.gates.all_objects if obj.type == "EMPTY"]) == 1


def test_duplicated_gates_go_too_and_those_without_a_parent_stay(course, read) -> None:
    import bpy

    copy, free = poles(course)[2].copy(), poles(course)[1]
    course.gates.objects.link(copy)
    copy.location.x += 5.0
    matrix, free.parent = free.matrix_world.copy(), None
    free.matrix_world = matrix
    bpy.context.view_layer.update()
    before, stood = copy.matrix_world.translation.copy(), free.matrix_world.translation.copy()
    move_start(course)
    assert (copy.matrix_world.translation - before).length > 10.0
    assert (free.matrix_world.translation - stood).length < 1e-6


@pytest.mark.parametrize("standing", [True, False])
def test_baked_gates_swing_and_go_with_the_start(core, scene, ski, standing: bool) -> None:
    """The gates that a bake builds, and those that stand in the scene, tilt in the run's own axes."""
    import bpy

    bpy.ops.ski.apply_preset(kind="runs", preset="slalom")
    if standing:
        bpy.ops.ski.set_gates(discipline="slalom", count=4)
    ski.course.gate_count = 4
    move_start(ski)
    bpy.ops.ski.bake(source="PREVIEW")
    pole = next(obj for obj in bpy.data.objects if obj.name.startswith("Gate ") and obj.animation_data)
    curve = next(curve for (path, _), curve in curves(pole.animation_data.action).items() if "rotation" in path)
    scene.frame_set(round(float(np.median(keys(curve)[:, 0]))))
    tilted, facing = pole.matrix_world.copy(), ski.start.matrix_world.to_euler().z
    assert tilted.col[2].z < 0.9999, "it is tilted at that moment"
    ski.start.rotation_euler.z = facing + math.radians(50.0)
    ski.start.location.x += 10.0
    bpy.context.view_layer.update()
    turned = np.array(ski.start.matrix_world) @ np.linalg.inv(_turn_about(facing, (3.0, 40.0, 5.0)))
    np.testing.assert_allclose(np.array(pole.matrix_world), turned @ np.array(tilted), atol=1e-4)


def _turn_about(angle: float, place: tuple[float, float, float]) -> np.ndarray:
    """The matrix (4, 4) of a turn about the vertical at a place."""
    matrix = np.eye(4)
    matrix[:2, :2] = (math.cos(angle), -math.sin(angle)), (math.sin(angle), math.cos(angle))
    matrix[:3, 3] = place
    return matrix


def test_gates_stay_where_the_slope_is_taken_from_a_mesh(core, ski, scene, read) -> None:
    """They were set on the mesh: taking it anew, after it was changed, moves the start only."""
    import bpy

    obj = hill(scene)
    ski.slope_mesh = obj
    bpy.ops.ski.sample_slope()
    for x in (30.0, 45.0, 60.0):
        bpy.ops.ski.add_gate(location=(x, 2.0 if x == 45.0 else -2.0, 0.0))
    stood = places(ski)
    ski.start.location.x += 7.0  # the run goes with its start
    bpy.context.view_layer.update()
    np.testing.assert_allclose(places(ski), stood + (7.0, 0.0, 0.0), atol=1e-4)
    stood = places(ski)
    bpy.ops.ski.sample_slope()  # the start is put at the upper end again
    np.testing.assert_allclose(places(ski), stood, atol=1e-4)
    bpy.ops.ski.add_gate(location=(75.0, 2.0, 0.0))
    assert abs(places(ski)[3, 0] - 75.0) < 1e-3
    assert len(read(ski).gate) == 4
