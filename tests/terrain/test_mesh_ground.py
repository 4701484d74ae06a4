"""A mesh as ground: where it falls, that it is met, where it ends, and what is refused with what to do."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.errors import MissingInputError, OutputError, SpecError
from ski_addon.spec import RunSpec
from ski_addon.terrain import build_terrain, mesh_ground, read_ground, write_ground
from ski_addon.terrain.mesh_ground import BEHIND
from tests.terrain.meshes import hill, moved, sheet

TURN, SHIFT = 0.7, (500.0, -300.0, 20.0)
MESH = moved(sheet(hill), TURN, SHIFT)
NAME = 'object "Hill"'
RNG = np.random.default_rng(9)


def mesh_height(x, y):
    """The moved hill's height at places of the world."""
    x, y = x - SHIFT[0], y - SHIFT[1]
    return SHIFT[2] + hill(math.cos(TURN) * x + math.sin(TURN) * y, math.cos(TURN) * y - math.sin(TURN) * x)


def off_the_mesh(ground, terrain, places: int = 300):
    """How far the terrain lies off the mesh at random places of the run that the mesh covers, in the world [m]."""
    rows, columns = ground.size
    x, y = RNG.uniform(ground.origin, np.add(ground.origin, (rows, columns)), (places, 2)).T
    x, y = (values[ground.covers(x, y)] for values in (x, y))
    world = ground.to_world(np.stack((x, y, terrain.height(x, y)), axis=-1))
    return world[:, 2] - mesh_height(world[:, 0], world[:, 1])


def line_of(*arguments, **more):
    with pytest.raises(SpecError) as caught:
        mesh_ground(*arguments, **more)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 300
    return str(caught.value)


def test_the_ground_of_the_file_is_the_mesh_in_the_world(tmp_path):
    ground = mesh_ground(MESH, NAME)
    path = write_ground(ground, tmp_path / "hill.npz")
    terrain = build_terrain(RunSpec().with_overrides(ground.slope_keys(path)).slope)
    assert np.abs(off_the_mesh(ground, terrain)).max() < 0.01
    assert np.abs(off_the_mesh(ground, ground.terrain())).max() < 0.01


def test_x_runs_down_the_fall_line():
    ground = mesh_ground(MESH, NAME)
    down = ground.world_from_run[:3, 0]
    np.testing.assert_allclose(down, (math.cos(TURN), math.sin(TURN), 0.0), atol=0.01)
    np.testing.assert_allclose(ground.world_from_run[:3, 2], (0.0, 0.0, 1.0))
    assert math.degrees(ground.terrain().mean_angle) == pytest.approx(14.0, abs=0.3)


def test_the_start_lies_in_from_the_upper_end_in_the_middle():
    ground = mesh_ground(MESH, NAME)
    x, y = ground.start[:2] - SHIFT[:2]
    down, left = math.cos(TURN) * x + math.sin(TURN) * y, math.cos(TURN) * y - math.sin(TURN) * x
    assert down == pytest.approx(5.0, abs=0.5) and left == pytest.approx(0.0, abs=0.5)
    assert ground.start[2] == pytest.approx(mesh_height(*ground.start[:2]), abs=0.01)


def test_the_run_s_origin_lies_on_the_mean_plane_below_or_over_the_start():
    ground = mesh_ground(MESH, NAME)
    terrain = ground.terrain()
    np.testing.assert_allclose(ground.to_world(np.array((0.0, 0.0, terrain.height(0.0, 0.0)))), ground.start, atol=0.01)
    assert ground.world_from_run[2, 3] == pytest.approx(ground.start[2] + terrain.altitude, abs=1e-9)
    assert abs(terrain.altitude) > 0.1  # here the two are not the same


def test_a_given_start_is_the_origin_and_little_is_kept_uphill_of_it():
    start = (530.0, -270.0, 999.0)
    ground = mesh_ground(MESH, NAME, start)
    np.testing.assert_allclose(ground.start, (530.0, -270.0, mesh_height(530.0, -270.0)), atol=0.01)
    np.testing.assert_allclose(ground.world_from_run[:2, 3], start[:2], atol=1e-9)
    assert -BEHIND - 1 < ground.origin[0] < -BEHIND + 1
    assert np.abs(off_the_mesh(ground, ground.terrain())).max() < 0.01


def test_a_given_heading_is_the_x_axis():
    ground = mesh_ground(MESH, NAME, heading=TURN + 0.4)
    np.testing.assert_allclose(ground.world_from_run[:2, 0], (math.cos(TURN + 0.4), math.sin(TURN + 0.4)))
    assert np.abs(off_the_mesh(ground, ground.terrain())).max() < 0.01
    assert 0.3 < ground.covered.mean() < 0.95  # the mesh lies askew in its rectangle


def test_the_resolution_fits_the_faces_or_is_as_asked():
    ground = mesh_ground(MESH, NAME)
    assert ground.spacing == 0.5 and ground.summary.startswith("0.5 m, 240 x 1")
    assert mesh_ground(MESH, NAME, resolution=1.5).spacing == 1.5
    assert mesh_ground(sheet(lambda x, y: -0.2 * x, face=20.0), NAME).spacing == 2.0


def test_a_large_mesh_gets_a_million_samples():
    ground = mesh_ground(sheet(lambda x, y: -0.2 * x, 4000.0, 3000.0, 500.0), NAME)
    assert 900_000 < ground.heights.size <= 1_000_000


def test_one_flat_face_is_a_plane():
    ground = mesh_ground(sheet(lambda x, y: -0.3 * x, 100.0, 100.0, 100.0), NAME)
    np.testing.assert_allclose(ground.terrain().height(30.0, RNG.uniform(-40, 40, 20)), -9.0, atol=1e-6)


def cone(x, y):
    return 60.0 - 0.25 * np.sqrt((x - 60.0) ** 2 + y**2 + 25.0)


def test_a_round_hill_is_skied_down_from_where_one_starts():
    mesh = sheet(cone, 120.0, 120.0, keep=lambda x, y: np.hypot(x - 60, y) < 55)
    for start, down in (((50.0, 0.0), (-1.0, 0.0)), ((60.0, 10.0), (0.0, 1.0)), ((66.0, -8.0), (0.6, -0.8))):
        ground = mesh_ground(mesh, NAME, start)
        np.testing.assert_allclose(ground.world_from_run[:2, 0], down, atol=0.03)
        assert ground.terrain().mean_angle > math.radians(1.0)
        assert ground.covers(0.0, 0.0)


def test_from_beside_a_ridge_one_skis_down_that_side():
    mesh = sheet(lambda x, y: -0.3 * abs(y), 120.0, 120.0)
    for y, way in ((3.0, 1.0), (-20.0, -1.0)):
        ground = mesh_ground(mesh, NAME, (60.0, y))
        np.testing.assert_allclose(ground.world_from_run[:2, 0], (0.0, way), atol=0.01)


def test_bumps_round_a_start_do_not_turn_the_run():
    mesh = sheet(lambda x, y: -0.2 * x + 0.3 * np.sin(0.4 * x) * np.sin(0.5 * y))
    for start in ((30.0, 0.0), (47.0, 8.0), (61.0, -11.0)):
        np.testing.assert_allclose(mesh_ground(mesh, NAME, start).world_from_run[:2, 0], (1.0, 0.0), atol=0.02)


def test_ground_ends_beyond_a_valley():
    mesh = sheet(lambda x, y: 0.15 * np.sqrt((x - 100.0) ** 2 + 9.0), 200.0, 60.0)
    ground = mesh_ground(mesh, NAME, (20.0, 0.0))
    assert ground.origin[0] + ground.size[0] == pytest.approx(80.0 + 30.0, abs=1.0)
    assert ground.terrain().mean_angle > math.radians(4.0)
    whole = mesh_ground(mesh - 0.3 * mesh[..., :1] * (0, 0, 1), NAME, (20.0, 0.0))
    assert whole.size[0] > 188.0


def test_a_mesh_full_of_holes_has_no_start():
    mesh = sheet(lambda x, y: -0.2 * x, keep=lambda x, y: (x < 1) | (x > 119))
    assert line_of(mesh, NAME).startswith(f"{NAME} start is not found: the mesh is full of holes: give a start on")


def test_beyond_a_mesh_that_is_no_rectangle_nothing_is_covered():
    mesh = sheet(hill, keep=lambda x, y: np.hypot((x - 60) / 60, y / 30) < 1.0)
    ground = mesh_ground(mesh, NAME)
    x, y = RNG.uniform(ground.origin, np.add(ground.origin, ground.size), (500, 2)).T
    world = ground.to_world(np.stack((x, y, 0 * x), axis=-1))
    share = np.hypot((world[:, 0] - 60) / 60, world[:, 1] / 30)
    covered = ground.covers(x, y)
    assert np.all(covered[share < 0.9]) and not np.any(covered[share > 1.03])
    assert not ground.covers(1000.0, 0.0)
    assert np.all(ground.terrain().contains(x, y))  # made up, but there
    over = ground.terrain().height(x, y) + x * math.tan(ground.terrain().mean_angle)
    assert np.abs(over).max() < 3.0  # what is made up stays near the mean plane


def test_a_track_that_leaves_the_mesh_is_refused_with_the_place():
    ground = mesh_ground(sheet(hill), NAME)
    track = np.column_stack((np.arange(0.0, 150.0), np.zeros(150), np.zeros(150)))
    ground.check_track(track[:100])
    with pytest.raises(
        SpecError, match=r'^object "Hill" ends 115 m along the track, at \(120\.\d, -?0\.0\) of the world'
    ):
        ground.check_track(track)


def test_a_solid_is_skied_on_its_upper_side():
    top = sheet(hill)
    under = sheet(lambda x, y: 0 * x + 40.0)[:, ::-1]
    ground = mesh_ground(np.concatenate((top, under)), NAME)
    world = ground.to_world(np.array((50.0, 3.0, float(ground.terrain().height(50.0, 3.0)))))
    assert world[2] == pytest.approx(hill(*world[:2]), abs=0.01)


def test_faces_that_look_down_are_ground_where_nothing_lies_under_them():
    flipped = sheet(hill)
    flipped[::3] = flipped[::3, ::-1]
    for mesh in (sheet(hill)[:, ::-1], flipped):
        ground = mesh_ground(mesh, NAME)
        np.testing.assert_allclose(ground.heights, mesh_ground(sheet(hill), NAME).heights, atol=0.02)


def test_walls_are_left_out():
    wall = np.array([[[30.0, -20.0, 80.0], [30.0, 20.0, 80.0], [30.0, 0.0, 160.0]]])
    with_wall = mesh_ground(np.concatenate((sheet(hill), wall)), NAME)
    np.testing.assert_array_equal(with_wall.heights, mesh_ground(sheet(hill), NAME).heights)


def roof(z):
    return np.array([[[40.0, -8.0, z], [60.0, -8.0, z], [50.0, 8.0, z]]])


BROKEN = np.where(np.arange(len(MESH))[:, None, None] == 7, math.nan, MESH)
UPRIGHT = sheet(hill)[:, :, [2, 1, 0]] * (1.0, 1.0, 0.0) + sheet(hill) * (0.0, 0.0, 1.0)


@pytest.mark.parametrize(
    ("mesh", "more", "line"),
    [
        (np.empty((0, 3, 3)), {}, "faces = 0 is outside at least 1: choose a mesh with faces, or make instances real"),
        (BROKEN, {}, "places of vertices are not numbers in 1 of 14400 triangles: delete these vertices, or mend the "),
        (sheet(hill) * (1, 0, 1), {}, "has no face that looks up: choose a mesh that lies like ground, or turn it"),
        (sheet(lambda x, y: -1.2 * x), {}, "steepness = 50.2 is outside 0.5..45 degrees: turn it so that it lies like"),
        (sheet(lambda x, y: 0 * x), {}, "steepness = 0.0 is outside 0.5..45 degrees: tilt it, or give a start on the"),
        (sheet(hill, 15.0, 10.0), {}, "length = 15.0 is outside 20..10000 m: scale it to its real size in metres"),
        (sheet(hill, 40.0, 3.0), {}, "width = 3.0 is outside 4..10000 m: scale it to its real size in metres"),
        (1000.0 * sheet(hill), {}, "length = 120000.33 is outside 20..10000 m: scale it to its real size in metres"),
        (sheet(hill), {"start": (300.0, 0.0, 0.0)}, "start = (300.0, 0.0) is not on the mesh: put it over the mesh"),
        (sheet(hill), {"start": (60.0, 31.0, 0.0)}, "start = (60.0, 31.0) is not on the mesh: put it over the mesh"),
        (sheet(hill), {"start": (math.nan, 0.0, 0.0)}, "start = (nan, 0.0, 0.0) is not a point: give x, y and z"),
        (
            sheet(hill),
            {"start": (110.0, 0.0, 0.0)},
            "length below the start = 10.0 is outside 20..10000 m: start further",
        ),
        (
            sheet(hill),
            {"start": (60.0, 29.9)},
            "start = (60.0, 29.9) is less than 0.5 m from the edge: move it further in",
        ),
        (sheet(hill), {"heading": math.inf}, "heading = inf is outside any angle: give a number"),
        (sheet(hill), {"heading": math.pi}, "rises by 14.0 degrees from the start on, where it should fall: turn the"),
        (sheet(hill), {"resolution": 0.01}, "resolution = 0.01 is outside 0.043..15 m: the ground is 120 m by 60 m"),
        (sheet(hill), {"resolution": 30.0}, "resolution = 30.0 is outside 0.043..15 m: the ground is 120 m by 60 m"),
        (sheet(hill), {"resolution": math.nan}, "resolution = nan is outside 0.043..15 m"),
        (np.concatenate((sheet(hill), roof(95.0))), {}, "has two surfaces over each other, "),
        (
            np.concatenate((sheet(hill), roof(95.0)[:, ::-1])),
            {},
            "has a face that looks down over one that looks up, at ",
        ),
        (sheet(lambda x, y: hill(x, y) - 8.0 * (x > 60)), {}, "is a cliff of 83 degrees (at most 60) at (60.2, "),
    ],
)
def test_what_makes_no_ground_is_refused(mesh, more, line):
    assert line_of(mesh, NAME, **more).startswith(f"{NAME} {line}")


def test_the_place_of_an_overhang_is_named():
    shown = line_of(np.concatenate((sheet(hill), roof(95.0))), NAME)
    x, y, z = (float(value) for value in shown.partition("at (")[2].partition(")")[0].split(","))
    assert 40 < x < 60 and -8 < y < 8 and z == 95.0


def test_the_place_of_a_cliff_is_named():
    shown = line_of(sheet(lambda x, y: hill(x, y) - 8.0 * (x > 60)), NAME)
    x, y, z = (float(value) for value in shown.partition(" at (")[2].partition(")")[0].split(","))
    assert x == pytest.approx(60.0, abs=1.0) and hill(x, y) - 8.0 < z < hill(x, y)


def test_thin_layers_and_sheets_on_sheets_are_no_overhang():
    doubled = np.concatenate((sheet(hill), sheet(hill) + (0.0, 0.0, 0.05)))
    assert mesh_ground(doubled, NAME).start[2] == pytest.approx(mesh_ground(sheet(hill), NAME).start[2] + 0.05)


def test_a_low_step_is_no_overhang():
    low, high = sheet(lambda x, y: 0 * x, 30.0, 40.0), sheet(lambda x, y: 0 * x + 0.6, 30.0, 40.0) - (30.0, 0.0, 0.0)
    ground = mesh_ground(np.concatenate((low, high)), NAME, resolution=0.5)
    assert ground.covered.all()


def test_a_written_ground_is_read_again(tmp_path):
    ground = mesh_ground(sheet(hill, keep=lambda x, y: x + y < 120), NAME, heading=0.0)
    again = read_ground(write_ground(ground, tmp_path / "hill.npz"))
    assert (again.spacing, again.origin, again.name) == (ground.spacing, ground.origin, ground.name)
    for name in ("heights", "covered", "world_from_run", "start"):
        np.testing.assert_array_equal(getattr(again, name), getattr(ground, name))
    assert (tmp_path / "hill.npz").read_bytes() == write_ground(ground, tmp_path / "two.npz").read_bytes()
    assert sorted(path.name for path in tmp_path.iterdir()) == ["hill.npz", "two.npz"]


def test_files_that_cannot_be_used_are_named(tmp_path):
    ground = mesh_ground(sheet(hill), NAME)
    with pytest.raises(OutputError, match="ends in .npz"):
        write_ground(ground, tmp_path / "hill.npy")
    with pytest.raises(OutputError, match="cannot write"):
        write_ground(ground, tmp_path / "nowhere" / "hill.npz")
    with pytest.raises(MissingInputError, match="there is no such file"):
        read_ground(tmp_path / "hill.npz")
    np.savez(tmp_path / "other.npz", height=ground.heights)
    with pytest.raises(MissingInputError, match="not a ground sampled from a mesh"):
        read_ground(tmp_path / "other.npz")
