"""Where the ground's mesh is fine, that it has no cracks, and that it keeps within bounds."""

from __future__ import annotations

import numpy as np
import pytest

LINES = np.linspace(-40.0, 80.0, 16), np.linspace(-40.0, 40.0, 11)
TRACK = np.column_stack((np.linspace(0.0, 40.0, 401), np.zeros(401), np.zeros(401)))


def terrain_of(core, **changes):
    keys = {"slope." + key: value for key, value in changes.items()}
    return core("terrain").build_terrain(core("spec").RunSpec().with_overrides(keys).slope)


@pytest.fixture
def moguls(core):
    return terrain_of(core, kind="moguls", angle_deg=20)


def open_edges(faces: list[tuple[int, ...]]) -> np.ndarray:
    """The edges (n, 2) that only one face has; fails if two faces have one in the same direction."""
    edges = np.array([pair for face in faces for pair in zip(face, (*face[1:], face[0]), strict=True)])
    assert len(np.unique(edges, axis=0)) == len(edges)
    there = {tuple(edge) for edge in edges.tolist()}
    return np.array([edge for edge in there if (edge[1], edge[0]) not in there])


def longest_sides(vertices: np.ndarray, faces: list[tuple[int, ...]], near: float) -> np.ndarray:
    """The longest horizontal side [m] of each face within `near` [m] of the track, amid the bumps."""
    sides = []
    for face in faces:
        corners = vertices[list(face), :2]
        if np.all(np.abs(corners[:, 1]) < near) and np.all((corners[:, 0] > 15.0) & (corners[:, 0] < 35.0)):
            sides.append(np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1).max())
    return np.array(sides)


def test_a_plane_is_not_cut(core) -> None:
    plane = terrain_of(core, kind="plane")
    vertices, faces = core("blender.ground_mesh").ground_mesh(plane.height, LINES, TRACK)
    assert len(faces) == 15 * 10
    assert {len(face) for face in faces} == {4}
    np.testing.assert_allclose(vertices[:, 2], plane.height(vertices[:, 0], vertices[:, 1]))


def test_there_are_no_cracks(core, moguls) -> None:
    vertices, faces = core("blender.ground_mesh").ground_mesh(moguls.height, LINES, TRACK)
    border = vertices[np.unique(open_edges(faces))]
    x, y = border[:, 0], border[:, 1]
    on_the_edge = np.isin(x, LINES[0][[0, -1]]) | np.isin(y, LINES[1][[0, -1]])
    assert np.all(on_the_edge)


def test_faces_look_up(core, moguls) -> None:
    vertices, faces = core("blender.ground_mesh").ground_mesh(moguls.height, LINES, TRACK)
    for face in faces:
        corners = vertices[list(face)]
        assert np.cross(corners[1] - corners[0], corners[-1] - corners[0])[2] > 0.0


def test_faces_lie_on_the_ground_near_the_track(core, moguls) -> None:
    mesh = core("blender.ground_mesh")
    vertices, faces = mesh.ground_mesh(moguls.height, LINES, TRACK)
    middles = np.array([vertices[list(face)].mean(axis=0) for face in faces])
    off = np.abs(middles[:, 2] - moguls.height(middles[:, 0], middles[:, 1]))
    inside = (middles[:, 0] > 0.0) & (middles[:, 0] < 40.0)
    near, far = inside & (np.abs(middles[:, 1]) < 1.5), inside & (np.abs(middles[:, 1]) > 20.0)
    assert 0.0 < off[near].max() < 0.004
    assert 0.01 < off[far].max() < 0.1


@pytest.mark.parametrize(("kind", "finest"), [("moguls", 0.36), ("bumps", 1.5)])
def test_bumps_are_fine_near_the_track_and_coarse_elsewhere(core, kind: str, finest: float) -> None:
    terrain = terrain_of(core, kind=kind, angle_deg=10)
    vertices, faces = core("blender.ground_mesh").ground_mesh(terrain.height, LINES, TRACK)
    assert longest_sides(vertices, faces, 2.0).max() < finest
    assert longest_sides(vertices, faces, 40.0).max() > 2.0 * finest
    assert len(faces) < 60_000


def test_a_rough_ground_is_drawn_with_fewer_faces(core) -> None:
    def rough(x, y):
        return 0.3 * np.sin(9.0 * x) * np.sin(7.0 * y)

    vertices, faces = core("blender.ground_mesh").ground_mesh(rough, LINES, TRACK, most=3000)
    assert len(faces) < 6000
    open_edges(faces)
    assert np.abs(vertices[:, 2]).max() <= 0.3
