"""A mesh of the scene as the slope, by the button."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest


def hill(scene, size=(120.0, 60.0), fall=0.2, bump=0.6):
    import bpy

    nx, ny = 61, 31
    x, y = np.meshgrid(np.linspace(0, size[0], nx), np.linspace(-size[1] / 2, size[1] / 2, ny), indexing="ij")
    z = -fall * x + bump * np.sin(x / 12.0) * np.cos(y / 15.0)
    faces = [
        (i * ny + j, (i + 1) * ny + j, (i + 1) * ny + j + 1, i * ny + j + 1)
        for i in range(nx - 1)
        for j in range(ny - 1)
    ]
    mesh = bpy.data.meshes.new("Hill")
    mesh.from_pydata(np.stack((x, y, z), axis=-1).reshape(-1, 3).tolist(), [], faces)
    obj = bpy.data.objects.new("Hill", mesh)
    scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    return obj


def height_on(obj, x: float, y: float) -> float:
    """The height of a mesh object, turned about the vertical only, under a place of the world."""
    inverse = obj.matrix_world.inverted()
    local = inverse @ mathutils().Vector((x, y, 0.0))
    hit, where, *_ = obj.ray_cast((local.x, local.y, 500.0), (0.0, 0.0, -1.0))
    assert hit, (x, y)
    return (obj.matrix_world @ where).z


def mathutils():
    return pytest.importorskip("mathutils")


@pytest.fixture
def on_hill(core, ski, scene):
    obj = hill(scene)
    ski.course.turn_count = 3
    obj.location, obj.rotation_euler.z = (200.0, -80.0, 30.0), math.radians(110.0)
    ski.slope_mesh = obj
    return obj


def test_the_run_lies_on_the_mesh(core, ski, scene, on_hill) -> None:
    import bpy

    assert bpy.ops.ski.sample_slope() == {"FINISHED"}
    assert "samples" in ski.slope_said
    spec = core("blender.properties").read_spec(ski)
    assert spec.slope.kind == "grid" and Path(spec.slope.grid_file).is_file()
    shown = core("blender.live").preview_of(ski)
    assert not shown.problem, shown.problem
    for place in shown.line[:: len(shown.line) // 20]:
        assert abs(height_on(on_hill, *place[:2]) - place[2]) < 0.08
    assert shown.line[0, 2] - shown.line[-1, 2] > 8.0  # downhill


def test_the_skier_is_baked_onto_the_mesh(core, ski, scene, on_hill) -> None:
    import bpy

    bpy.ops.ski.sample_slope()
    bpy.ops.ski.bake(source="PREVIEW")
    skier, depsgraph = ski.id_data, bpy.context.evaluated_depsgraph_get()
    for frame in (1, 60, 120):
        scene.frame_set(frame)
        evaluated = skier.evaluated_get(depsgraph)
        place = evaluated.matrix_world @ evaluated.pose.bones["ski.L"].head
        assert abs(height_on(on_hill, place.x, place.y) - place.z) < 0.6, frame
    assert "Slope" not in ski.ground.objects  # the mesh is the slope


def test_taking_again_after_a_change_renews_it(core, ski, on_hill) -> None:
    import bpy

    bpy.ops.ski.sample_slope()
    before = core("blender.live").preview_of(ski)
    for vertex in on_hill.data.vertices:
        vertex.co.z += 0.01 * vertex.co.x
    on_hill.data.update()
    bpy.context.view_layer.update()
    bpy.ops.ski.sample_slope()
    after = core("blender.live").preview_of(ski, before)
    assert after is not before


def test_a_mesh_must_be_chosen(ski) -> None:
    import bpy

    with pytest.raises(RuntimeError, match="choose a mesh"):
        bpy.ops.ski.sample_slope()


def test_what_is_no_slope_is_refused_and_nothing_is_changed(core, ski, scene) -> None:
    import bpy

    before = core("blender.properties").read_spec(ski)
    ski.slope_mesh = bpy.data.objects.new("Nothing", bpy.data.meshes.new("Nothing"))
    scene.collection.objects.link(ski.slope_mesh)
    with pytest.raises(RuntimeError, match="Nothing"):
        bpy.ops.ski.sample_slope()
    assert core("blender.properties").read_spec(ski) == before


def test_a_track_that_leaves_the_mesh_is_named(core, ski, scene) -> None:
    import bpy

    ski.slope_mesh = hill(scene, size=(60.0, 30.0))
    bpy.ops.ski.sample_slope()
    ski.course.turn_count, ski.course.target_speed_word, ski.course.target_speed = 30, False, 9.0
    with pytest.raises(RuntimeError):
        bpy.ops.ski.plan()
    assert ski.plan_failed and "ends" in ski.plan_text and "Hill" in ski.plan_text
