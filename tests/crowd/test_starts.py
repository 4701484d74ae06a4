"""Keeping apart: distances of moving skiers, and starts that keep them."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.crowd.starts import NoRoom, Start, find_starts, least, real_nearest
from ski_addon.crowd.tracks import least_distance, on_clock, way_of
from tests.crowd.crowds import crowd_of, straight_way

FPS = 24.0


def crowd(**changes):
    usual = {"start_interval": 0.0, "start_variation": 0.0, "linger": 0.0}
    return crowd_of(3, {f"crowd.{key}": value for key, value in (usual | changes).items()})


def test_least_distance_lies_between_steps_too():
    """Two cross at a right angle and miss each other by half a metre between two samples."""
    apart = np.array([[-1.0, 0.5, 0.0], [1.0, 0.5, 0.0], [3.0, 0.5, 0.0]])
    length, step = least_distance(apart)
    assert float(length) == pytest.approx(0.5) and int(step) == 0


def test_least_distance_is_that_of_fine_sampling():
    rng = np.random.default_rng(4)
    apart = np.cumsum(rng.normal(size=(5, 30, 3)), axis=1)
    length, _ = least_distance(apart)
    fine = np.linspace(0.0, 29.0, 29001)
    for one, found in zip(apart, length, strict=True):
        dense = np.stack([np.interp(fine, np.arange(30), column) for column in one.T], axis=1)
        assert found == pytest.approx(np.linalg.norm(dense, axis=1).min(), abs=1e-4)


def test_somebody_who_is_not_there_is_far_away():
    assert least_distance(np.full((4, 3), np.nan))[0] == np.inf


def test_a_way_on_the_crowds_clock_is_that_way():
    way = straight_way(speed=5.0, duration=2.0)
    first, place = on_clock(way, 0.25, 0.5)
    assert first == 2 and place[0].tolist() == pytest.approx([-0.25, 0.0, 0.0])  # as if it came from above
    assert place[3, 0] == pytest.approx(5.0 * (0.5 - 0.25))
    assert place[-1, 0] == place[-4, 0] == 10.0 and first + len(place) - 1 == 28  # stands there until 2.75 s


def test_who_does_not_linger_is_looked_at_to_the_very_end():
    first, place = on_clock(straight_way(speed=5.0, duration=2.0), 0.25, 0.0)
    assert first + len(place) - 1 == 23 and place[-1, 0] == pytest.approx(5.0 * (2.3 - 0.25))


def test_a_way_is_sampled_from_uneven_times():
    time = np.array([0.0, 0.03, 0.5, 1.0])
    way = way_of(time, np.stack((2 * time, 0 * time, -time), axis=1), 1.0)
    assert way.place[5] == pytest.approx([1.0, 0.0, -0.5]) and len(way.place) == 11


def test_who_follows_on_the_same_line_waits():
    """At 5 m/s, 4 m are 0.8 s."""
    made = find_starts(crowd(apart=4), {0: straight_way(), 1: straight_way(), 2: straight_way()}, FPS)
    times = [made[index].time for index in range(3)]
    assert times[0] == 0.0 and made[1].delay == made[1].time
    assert all(0.8 - 1e-9 <= gap <= 0.8 + 5 / FPS for gap in np.diff(times))
    assert all((time * FPS) % 1 == pytest.approx(0.0, abs=1e-9) for time in times)


def test_a_faster_one_waits_until_it_does_not_catch_up():
    ways = {0: straight_way(5.0, 10.0), 1: straight_way(10.0, 5.0)}
    made = find_starts(crowd(apart=3), ways, FPS)
    assert made[1].time >= 5.0
    found = real_nearest(ways, made, 0.0)
    assert found[0].distance == found[1].distance >= 3.0 and (found[0].index, found[1].index) == (1, 0)


def test_who_lingers_at_the_end_is_kept_away_from():
    ways = {0: straight_way(5.0, 2.0), 1: straight_way(5.0, 2.0)}
    made = find_starts(crowd(apart=3, linger=5), ways, FPS)
    assert made[1].time >= 5.0 + 3.0 / 5.0 - 0.1  # a step


def test_lines_beside_each_other_save_waiting():
    changes = {"crowd.start_interval": 0, "crowd.apart": 2, "spread.offset": 20, "crowd.start_variation": 0}
    made = find_starts(crowd_of(3, changes), {index: straight_way() for index in range(3)}, FPS)
    assert [made[index].time for index in range(3)] == [0.0, 0.0, 0.0]
    offsets = sorted(made[index].offset for index in range(3))
    assert np.diff(offsets).min() >= 2.0


@pytest.mark.parametrize("seed", range(5))
def test_random_crowds_are_kept_apart(seed):
    rng = np.random.default_rng(seed)
    ways = {
        index: straight_way(float(rng.uniform(3, 12)), float(rng.uniform(3, 15)), float(rng.uniform(-2, 2)))
        for index in range(25)
    }
    spec = crowd_of(25, {"crowd.seed": seed, "crowd.apart": 3, "crowd.start_interval": 0.5, "spread.offset": 8})
    made = find_starts(spec, ways, FPS)
    placed = {index: start for index, start in made.items() if isinstance(start, Start)}
    found = real_nearest({index: ways[index] for index in placed}, placed, spec.crowd.linger)
    assert len(placed) >= 20 and least(list(found.values())).distance >= 3.0


def test_the_start_of_a_member_does_not_depend_on_those_after_it():
    ways = {index: straight_way(4.0 + index % 3) for index in range(6)}
    spec = crowd(apart=2)
    made = find_starts(spec, ways, FPS)
    assert find_starts(spec, {index: ways[index] for index in range(4)}, FPS) == {i: made[i] for i in range(4)}


def test_who_finds_no_start_in_time_is_told_how_near_it_would_be():
    made = find_starts(crowd(apart=40, delay_max=2), {0: straight_way(), 1: straight_way()}, FPS)
    assert isinstance(made[0], Start) and isinstance(made[1], NoRoom)
    assert made[1].nearest.index == 0 and 5.0 < made[1].nearest.distance <= 10.0 + 1e-6


def test_without_a_distance_nobody_waits():
    made = find_starts(crowd(apart=0), {0: straight_way(), 1: straight_way()}, FPS)
    assert made[1] == Start(0.0, 0.0, 0.0)
