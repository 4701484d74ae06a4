from __future__ import annotations

import numpy as np
import pytest

from ski_addon.turning.following import POLYGON, Obstacle, Obstacles

from .following_scenes import disc, wall

SQUARE = Obstacle(POLYGON, np.array([(10, -1), (12, -1), (12, 1), (10, 1)], dtype=float), 0.0, 0.2, "hut")


def hit(obstacles: list[Obstacle], begin: tuple[float, float], end: tuple[float, float]) -> bool:
    return bool(Obstacles.of(obstacles).hit_by(np.array([begin], dtype=float), np.array([end], dtype=float))[0])


def test_claim_12_track_past_a_disc_keeps_radius_and_tolerance():
    assert hit([disc(5, 0, 1.0, 0.5)], (0, 1.49), (10, 1.49))
    assert not hit([disc(5, 0, 1.0, 0.5)], (0, 1.51), (10, 1.51))


def test_nothing_slips_through_a_line_between_two_samples():
    assert hit([wall((5, -3), (5, 3), tolerance=0.0)], (0, 0), (10, 0))
    assert hit([wall((5, -3), (5, 3))], (4, 0), (4.71, 0))
    assert not hit([wall((5, -3), (5, 3))], (4, 0), (4.69, 0))


def test_polygon_is_closed_and_solid():
    some = Obstacles.of([SQUARE])
    assert hit([SQUARE], (9, 0.9), (13, 0.9)) and not hit([SQUARE], (9, 1.21), (13, 1.21))
    assert some.at(np.array([11.0, 0.0])) is SQUARE and some.at(np.array([9.9, 0.0])) is SQUARE
    assert some.at(np.array([9.7, 0.0])) is None


def test_many_tracks_and_obstacles_agree_with_dense_points_on_the_tracks():
    random = np.random.default_rng(3)
    mixed = [disc(*random.uniform(0, 10, 2), 0.4, 0.1) for _ in range(5)]
    mixed += [wall(*random.uniform(0, 10, (3, 2)).tolist(), tolerance=0.2) for _ in range(3)] + [SQUARE]
    some = Obstacles.of(mixed)
    begin = random.uniform(0, 10, (300, 2))
    end = begin + random.normal(0, 0.6, (300, 2))
    share = np.linspace(0, 1, 400)[:, None, None]
    nearest = some.clearance((begin + share * (end - begin)).reshape(-1, 2)).reshape(400, 300).min(axis=0)
    clear = np.abs(nearest) > 3e-3  # within a step of the dense points nothing can be said
    assert (some.hit_by(begin, end) == (nearest <= 0.0))[clear].all() and 30 < np.count_nonzero(nearest < 0.0) < 270


def test_moved_obstacle_and_those_near_a_place():
    assert disc(5, 0).moved(np.array([1.0, 2.0])).points.tolist() == [[6.0, 2.0]]
    near = Obstacles.of([disc(5, 0), disc(50, 0), wall((0, 3), (100, 3))]).near(np.array([0.0, 0.0]), 10.0)
    assert near.owner.tolist() == [0, 2]


def test_first_obstacle_that_is_hit_is_named():
    some = Obstacles.of([disc(5, 0, name="oak"), disc(8, 0, name="elm")])
    line = np.stack((np.arange(12.0), np.zeros(12)), axis=1)
    found = some.first_hit(line[:-1], line[1:])
    assert found is not None and found.name == "oak"
    assert some.first_hit(line[:2] + (0, 9), line[1:3] + (0, 9)) is None


def test_without_obstacles_all_is_clear():
    none = Obstacles.of([])
    assert not none.hit_by(np.zeros((3, 2)), np.ones((3, 2))).any() and np.isinf(none.clearance(np.zeros((2, 2)))).all()
    assert none.at(np.zeros(2)) is None and len(none.near(np.zeros(2), 5.0)) == 0
    assert Obstacles.of([disc(0, 0)]).clearance(np.array([[0.0, 0.0]]))[0] == pytest.approx(-0.75)
