"""The inclined plane."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.spec import SlopeSpec
from ski_addon.terrain import build_terrain

PLACES = np.random.default_rng(0).uniform(-50, 50, size=(20, 2))


@pytest.mark.parametrize("angle", [0, 5, 10, 45])
def test_normal_is_the_finite_difference_of_the_height(angle):
    terrain, step = build_terrain(SlopeSpec(angle_deg=angle)), 1e-3
    x, y = PLACES.T
    slope_x = (terrain.height(x + step, y) - terrain.height(x - step, y)) / (2 * step)
    slope_y = (terrain.height(x, y + step) - terrain.height(x, y - step)) / (2 * step)
    expected = np.stack((-slope_x, -slope_y, np.ones_like(x)), axis=-1)
    expected /= np.linalg.norm(expected, axis=-1, keepdims=True)
    np.testing.assert_allclose(terrain.normal(x, y), expected, atol=1e-9)


def test_slope_falls_along_x_and_passes_through_the_origin():
    terrain = build_terrain(SlopeSpec(angle_deg=30))
    assert terrain.height(0.0, 3.0) == 0.0
    assert terrain.height(math.sqrt(3), -1.0) == pytest.approx(-1.0)


def test_height_and_normal_broadcast():
    terrain = build_terrain(SlopeSpec(angle_deg=10))
    x, y = np.linspace(0, 1, 4)[:, None], np.linspace(0, 1, 3)
    assert terrain.height(x, y).shape == (4, 3) and terrain.normal(x, y).shape == (4, 3, 3)
    assert terrain.height(0.0, 0.0).shape == () and terrain.normal(0.0, 0.0).shape == (3,)


def test_a_normal_that_was_given_out_may_be_changed():
    terrain = build_terrain(SlopeSpec(angle_deg=10))
    terrain.normal(PLACES[:, 0], PLACES[:, 1])[0] = 0.0
    assert terrain.normal(0.0, 0.0)[2] == pytest.approx(math.cos(math.radians(10)))
