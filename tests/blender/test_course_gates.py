"""Gates that stand in the scene are the course: set, moved, duplicated, deleted; curves as paths and gate lines."""

from __future__ import annotations

import math

import numpy as np
import pytest


@pytest.fixture
def read(core):
    return core("blender.properties").read_spec


@pytest.fixture
def placing(core):
    return core("blender.gate_placing")


def poles(ski) -> list:
    return sorted((o for o in ski.gates.all_objects if o.ski_gate.is_gate), key=lambda pole: pole.location.x)


def make_curve(scene, places, kind="POLY"):
    import bpy

    data = bpy.data.curves.new("Line", "CURVE")
    data.dimensions = "3D"
    if places:
        spline = data.splines.new(kind)
        points = spline.bezier_points if kind == "BEZIER" else spline.points
        points.add(len(places) - 1)
        for point, place in zip(points, places, strict=True):
            point.co = place if kind == "BEZIER" else (*place, 1.0)
            if kind == "BEZIER":
                point.handle_left_type = point.handle_right_type = "AUTO"
    obj = bpy.data.objects.new("Line", data)
    scene.collection.objects.link(obj)
    bpy.context.view_layer.update()
    return obj


def test_a_set_course_is_the_discipline_s(core, ski, read) -> None:
    import bpy

    bpy.ops.ski.set_gates(discipline="slalom", count=12)
    spec = read(ski)
    assert (spec.course.kind, spec.course.gate_setting, len(spec.gate)) == ("gates", "list", 12)
    x = np.array([gate.x for gate in spec.gate])
    np.testing.assert_allclose(np.diff(x), 10.0, atol=2e-3)
    assert len(poles(ski)) == 12
    bpy.ops.ski.set_gates(discipline="giant_slalom", count=5)
    assert len(poles(ski)) == 5
    assert len([obj for obj in ski.gates.all_objects if obj.data]) == 15  # two poles and a panel each


def test_gates_stand_on_the_snow_numbered_red_and_blue(core, ski, read) -> None:
    import bpy

    bpy.ops.ski.set_gates(discipline="slalom", count=6)
    terrain = core("terrain").build_terrain(read(ski).slope)
    for index, pole in enumerate(poles(ski)):
        x, y, z = pole.matrix_world.translation
        assert z == pytest.approx(float(terrain.height(x, y)), abs=1e-4)
        assert pole.name == f"Gate {index + 1}"
        assert ("red" if index % 2 == 0 else "blue") in pole.data.name


def test_the_course_goes_with_its_gates(core, ski, read) -> None:
    """A gate that is moved, duplicated or deleted changes the plan at once."""
    import bpy

    bpy.ops.ski.set_gates(discipline="slalom", count=6)
    third = poles(ski)[2]
    before = read(ski).gate[2]
    third.location.y += 0.75
    bpy.context.view_layer.update()
    assert read(ski).gate[2].y == pytest.approx(before.y + 0.75, abs=2e-3)
    copy = third.copy()
    ski.gates.objects.link(copy)
    copy.location.x += 5.0 * math.cos(math.radians(11))
    bpy.context.view_layer.update()
    assert len(read(ski).gate) == 7
    bpy.data.objects.remove(copy)
    bpy.data.objects.remove(third)
    assert len(read(ski).gate) == 5


def test_a_parented_gate_counts_where_it_is_seen(core, ski, scene, read) -> None:
    import bpy

    bpy.ops.ski.set_gates(discipline="slalom", count=3)
    empty = bpy.data.objects.new("Wind", None)
    scene.collection.objects.link(empty)
    gate, before = poles(ski)[1], read(ski).gate[1]
    gate.parent = empty
    empty.location.y = 1.5
    bpy.context.view_layer.update()
    assert read(ski).gate[1].y == pytest.approx(before.y + 1.5, abs=2e-3)


def test_a_gate_has_its_own_radius_and_distance(ski, read) -> None:
    import bpy

    bpy.ops.ski.set_gates(discipline="slalom", count=3)
    own = poles(ski)[1].ski_gate
    own.radius_word, own.radius = False, 9.0
    own.side = "left"
    gate = read(ski).gate[1]
    assert (gate.radius, gate.side, gate.distance) == (9.0, "left", "auto")


def test_added_gates_are_numbered_down_the_slope(ski, read) -> None:
    import bpy

    for x, y in ((40.0, 2.0), (20.0, -2.0), (30.0, 0.0)):
        assert bpy.ops.ski.add_gate(location=(x, y, 50.0)) == {"FINISHED"}
    assert [pole.name for pole in poles(ski)] == ["Gate 1", "Gate 2", "Gate 3"]
    assert [round(gate.y) for gate in read(ski).gate] == [-2, 0, 2]
    assert all(pole.matrix_world.translation.z < 0.0 for pole in poles(ski))  # down on the snow


@pytest.mark.parametrize("before", ["left", "right"])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_gates_set_from_side_to_side_are_passed_on_their_outsides(core, ski, read, before, side) -> None:
    """Whatever turn came first in the run before: the track goes round each pole, not between them."""
    import bpy

    ski.course.first_turn, ski.course.start_speed = before, 6.0
    ski.course.target_speed_word, ski.course.target_speed = False, 7.0
    for index in range(5):
        bpy.ops.ski.add_gate(location=(20.0 + 11.0 * index, side * (1.0 if index % 2 == 0 else -1.0), 0.0))
    shown = core("blender.live").preview_of(ski)
    assert not shown.problem, shown.problem
    for pole in poles(ski):
        x, y, _ = pole.matrix_world.translation
        nearest = shown.line[int(np.argmin(np.hypot(shown.line[:, 0] - x, shown.line[:, 1] - y)))]
        assert abs(nearest[1]) > abs(y)


def test_gates_without_a_parent_are_read_from_a_moved_start(ski, read) -> None:
    import bpy

    bpy.ops.ski.set_gates(discipline="giant_slalom", count=4)
    for pole in poles(ski):
        pole.parent = None
    before = read(ski).gate
    ski.start.location, ski.start.rotation_euler.z = (5.0, -2.0, -1.0), 0.0
    bpy.context.view_layer.update()
    cosine = math.cos(math.radians(11.0))
    for one, other in zip(before, read(ski).gate, strict=True):
        assert other.x == pytest.approx(one.x - 5.0 / cosine, abs=3e-3)
        assert other.y == pytest.approx(one.y + 2.0, abs=3e-3)


def test_set_gates_face_down_the_fall_line(ski) -> None:
    import bpy

    ski.start.rotation_euler.z = math.radians(90.0)
    bpy.context.view_layer.update()
    bpy.ops.ski.set_gates(discipline="giant_slalom", count=3)
    gate = next(obj for obj in ski.gates.all_objects if obj.name == "Gate 1")
    outer = next(child for child in gate.children if "outer" in child.name)
    aside = outer.matrix_world.translation - gate.matrix_world.translation
    assert abs(aside.x) == pytest.approx(0.75, abs=1e-3) and abs(aside.y) < 1e-3  # across the fall line, which is +y


def test_a_preset_s_gates_can_be_made_to_stand(core, ski, placing, read) -> None:
    spec = core("spec").RunSpec.from_dict(
        {
            "course": {"kind": "gates", "gate_setting": "list"},
            "gate": [{"x": 12, "y": 2, "radius": 8.0}, {"x": 22, "y": -2}, {"x": 32, "y": 2, "side": "left"}],
        }
    )
    core("blender.properties").write_spec(ski, spec)
    placing.set_gates(ski, spec)
    assert [(g.x, g.y, g.side, g.radius) for g in read(ski).gate] == [(g.x, g.y, g.side, g.radius) for g in spec.gate]


def test_a_mouse_ray_meets_the_snow(core, ski, placing, read) -> None:
    spec = read(ski)
    terrain = core("terrain").build_terrain(spec.slope)
    eye = np.array((-10.0, 4.0, 12.0))
    aim = np.array((25.0, -3.0, float(terrain.height(25.0, -3.0))))
    found = placing.ground_under_ray(ski, spec, eye, aim - eye)
    np.testing.assert_allclose(found, aim, atol=1e-5)
    assert placing.ground_under_ray(ski, spec, eye, np.array((0.0, 0.0, 1.0))) is None


def test_baked_gates_that_stand_swing_and_are_not_doubled(ski, scene) -> None:
    import bpy

    bpy.ops.ski.set_gates(discipline="slalom", count=6)
    bpy.ops.ski.bake(source="PREVIEW")
    assert len([obj for obj in scene.objects if obj.name.startswith("Gate")]) == 6
    bpy.ops.ski.clear_gates()
    assert not [obj for obj in scene.objects if obj.name.startswith("Gate")]


@pytest.mark.parametrize("kind", ["POLY", "BEZIER"])
def test_a_curve_is_the_path(core, ski, scene, read, kind) -> None:
    terrain = core("terrain").build_terrain(read(ski).slope)
    places = [(x, y, float(terrain.height(x, y))) for x, y in ((0, 0), (20, 4), (45, -4), (70, 0))]
    ski.curve = make_curve(scene, places, kind)
    ski.course.kind = "path"
    points = read(ski).point
    cosine = math.cos(terrain.mean_angle)
    assert points[0].x == pytest.approx(0.0, abs=2e-3) and points[-1].x == pytest.approx(70 / cosine, abs=2e-3)
    assert len(points) == 4 if kind == "POLY" else len(points) > 30
    track = core("pipeline").make_plan(read(ski)).track
    gap = np.linalg.norm(track.position[:, None, :2] - np.array(places)[None, :, :2], axis=2).min(axis=0)
    assert gap.max() < 0.7


def off_line(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """How far each of `points` (m, 2) is from the nearest straight piece between neighbours of `line` (n, 2)."""
    way, from_start = np.diff(line, axis=0), points[:, None] - line[None, :-1]
    share = np.clip(np.sum(from_start * way, axis=2) / np.maximum(np.sum(way * way, axis=1), 1e-12), 0.0, 1.0)
    return np.linalg.norm(from_start - share[..., None] * way, axis=2).min(axis=1)


@pytest.mark.parametrize("ends", [True, False])
def test_a_nurbs_curve_is_the_path_that_is_seen(core, ski, scene, read, ends) -> None:
    ski.curve = make_curve(scene, [(0, 0, 0), (15, 6, 0), (35, -6, 0), (55, 6, 0), (75, 0, 0)], "NURBS")
    ski.curve.scale, ski.curve.location.y = (2.0, 2.0, 2.0), 1.0
    scene.view_layers[0].update()
    spline = ski.curve.data.splines[0]
    spline.order_u, spline.use_endpoint_u, ski.curve.data.resolution_u = 4, ends, 64
    ski.course.kind = "path"
    points = np.array([(point.x, point.y) for point in read(ski).point])
    mesh = ski.curve.to_mesh()
    seen = np.array([(2.0 * vertex.co.x, 2.0 * vertex.co.y + 1.0) for vertex in mesh.vertices])
    points[:, 0] *= math.cos(core("terrain").build_terrain(read(ski).slope).mean_angle)
    assert off_line(points, seen).max() < 0.1 and off_line(seen, points).max() < 0.1
    np.testing.assert_allclose(points[[0, -1]], seen[[0, -1]], atol=0.05)
    assert core("pipeline").make_plan(read(ski)).plan.length > 40.0


def test_a_nurbs_curve_is_a_line_of_gates_by_its_points(ski, scene, read) -> None:
    ski.curve = make_curve(scene, [(20, 2, 0), (32, -2, 0), (44, 2, 0), (56, -2, 0)], "NURBS")
    ski.curve.data.splines[0].use_endpoint_u = True
    ski.course.kind, ski.course.gate_setting = "gates", "list"
    gates = read(ski).gate
    assert len(gates) == 4
    thirds = [gate.y for gate in gates]  # with four points it is a Bezier curve: its places at 0, 1/3, 2/3 and 1
    np.testing.assert_allclose(thirds, [2.0, 2.0 / 27.0, -2.0 / 27.0, -2.0], atol=2e-3)


def test_a_curve_can_be_a_line_of_gates(ski, scene, read) -> None:
    ski.curve = make_curve(scene, [(20, 2, 0), (32, -2, 0), (44, 2, 0)])
    ski.course.kind, ski.course.gate_setting = "gates", "list"
    assert len(read(ski).gate) == 3


@pytest.mark.parametrize(
    ("kind", "places", "words"),
    [
        ("POLY", [], 'Line" has no points'),
        ("POLY", [(0, 0, 0)], "has fewer than two points"),
        ("NURBS", [(0, 0, 0)], "has fewer than two points"),
    ],
)
def test_a_curve_without_a_course_is_refused(core, ski, scene, read, kind, places, words) -> None:
    ski.curve = make_curve(scene, places, kind)
    ski.course.kind = "path"
    with pytest.raises(core("errors").SpecError, match=words):
        read(ski)


def test_a_gate_off_the_slope_is_named(core, ski) -> None:
    import bpy

    ski.slope.kind, ski.slope.grid_file = "grid", "rolling_hill"
    bpy.ops.ski.set_gates(discipline="slalom", count=4)
    poles(ski)[2].location.y = 400.0
    bpy.context.view_layer.update()
    with pytest.raises(RuntimeError, match="gate 3"):
        bpy.ops.ski.plan()
