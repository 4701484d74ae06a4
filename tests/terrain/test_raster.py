"""Heights of triangles over a grid: what a ray cast down at each sample would find."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.terrain.raster import Lattice, surface_heights
from tests.terrain.meshes import hill, moved, sheet

LATTICE = Lattice((-3.3, -4.1), 0.37, (30, 25))


def rays(triangles: np.ndarray, lattice: Lattice) -> tuple[np.ndarray, np.ndarray]:
    """The same, sample by sample and triangle by triangle, with barycentric coordinates."""
    top, bottom = np.full(lattice.shape, -np.inf), np.full(lattice.shape, np.inf)
    for i, j in np.ndindex(lattice.shape):
        at = np.array(lattice.low) + lattice.step * np.array((i, j))
        for a, b, c in triangles:
            share = np.linalg.solve(np.column_stack((b[:2] - a[:2], c[:2] - a[:2])), at - a[:2])
            if share.min() >= 0.0 and share.sum() <= 1.0:
                z = a[2] + share @ (b[2] - a[2], c[2] - a[2])
                top[i, j], bottom[i, j] = max(top[i, j], z), min(bottom[i, j], z)
    return top, bottom


def test_it_finds_what_rays_find():
    triangles = np.random.default_rng(4).uniform(-5.0, 9.0, (12, 3, 3))
    for found, cast in zip(surface_heights(triangles, LATTICE), rays(triangles, LATTICE), strict=True):
        np.testing.assert_array_equal(np.isfinite(found), np.isfinite(cast))
        np.testing.assert_allclose(found[np.isfinite(found)], cast[np.isfinite(cast)], atol=1e-9)


@pytest.mark.parametrize("turn", [0.0, 0.25 * np.pi, 1.0])
def test_no_sample_falls_between_two_triangles(turn):
    mesh = moved(sheet(hill, 20.0, 20.0), turn, (0.0, 0.0, 0.0)).astype(np.float32)
    middle = mesh.reshape(-1, 3).mean(axis=0)
    top, bottom = surface_heights(mesh, Lattice((middle[0] - 5.0, middle[1] - 5.0), 0.25, (41, 41)))
    assert np.all(np.isfinite(top))
    np.testing.assert_allclose(top, bottom, atol=2e-4)


def test_samples_on_the_edge_belong_to_the_mesh():
    top, _ = surface_heights(sheet(hill, 20.0, 20.0), Lattice((0.0, -10.0), 1.0, (21, 21)))
    x, y = np.meshgrid(np.arange(21.0), np.arange(-10.0, 11.0), indexing="ij")
    np.testing.assert_allclose(top, hill(x, y), atol=1e-9)


def test_many_small_and_few_large_triangles_give_the_same_plane(monkeypatch):
    monkeypatch.setattr("ski_addon.terrain.raster._AT_ONCE", 1000)  # so that the work is cut into parts
    lattice = Lattice((0.5, -9.5), 0.5, (38, 38))
    fine, coarse = (surface_heights(sheet(lambda x, y: 0.3 * x - y, 20.0, 20.0, f), lattice)[0] for f in (0.25, 20.0))
    np.testing.assert_allclose(fine, coarse, atol=1e-9)


def test_nothing_is_found_beside_the_mesh():
    top, bottom = surface_heights(sheet(hill), Lattice((500.0, 0.0), 1.0, (5, 5)))
    assert np.all(top == -np.inf) and np.all(bottom == np.inf)
    top, bottom = surface_heights(np.empty((0, 3, 3)), Lattice((0.0, 0.0), 1.0, (5, 5)))
    assert np.all(top == -np.inf) and np.all(bottom == np.inf)
