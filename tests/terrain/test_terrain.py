"""What holds on every ground: derivatives that fit, continuous curvature, single numbers as well as arrays."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.spec import SlopeSpec
from ski_addon.terrain import HeightGrid, build_terrain

GROUNDS = {
    "plane": SlopeSpec(angle_deg=12),
    "flat bumps": SlopeSpec(kind="bumps", angle_deg=0, bump_start=2, bump_count=2),
    "bumps": SlopeSpec(kind="bumps", angle_deg=8, bump_start=5, bump_count=3),
    "steep bumps": SlopeSpec(kind="bumps", angle_deg=25, bump_height=0.6, bump_width=4, bump_start=5, bump_fillet=0.6),
    "paper's 3 m bumps": SlopeSpec(kind="bumps", angle_deg=5, bump_height=3, bump_width=8, bump_start=5, bump_count=2),
    "moguls": SlopeSpec(kind="moguls", angle_deg=20, bump_start=3),
    "wide moguls": SlopeSpec(kind="moguls", angle_deg=10, bump_start=3, mogul_across=6.0, mogul_height=0.8),
    "one steep mogul": SlopeSpec(kind="moguls", angle_deg=30, mogul_count=1, mogul_height=1.5, mogul_spacing=5.0),
}
ROUGH = np.random.default_rng(4).uniform(-0.2, 0.2, (21, 9)) - 0.5 * np.arange(21.0)[:, None]
GRIDS = {
    "rolling hill": lambda: build_terrain(SlopeSpec(kind="grid", angle_deg=10, grid_file="rolling_hill")),
    "rough grid, ending among the places": lambda: HeightGrid(ROUGH, (2.0, 3.0), (1.0, -12.0), angle=0.1),
    "smallest grid": lambda: HeightGrid(ROUGH[:4, :4], 5.0),
}
PLACES = np.random.default_rng(1).uniform((-10, -20), (60, 20), size=(400, 2)).T


@pytest.fixture(params=[*GROUNDS, *GRIDS], ids=lambda name: name.replace(" ", "-"))
def terrain(request):
    return GRIDS[request.param]() if request.param in GRIDS else build_terrain(GROUNDS[request.param])


def test_gradient_is_the_finite_difference_of_the_height(terrain):
    x, y = PLACES
    step = 1e-4
    along = (terrain.height(x + step, y) - terrain.height(x - step, y)) / (2 * step)
    across = (terrain.height(x, y + step) - terrain.height(x, y - step)) / (2 * step)
    np.testing.assert_allclose(terrain.gradient(x, y), np.stack((along, across), axis=-1), rtol=1e-6, atol=1e-6)


def test_normal_is_upright_on_the_gradient(terrain):
    x, y = PLACES
    normal, slope = terrain.normal(x, y), terrain.gradient(x, y)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=-1), 1.0, rtol=1e-12)
    np.testing.assert_allclose(normal[:, :2], -slope * normal[:, 2:], atol=1e-12)
    assert np.all(normal[:, 2] > 0.0)


@pytest.mark.parametrize("direction", [(1.0, 0.0), (0.0, 1.0), (0.8, 0.6)])
def test_curvature_is_continuous(terrain, direction):
    """The jumps between second derivatives of neighbouring places shrink as fast as their distance does."""

    def jump(step):
        along = np.arange(-12.0, 62.0, step)
        slope = terrain.gradient(*(along * part for part in direction)) @ np.array(direction)
        return np.max(np.abs(np.diff(slope, 2))) / step

    coarse, fine = jump(4e-3), jump(1e-3)
    assert fine <= max(0.35 * coarse, 1e-8)


def test_one_place_is_answered_as_many_are(terrain):
    x, y = PLACES[:, :50]
    for ask in (terrain.height, terrain.gradient, terrain.normal, terrain.contains):
        many = ask(x, y)
        for i, place in enumerate(zip(x.tolist(), y.tolist(), strict=True)):
            np.testing.assert_allclose(ask(*place), many[i], rtol=1e-12, atol=1e-12)
            np.testing.assert_allclose(ask(np.float64(place[0]), place[1]), many[i], rtol=1e-12, atol=1e-12)


def test_places_broadcast(terrain):
    x, y = np.linspace(0, 1, 4)[:, None], np.linspace(0, 1, 3)
    for ask, last in ((terrain.height, ()), (terrain.contains, ()), (terrain.gradient, (2,)), (terrain.normal, (3,))):
        assert ask(x, y).shape == (4, 3, *last)
        assert ask(0.0, 0.0).shape == ask(np.array(1.0), 2).shape == last
        assert ask(0, np.zeros(5)).shape == (5, *last)
        assert ask(np.zeros(0), 0.0).shape == (0, *last)


def test_answers_may_be_changed(terrain):
    before = terrain.normal(1.0, 2.0).copy()
    terrain.normal(1.0, 2.0)[:] = 0.0
    terrain.normal(PLACES[0], PLACES[1])[:] = 0.0
    np.testing.assert_array_equal(terrain.normal(1.0, 2.0), before)


def test_the_known_ground_is_what_the_extent_says(terrain):
    x_low, x_high, y_low, y_high = terrain.extent
    assert x_low < x_high and y_low < y_high
    middle = [0.5 * (low + high) if math.isfinite(low) else 0.0 for low, high in ((x_low, x_high), (y_low, y_high))]
    assert terrain.contains(*middle)
    for place in ((x_low, middle[1]), (middle[0], y_high)):
        assert terrain.contains(*np.clip(place, -1e9, 1e9))


def test_far_away_the_ground_is_still_there(terrain):
    x, y = np.array([-500.0, 2500.0, 10.0]), np.array([600.0, -2500.0, 1e5])
    away = terrain.height(x, y) + x * math.tan(terrain.mean_angle)
    assert np.all(np.abs(away) < 10.0)
    assert np.all(np.isfinite(terrain.normal(x, y)))


def test_no_place_has_no_height(terrain):
    """A simulation that has lost its numbers is told so, and does not hang."""
    for nowhere in (math.nan, np.array([1.0, math.nan, 2.0])):
        assert np.any(np.isnan(terrain.height(nowhere, 0.0))), nowhere
    assert np.isnan(terrain.height(np.float64("nan"), 0.0))
    assert not terrain.contains(math.nan, 0.0)
