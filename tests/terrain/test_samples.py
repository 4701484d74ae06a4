"""Scattered points, as of a mesh, become a ground."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.errors import TerrainError
from ski_addon.terrain import grid_from_samples

RNG = np.random.default_rng(16)
X, Y = (axis.ravel() for axis in np.meshgrid(np.linspace(0, 40, 41), np.linspace(-10, 10, 21), indexing="ij"))


def hill(x, y):
    return 100.0 - 0.2 * x + 0.5 * np.sin(x / 6) * np.cos(y / 5)


def line_of(*arguments, **more):
    with pytest.raises(TerrainError) as caught:
        grid_from_samples(*arguments, **more)
    assert "\n" not in str(caught.value) and str(caught.value).startswith("the ground's points: ")
    return str(caught.value).removeprefix("the ground's points: ")


def test_points_in_any_order_give_their_surface():
    order = RNG.permutation(len(X))
    ground = grid_from_samples(X[order], Y[order], hill(X, Y)[order])
    assert ground.extent == pytest.approx((0.0, 40.0, -10.0, 10.0))
    x, y = RNG.uniform((1, -9), (39, 9), (200, 2)).T
    np.testing.assert_allclose(ground.height(x, y) + ground.altitude, hill(x, y), atol=0.01)


def test_irregular_points_do_too():
    x, y = X + RNG.uniform(-0.3, 0.3, X.shape), Y + RNG.uniform(-0.3, 0.3, Y.shape)
    ground = grid_from_samples(x, y, hill(x, y), spacing=0.5)
    assert ground.spacing == pytest.approx((0.5, 0.5), rel=0.02)
    x, y = RNG.uniform((2, -8), (38, 8), (200, 2)).T
    np.testing.assert_allclose(ground.height(x, y) + ground.altitude, hill(x, y), atol=0.02)


def test_corners_beyond_the_points_go_on_as_the_mean_plane():
    inside = np.hypot((X - 20) / 20, Y / 10) <= 1.0
    ground = grid_from_samples(X[inside], Y[inside], -0.2 * X[inside])
    np.testing.assert_allclose(ground.height(X, Y) + ground.altitude, -0.2 * X, atol=1e-9)


@pytest.mark.parametrize(
    ("points", "line"),
    [
        ((X, Y, X[:5]), "there are 861 x, 861 y and 5 z: give as many of each"),
        ((X[:9], Y[:9], X[:9]), "there are 9, at least 16 are needed: subdivide the mesh"),
        ((X, Y, np.where(np.arange(861) == 7, math.nan, X)), "point 7 = (0, -3, nan) is not finite: remove it"),
        ((X, 2 * X, X), "all points lie on one line, seen from above"),
        ((0 * X, 0 * Y, X), "all points lie on one line, seen from above"),
        ((np.append(X, 5.0), np.append(Y, 2.0), np.append(0 * X, 3.0)), "points 117 and 861 lie over each other, 3 m"),
    ],
)
def test_points_that_make_no_ground_are_refused(points, line):
    assert line_of(*points).startswith(line)


def test_too_fine_a_spacing_is_refused_before_it_is_tried():
    assert line_of(X, Y, hill(X, Y), spacing=1e-4).startswith("it has 400001 x 200001 samples, allowed are 64 million")


def test_a_cliff_among_the_points_is_found():
    assert "is a cliff of" in line_of(X, Y, np.where(X > 20, -5.0, 0.0))
