from __future__ import annotations

import numpy as np
import pytest

from ski_addon.errors import SpecError
from ski_addon.turning.following import hermite_path, lane_on_flat, polyline_path
from ski_addon.turning.following.desired_path import CLOSEST, FURTHEST


def test_claim_12_a_segment_of_some_metres_has_twelve_samples():
    assert polyline_path([(0, 0), (4, 0), (4, 3)]).last == 24


def test_short_and_long_segments_are_sampled_as_closely_as_is_of_use():
    path = polyline_path([(0, 0), (0.1, 0), (40, 0)])
    gap = np.diff(path.along[: path.last + 1])
    assert gap[0] == pytest.approx(0.1) and gap[1:].max() <= FURTHEST and gap[1:].min() >= CLOSEST


def test_hermite_segment_of_a_parabola_is_the_parabola():
    path = hermite_path(np.array([(0.0, 0.0), (4.0, 1.6)]), np.array([(4.0, 0.0), (4.0, 3.2)]))
    x, y = path.places[: path.last + 1].T
    assert y == pytest.approx(0.1 * x**2, abs=2e-3)


def test_spline_through_points_meets_them_with_one_tangent():
    points = np.array([(0, 0), (3, 1), (9, -1), (14, 0)], dtype=float)
    path = hermite_path(points)
    for point in points:
        assert np.linalg.norm(path.places - point, axis=1).min() < 1e-9
    assert np.abs(np.diff(path.heading[: path.last])).max() < 0.2


def test_path_goes_straight_on_beyond_its_end():
    path = polyline_path([(0, 0), (3, 4)], beyond=10.0)
    onward = path.places[path.last :] - path.places[path.last]
    assert onward @ (0.8, -0.6) == pytest.approx(0.0, abs=1e-9) and path.along[-1] == pytest.approx(15.0)
    assert path.length == pytest.approx(5.0)


def test_nearest_sample_is_that_of_a_search_through_all():
    path = hermite_path(np.array([(0, 0), (10, 3), (20, -3), (30, 0)], dtype=float))
    lane = lane_on_flat(path, 8.0)
    places = path.places[:60] + np.random.default_rng(1).uniform(-0.8, 0.8, (60, 2))
    found, distance = lane.nearest(places[:, 0], places[:, 1], np.arange(60))
    apart = np.linalg.norm(places[:, None] - path.places[None], axis=2)
    assert found.tolist() == apart.argmin(axis=1).tolist()
    assert distance == pytest.approx(apart.min(axis=1))


def test_speed_may_depend_on_the_place():
    path = polyline_path([(0, 0), (30, 0)])
    lane = lane_on_flat(path, lambda places: 5.0 + 0.1 * places[:, 0])
    assert lane.speed[path.last] == pytest.approx(8.0)


@pytest.mark.parametrize("speed", [0.0, -3.0, float("nan"), 1e4])
def test_speed_at_which_nobody_balances_is_named_with_its_place(speed):
    with pytest.raises(SpecError, match=r"speed = .* is outside 1\.\.60 m/s: at x = 0\.0, y = 0\.0"):
        lane_on_flat(polyline_path([(0, 0), (30, 0)]), speed)
