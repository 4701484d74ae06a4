"""Drawn obstacles: one object a row, on the ground, as large as the row says, and not doubled when renewed."""

from __future__ import annotations

import numpy as np
import pytest

DISC = {"kind": "disc", "points": [[10.0, 3.0]]}
LINE = {"kind": "line", "name": "kerb", "points": [[5.0, -3.0], [12.0, -4.0]]}
BLOCK = {"kind": "polygon", "points": [[20.0, 2.0], [24.0, 2.0], [24.0, 5.0]]}


@pytest.fixture
def draw(core, extension):
    def build(*rows, snow):
        import bpy

        course = {"kind": "follow", "start_speed": 6.0}
        points = [{"x": 0.0, "y": 0.0}, {"x": 30.0, "y": 0.0}]
        document = {"slope": {"angle_deg": 10.0}, "course": course, "point": points, "obstacle": list(rows)}
        spec = core("spec").RunSpec.from_dict(document)
        terrain = core("terrain").build_terrain(spec.slope)
        collection = bpy.data.collections.new("Obstacles")
        return core("blender.obstacles").build_obstacles(spec, terrain, collection, snow=snow), terrain

    return build


def points_of(obj) -> np.ndarray:
    return np.array([obj.matrix_world @ v.co for v in obj.data.vertices])


def test_a_row_becomes_an_object_of_its_name(draw):
    made, _ = draw(DISC | {"radius": 0.4}, LINE, BLOCK, snow=False)
    assert [obj.name.split(".")[0] for obj in made] == ["Obstacle 1", "kerb", "Obstacle 3"]


def test_all_firs_are_one_object_and_a_thin_disc_is_a_pole(draw):
    firs = [DISC | {"radius": 0.3, "points": [[x, 3.0]]} for x in (8.0, 14.0)]
    made, _ = draw(*firs, DISC | {"radius": 0.05}, snow=True)
    assert [obj.name.split(".")[0] for obj in made] == ["Obstacle 3", "Obstacle firs"]


def test_a_pole_stands_plumb_in_the_snow(draw):
    (pole,), terrain = draw(DISC | {"radius": 0.05}, snow=True)
    points = points_of(pole)
    x, y = 10.0 * np.cos(terrain.mean_angle), 3.0
    np.testing.assert_allclose(points[:, :2].mean(axis=0), (x, y), atol=1e-5)
    assert np.abs(points[:, :2] - (x, y)).max() < 0.02
    ground = float(terrain.height(x, y))
    assert points[:, 2].min() < ground - 0.2 and ground + 1.7 < points[:, 2].max() < ground + 1.9


def test_a_net_follows_its_line_upright_on_the_snow(draw):
    (net,), terrain = draw(LINE, snow=True)
    points = points_of(net)
    over = points[:, 2] - terrain.height(points[:, 0], points[:, 1])
    assert over.min() < 0.1 and 0.8 < over.max() < 2.5
    ends = np.array(LINE["points"]) * (np.cos(terrain.mean_angle), 1.0)
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    aside = (points[:, :2] - ends[0]) @ np.array((-along[1], along[0]))
    way = (points[:, :2] - ends[0]) @ along
    assert np.abs(aside).max() < 0.1
    assert abs(way.min()) < 0.1 and abs(way.max() - np.linalg.norm(ends[1] - ends[0])) < 0.1


def test_holes_and_edges_lie_on_the_ground_and_look_up(draw):
    made, terrain = draw(DISC | {"radius": 0.4}, LINE, snow=False)
    for obj in made:
        x, y, z = points_of(obj).T
        assert np.abs(z - terrain.height(x, y)).max() < 0.02
        assert all(face.normal.z > 0.9 for face in obj.data.polygons)


def test_a_hole_is_as_wide_as_its_disc(draw):
    (hole,), terrain = draw(DISC | {"radius": 0.4}, snow=False)
    middle = np.array([10.0 * np.cos(terrain.mean_angle), 3.0])
    dark = points_of(hole)[28:56, :2]  # the ring where the rim ends
    reach = np.linalg.norm(dark - middle, axis=1)
    assert reach.mean() == pytest.approx(0.4, rel=0.02)
    assert np.ptp(reach) < 0.1 * 0.8


def test_a_block_is_closed_and_faces_out(draw):
    (block,), _ = draw(BLOCK, snow=False)
    middle = points_of(block).mean(axis=0)
    for face in block.data.polygons:
        assert np.dot(face.normal, np.array(face.center) - middle) > 0.0


def test_renewing_the_ground_does_not_double_the_obstacles(core, extension):
    import bpy

    points = [{"x": 0.0, "y": 0.0}, {"x": 20.0, "y": 0.0}]
    document = {
        "slope": {"angle_deg": 5.0}, "figure": {"kind": "bicycle"},
        "course": {"kind": "follow", "start_speed": 6.0, "target_speed": 6.0},
        "point": points, "obstacle": [DISC | {"radius": 0.4}, LINE],
    }  # fmt: skip
    spec = core("spec").RunSpec.from_dict(document)
    motion = core("turning.preview").preview_motion(spec)
    model = core("turning.figures").build_figure(spec)
    ride = core("blender.ride").instant_ride(model, spec, motion)
    ground = core("blender.ground")
    collection = ground.renew_ground(ride, spec, bpy.context.scene, None)
    names = sorted(obj.name for obj in collection.all_objects)
    assert any(name.startswith("kerb") for name in names)
    ground.renew_ground(ride, spec, bpy.context.scene, collection)
    assert sorted(obj.name for obj in collection.all_objects) == names
