"""Ground from a grid of heights: it meets the samples, has a mean plane, ends softly, and says what is wrong."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.errors import SkiAddonError, TerrainError
from ski_addon.terrain import HeightGrid

X, Y = np.arange(0.0, 41.0, 2.0), np.arange(-6.0, 7.0, 1.5)
HILL = 1500.0 - 0.2 * X[:, None] + 0.5 * np.sin(X[:, None] / 5) * np.cos(Y / 4)
GRID = HeightGrid(HILL, (2.0, 1.5), (0.0, -6.0))


def line_of(call):
    with pytest.raises(TerrainError) as caught:
        call()
    line = str(caught.value)
    assert isinstance(caught.value, SkiAddonError) and caught.value.exit_code == 2
    assert "\n" not in line and len(line) < 300 and line.startswith("the height grid: ")
    return line.removeprefix("the height grid: "), caught.value


def test_the_ground_meets_its_samples():
    np.testing.assert_allclose(GRID.height(X[:, None], Y) + GRID.altitude, HILL, rtol=1e-13)
    assert GRID.shape == HILL.shape


def test_the_mean_plane_is_fitted_and_passes_through_the_origin():
    fall, at_origin = np.polyfit(np.repeat(X, len(Y)), HILL.ravel(), 1)
    assert GRID.mean_angle == pytest.approx(-math.atan(fall))
    assert GRID.altitude == pytest.approx(at_origin)
    over = GRID.height(X[:, None], Y) + X[:, None] * math.tan(GRID.mean_angle)
    assert np.mean(over) == pytest.approx(0.0, abs=1e-9)


def test_a_plane_of_samples_is_that_plane_everywhere():
    plane = HeightGrid(np.broadcast_to(-0.3 * X[:, None], HILL.shape), (2.0, 1.5), (-10.0, -6.0))
    places = np.random.default_rng(6).uniform(-200, 200, (2, 100))
    np.testing.assert_allclose(plane.height(*places), -0.3 * places[0], atol=1e-9)
    np.testing.assert_allclose(plane.gradient(*places), [[-0.3, 0.0]] * 100, atol=1e-12)


def test_an_angle_puts_the_grid_on_a_slope():
    steeper = HeightGrid(HILL, (2.0, 1.5), (0.0, -6.0), angle=math.radians(15))
    x, y = np.random.default_rng(7).uniform((-20, -20), (60, 20), (100, 2)).T
    np.testing.assert_allclose(steeper.height(x, y), GRID.height(x, y) - x * math.tan(math.radians(15)), atol=1e-9)
    assert math.tan(steeper.mean_angle) == pytest.approx(math.tan(GRID.mean_angle) + math.tan(math.radians(15)))


def test_the_extent_is_that_of_the_samples():
    assert GRID.extent == (0.0, 40.0, -6.0, 6.0)
    inside = GRID.contains(np.array([0.0, 40.0, 20.0, -0.1, 20.0, 40.1]), np.array([-6.0, 6.0, 0.0, 0.0, 6.1, 0.0]))
    assert inside.tolist() == [True, True, True, False, False, False]


def test_beyond_the_grid_the_edge_is_drawn_out_along_the_mean_plane():
    fall = math.tan(GRID.mean_angle)
    for y in (-20.0, 0.0, 3.0):
        far = GRID.height(np.array([43.0, 80.0, 1000.0]), y) + fall * np.array([43.0, 80.0, 1000.0])
        np.testing.assert_allclose(far, far[0], atol=1e-9)
    np.testing.assert_allclose(GRID.gradient(500.0, np.array([-3.0, 2.0]))[:, 0], -fall)
    np.testing.assert_allclose(GRID.gradient(7.0, np.array([-100.0, 300.0]))[:, 1], 0.0, atol=1e-12)


def test_the_mirrored_grid_is_the_mirrored_ground():
    mirrored = HeightGrid(HILL[:, ::-1], (2.0, 1.5), (0.0, -6.0))
    x, y = np.random.default_rng(8).uniform((-5, -10), (45, 10), (100, 2)).T
    np.testing.assert_allclose(mirrored.height(x, y), GRID.height(x, -y), atol=1e-9)
    np.testing.assert_allclose(mirrored.normal(x, y), GRID.normal(x, -y) * [1, -1, 1], atol=1e-12)


def test_smoothing_takes_noise_away_and_keeps_the_slope():
    noise = np.random.default_rng(9).normal(0, 0.05, (120, 40))
    heights = -0.25 * np.arange(120.0)[:, None] + noise
    rough, smooth = HeightGrid(heights, 1.0), HeightGrid(heights, 1.0, smoothing=3.0)
    assert smooth.mean_angle == pytest.approx(rough.mean_angle)
    x, y = np.random.default_rng(10).uniform((0, 0), (119, 39), (500, 2)).T
    assert np.std(smooth.gradient(x, y)[:, 1]) < 0.1 * np.std(rough.gradient(x, y)[:, 1])


def test_the_array_that_was_given_may_be_changed_later():
    mine = HILL.copy()
    grid = HeightGrid(mine, (2.0, 1.5), (0.0, -6.0))
    mine[:] = 0.0
    np.testing.assert_array_equal(grid.height(X, 0.0), GRID.height(X, 0.0))


def test_whole_numbers_are_heights_too():
    whole = HeightGrid(np.arange(8)[:, None] * np.ones((8, 5), dtype=np.int16) * -1, 2)
    assert whole.mean_angle == pytest.approx(math.atan(0.5))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_holes_are_counted_and_the_first_is_named(value):
    holed = HILL.copy()
    holed[[3, 3, 7], [5, 6, 1]] = value
    line, error = line_of(lambda: HeightGrid(holed, 2.0))
    assert line.startswith(f"height[3, 5] = {value} is a hole, the first of 3: fill holes")
    assert error.index == (3, 5)


@pytest.mark.parametrize(
    ("heights", "start"),
    [
        (np.zeros((1, 1)), "it has 1 x 1 samples, at least 4 x 4 are needed"),
        (np.zeros((3, 40)), "it has 3 x 40 samples, at least 4 x 4 are needed"),
        (np.zeros(12), "its heights are 12, not a table of rows and columns"),
        (np.zeros((5, 5, 3)), "its heights are 5 x 5 x 3, not a table of rows and columns"),
        (5.0, "its heights are one number, not a table"),
        (np.full((5, 5), "high"), "its heights are of type <U4, not numbers"),
        (np.zeros((5, 5), complex), "its heights are of type complex128, not numbers"),
        (np.broadcast_to(0.0, (9000, 8000)), "it has 9000 x 8000 samples, allowed are 64 million"),
    ],
)
def test_what_is_no_grid_is_refused(heights, start):
    assert line_of(lambda: HeightGrid(heights, 1.0))[0].startswith(start)


@pytest.mark.parametrize("spacing", [0.0, -1.0, math.nan, (1.0, 0.0)])
def test_spacing_is_more_than_nothing(spacing):
    assert line_of(lambda: HeightGrid(HILL, spacing))[0].startswith(f"its spacing is {spacing}: give the metres")


def test_the_origin_is_a_place():
    assert line_of(lambda: HeightGrid(HILL, 1.0, (math.nan, 0.0)))[0].startswith("its origin is (nan, 0.0)")


@pytest.mark.parametrize(("angle", "axis"), [(0.0, 0), (0.0, 1), (0.5, 0)])
def test_a_cliff_is_named_and_what_is_offered_works(angle, axis):
    steps = -0.2 * np.arange(30.0)[:, None] + np.zeros((30, 20))
    if axis == 0:
        steps[18:] -= 4.0
    else:
        steps[:, 12:] += 4.0
    line, error = line_of(lambda: HeightGrid(steps, 2.0, angle=angle))
    named = {0: "from height[17, 0] to height[18, 0]", 1: "from height[0, 11] to height[0, 12]"}[axis]
    drop = {(0.0, 0): "-4.2 m", (0.0, 1): "4 m", (0.5, 0): "-5.293 m"}[angle, axis]
    assert line.startswith(f"{named} is a cliff of {drop} over 2 m (6")
    assert error.index == {0: (17, 0), 1: (0, 11)}[axis]
    share = float(line.split("at most ")[2].split(" %")[0]) / 100
    HeightGrid(steps * share, 2.0, angle=angle)
    line_of(lambda: HeightGrid(steps * (share + 0.2), 2.0, angle=angle))
    HeightGrid(steps, 2.0, angle=angle, smoothing=4.0)


def test_ground_that_rises_downhill_is_to_be_turned():
    line, _ = line_of(lambda: HeightGrid(HILL[::-1], 2.0))
    assert line.startswith("it rises by 11.") and 'slope.grid_downhill), for instance to "top"' in line
    HeightGrid(HILL[::-1], 2.0, angle=math.radians(12))
