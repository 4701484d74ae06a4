"""Meshes of a scene as slopes: with modifiers and any place in the world, met to a centimetre, or refused."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest

from tests.terrain.meshes import hill, sheet

NAME = "Hill"
RNG = np.random.default_rng(21)


@pytest.fixture
def tools(core, scene):
    return core("blender.mesh_slope")


@pytest.fixture
def add(scene):
    """Puts triangles into the scene as an object."""
    import bpy

    def put(triangles=None, name=NAME, **properties):
        mesh = bpy.data.meshes.new(name)
        triangles = sheet(hill, face=2.0) if triangles is None else triangles
        points, corners = np.unique(np.round(triangles.reshape(-1, 3), 6), axis=0, return_inverse=True)
        mesh.from_pydata(points.tolist(), [], corners.reshape(-1, 3).tolist())
        obj = bpy.data.objects.new(name, mesh)
        scene.collection.objects.link(obj)
        for key, value in properties.items():
            setattr(obj, key, value)
        return obj

    return put


def sampled(tools, obj, *arguments, **more):
    import bpy

    return tools.sample_mesh(obj, bpy.context.evaluated_depsgraph_get(), *arguments, **more)


def refused(tools, core, obj, *arguments, **more) -> str:
    with pytest.raises(core("errors").SpecError) as caught:
        sampled(tools, obj, *arguments, **more)
    line = str(caught.value)
    assert "\n" not in line and len(line) < 300
    assert line.startswith(f'object "{obj.name}" ')
    return line.removeprefix(f'object "{obj.name}" ')


def hit(scene, x: float, y: float) -> np.ndarray:
    """Where Blender's own ray from high above meets the scene."""
    import bpy

    found, place, *_ = scene.ray_cast(bpy.context.evaluated_depsgraph_get(), (x, y, 5000.0), (0.0, 0.0, -1.0))
    assert found
    return np.array(place)


def ride_of(core, tools, ground, path):
    """The terrain that a run document has that names the ground's file."""
    changes = ground.slope_keys(tools.write_ground(ground, path))
    return core("terrain").build_terrain(core("spec").RunSpec().with_overrides(changes).slope)


PLACES = {
    "as it is": {},
    "turned and moved": {"rotation_euler": (0.0, 0.0, 2.1), "location": (340.0, -120.0, 55.0)},
    "scaled unevenly": {"scale": (1.5, 0.8, 0.7), "rotation_euler": (0.0, 0.05, -1.0)},
    "mirrored": {"scale": (1.0, -1.0, 1.0), "rotation_euler": (0.03, 0.0, 0.4)},
    "tilted": {"rotation_euler": (0.1, -0.15, 0.0)},
}


@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES.keys())
def test_the_run_s_ground_is_where_rays_meet_the_mesh(core, scene, tools, add, tmp_path, place) -> None:
    obj = add(sheet(hill), **place)
    ground = sampled(tools, obj)
    terrain = ride_of(core, tools, ground, tmp_path / "hill.npz")
    low, size = np.array(ground.origin), np.array(ground.size)
    x, y = (low + RNG.uniform(0.1, 0.9, (60, 2)) * size).T
    x, y = (values[ground.covers(x, y)] for values in (x, y))
    assert len(x) > 30
    for point in ground.to_world(np.stack((x, y, terrain.height(x, y)), axis=-1)):
        np.testing.assert_allclose(point, hit(scene, *point[:2]), atol=0.01)
    np.testing.assert_allclose(ground.start, hit(scene, *ground.start[:2]), atol=1e-3)
    origin = ground.to_world(np.array((0.0, 0.0, float(terrain.height(0.0, 0.0)))))
    np.testing.assert_allclose(origin, ground.start, atol=0.01)
    assert terrain.mean_angle > math.radians(3.0)


def test_a_given_start_is_the_run_s_origin(core, scene, tools, add, tmp_path) -> None:
    ground = sampled(tools, add(sheet(hill), location=(10.0, 20.0, 30.0)), (60.0, 15.0, 0.0), 0.5)
    np.testing.assert_allclose(ground.start, hit(scene, 60.0, 15.0), atol=1e-3)
    np.testing.assert_allclose(ground.world_from_run[:2, 3], (60.0, 15.0), atol=1e-9)
    terrain = ride_of(core, tools, ground, tmp_path / "hill.npz")
    point = ground.to_world(np.array((20.0, -4.0, float(terrain.height(20.0, -4.0)))))
    np.testing.assert_allclose(point, hit(scene, *point[:2]), atol=0.01)


def test_a_heading_turns_the_run(tools, add) -> None:
    ground = sampled(tools, add(), (50.0, 0.0, 0.0), heading=0.3)
    np.testing.assert_allclose(ground.world_from_run[:2, 0], (math.cos(0.3), math.sin(0.3)))


def test_modifiers_count(scene, tools, add) -> None:
    obj = add(sheet(lambda x, y: -0.2 * x))
    wave = obj.modifiers.new("Waves", "DISPLACE")
    wave.strength, wave.mid_level, wave.direction = 3.0, 0.0, "Z"
    ground = sampled(tools, obj)
    assert ground.start[2] == pytest.approx(2.0, abs=0.1)  # 3 m over 5 m down a fall of 20 %
    np.testing.assert_allclose(ground.start, hit(scene, *ground.start[:2]), atol=1e-3)


def test_a_parent_counts(scene, tools, add) -> None:
    import bpy

    parent = bpy.data.objects.new("Parent", None)
    scene.collection.objects.link(parent)
    parent.location = (0.0, 0.0, 250.0)
    ground = sampled(tools, add(parent=parent))
    assert ground.start[2] == pytest.approx(hill(5.0, 0.0) + 250.0, abs=0.5)


def test_the_object_is_left_as_it_was(tools, add) -> None:
    import bpy

    obj = add()
    before = len(bpy.data.meshes), len(obj.data.vertices), tuple(obj.location)
    sampled(tools, obj)
    assert before == (len(bpy.data.meshes), len(obj.data.vertices), tuple(obj.location))


def test_a_mesh_of_62500_samples_takes_less_than_a_second(tools, add) -> None:
    obj = add(sheet(hill, 250.0, 250.0))
    sampled(tools, obj, None, 1.0)
    begin = time.process_time()
    ground = sampled(tools, obj, None, 1.0)
    assert time.process_time() - begin < 1.0
    assert ground.heights.shape == (250, 250)


def test_what_is_no_mesh_is_refused(core, scene, tools) -> None:
    import bpy

    empty = bpy.data.objects.new("Nothing", None)
    scene.collection.objects.link(empty)
    assert refused(tools, core, empty) == 'type = "EMPTY" is not MESH: choose a mesh, or convert it to one'
    light = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
    scene.collection.objects.link(light)
    assert 'type = "LIGHT"' in refused(tools, core, light)


def test_a_mesh_that_blender_does_not_evaluate_is_refused(core, tools, add) -> None:
    line = "is disabled, or not in this scene: turn on its monitor symbol in the Outliner"
    assert refused(tools, core, add(hide_viewport=True)).startswith(line)


def test_a_hidden_mesh_has_its_modifiers(tools, add) -> None:
    obj = add(sheet(lambda x, y: -0.2 * x))
    lift = obj.modifiers.new("Lift", "DISPLACE")
    lift.strength, lift.mid_level, lift.direction = 3.0, 0.0, "Z"
    obj.hide_set(True)
    assert sampled(tools, obj).start[2] == pytest.approx(2.0, abs=0.1)


def test_a_mesh_in_edit_mode_is_refused(core, tools, add) -> None:
    import bpy

    obj = add()
    bpy.context.view_layer.objects.active = obj
    bpy.ops.object.mode_set(mode="EDIT")
    assert refused(tools, core, obj) == "is in Edit Mode: leave it first (Tab)"
    bpy.ops.object.mode_set(mode="OBJECT")


def test_a_mesh_without_faces_is_refused(core, tools, add) -> None:
    assert refused(tools, core, add(np.empty((0, 3, 3)))).startswith(
        "faces = 0 is outside at least 1: choose a mesh with"
    )


@pytest.mark.parametrize(
    ("place", "line"),
    [
        ({"scale": (0.0, 1.0, 1.0)}, "scale = (0.0, 1.0, 1.0) is flat: give it a scale other than 0"),
        ({"rotation_euler": (math.pi / 2, 0.0, 0.0)}, "steepness = "),
        ({"scale": (0.1, 0.1, 0.1)}, "length = 12.0"),
        ({"scale": (1000.0, 1000.0, 1000.0)}, "length = 120"),
    ],
)
def test_a_place_that_makes_no_slope_is_refused(core, tools, add, place, line) -> None:
    assert refused(tools, core, add(**place)).startswith(line)


def test_a_wall_is_refused(core, tools, add) -> None:
    wall = sheet(lambda x, y: 0.0 * x)
    shown = refused(tools, core, add(wall, rotation_euler=(math.pi / 2, 0.0, 0.0)))
    assert shown == "has no face that looks up: choose a mesh that lies like ground, or turn it"


def test_vertices_that_are_no_numbers_are_refused(core, tools, add) -> None:
    obj = add()
    obj.data.vertices[5].co.z = math.nan
    assert refused(tools, core, obj).startswith("places of vertices are not numbers in ")


def test_an_overhang_is_refused_with_its_place_in_the_world(core, tools, add) -> None:
    roof = np.array([[[40.0, -8.0, 95.0], [60.0, -8.0, 95.0], [50.0, 8.0, 95.0]]])
    shown = refused(tools, core, add(np.concatenate((sheet(hill), roof)), location=(0.0, 0.0, 100.0)))
    assert shown.startswith("has two surfaces over each other, ") and ", 195.0): keep the upper one, and move" in shown


def test_a_start_beside_the_mesh_is_refused(core, tools, add) -> None:
    assert refused(tools, core, add(), (-40.0, 0.0, 0.0)).startswith(
        "start = (-40.0, 0.0) is not on the mesh: put it over"
    )


def test_a_run_is_planned_on_a_sampled_mesh(core, tools, add, tmp_path) -> None:
    ground = sampled(tools, add(sheet(hill, 300.0, 120.0, 2.0)))
    path = tools.write_ground(ground, tmp_path / "hill.npz")
    spec = core("spec").RunSpec().with_overrides(ground.slope_keys(path) | {"course.turn_count": 2})
    motion = core("turning.preview").preview_motion(spec)
    ground.check_track(motion.position)
    terrain = ground.terrain()
    off = motion.position[:, 2] - terrain.height(motion.position[:, 0], motion.position[:, 1])
    assert np.abs(off).max() < 1e-6
