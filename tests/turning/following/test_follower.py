from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from ski_addon.turning.following import (
    best_plan,
    between_samples,
    body_on,
    follow,
    follow_to_the_end,
    lane_on_flat,
    plain,
)
from ski_addon.turning.following.stepping import CURVATURE, LEAN, LEAN_RATE

from .following_scenes import disc, scene, sine, wall


@pytest.fixture(scope="module")
def ridden():
    problem = sine(obstacles=(disc(17, -1.0), disc(35, 0.6)))
    return problem, follow(problem)


def test_claim_12_path_is_followed_to_its_end_past_obstacles(ridden):
    problem, followed = ridden
    assert followed.reason == "" and followed.nearest[-1] >= problem.lane.path.last
    assert not problem.obstacles.hit_by(followed.places[:-1], followed.places[1:]).any()
    assert followed.cost == pytest.approx(followed.distance.sum()) and followed.distance.mean() < 0.7


def test_claim_12_curvature_is_continuous_within_its_bounds_and_linear_in_every_stage(ridden):
    problem, followed = ridden
    curvature = followed.states[:, CURVATURE]
    change = np.diff(curvature)[: 3 * (len(curvature) // 3)].reshape(-1, 3) / 0.1
    assert np.abs(change - change[:, :1]).max() < 1e-9 and np.abs(change).max() <= problem.rate_bound + 1e-9
    assert change[:, 0] == pytest.approx(followed.rates[: len(change)])
    assert np.abs(curvature).max() <= problem.curvature_bound
    assert np.abs(followed.states[:, LEAN]).max() <= problem.settings.lean_bound


def test_motion_between_samples_meets_them(ridden):
    problem, followed = ridden
    time, states, speed = between_samples(problem, followed, 100.0)
    assert len(time) == len(states) == len(speed) and np.diff(time) == pytest.approx(0.01)
    assert states[::10] == pytest.approx(followed.states, abs=2e-4)
    rate = np.gradient(states[:, LEAN], 0.01)
    assert rate[1:-1] == pytest.approx(states[1:-1, LEAN_RATE], abs=0.02)


def test_motion_between_samples_meets_them_where_the_speed_changes():
    problem = sine()
    quickening = lane_on_flat(problem.lane.path, lambda places: 6.0 + 0.08 * np.clip(places[:, 0], 0.0, 60.0))
    problem = replace(problem, lane=quickening)
    followed = follow(problem)
    _, states, speed = between_samples(problem, followed, 50.0)
    assert states[::5] == pytest.approx(followed.states, abs=2e-4) and 6.0 <= speed.min() < speed.max() <= 10.8


def test_blocked_path_keeps_the_motion_up_to_the_obstacle():
    problem = scene([(0, 0), (60, 0)], (wall((30, -40), (30, 40), name="fence"),))
    followed = follow(problem)
    assert followed.reason.startswith("fence is in the way")
    assert 25.0 < followed.places[-1, 0] < 30.0 and len(followed.time) == len(followed.states) > 30
    assert not problem.obstacles.hit_by(followed.places[:-1], followed.places[1:]).any()


def test_start_beside_the_path_comes_back_to_it():
    problem = scene([(0, 0), (70, 0)])
    followed = follow(problem, body_on(problem.lane, np.array([0.0, 2.0]), heading=0.3))
    assert followed.distance[:10].max() > 2.0 and followed.distance[-10:].max() < 0.4


def test_slower_where_the_path_says_so():
    quick, slow = (follow(scene([(0, 0), (40, 0)], speed=speed)).time[-1] for speed in (8.0, 4.0))
    assert slow == pytest.approx(2.0 * quick, abs=0.25)


def test_the_papers_planner_follows_too():
    problem = scene([(0, 0), (12, 0.5), (24, -0.5)], stages=7, inputs=7)
    followed = follow(problem, planner=plain)
    assert followed.reason == "" and followed.nodes.sum() > 100


def test_claim_12_plans_of_the_paper_keep_to_a_path_of_waves():
    offs = []
    for planner in (plain, best_plan):
        followed = follow(sine(stages=8, inputs=7), planner=planner)
        lean = np.degrees(np.abs(followed.states[:, LEAN])).max()
        assert not followed.reason and 10.0 < lean <= 30.0
        offs.append(followed.distance.mean())
    assert offs[1] < 0.75 * offs[0] and 0.3 < offs[0] < 0.8


@pytest.mark.parametrize("seed", range(4))
def test_ways_through_random_trees_and_past_random_gates_are_found(seed):
    random = np.random.default_rng(seed)
    trees = [disc(x, random.uniform(-4, 4), 0.3, 0.5) for x in np.arange(12, 75, random.uniform(2, 3))]
    gates, x = [], 16.0
    for side in (1, -1, 1, -1, 1, -1):
        gap = random.uniform(0.3, 1.0)
        gates.append(wall((x, -side * gap), (x, side * 12)))
        x += random.uniform(8.5, 12)
    bends = [(0, 0), *((x, random.uniform(-2, 2)) for x in (20, 40, 60)), (80, 0)]
    for points, obstacles in ((bends, trees), ([(x, 0) for x in range(0, 81, 20)], gates)):
        problem = scene(points, tuple(obstacles), rate=0.35)
        followed = follow_to_the_end(problem)
        assert not followed.reason and not problem.obstacles.hit_by(followed.places[:-1], followed.places[1:]).any()


def test_what_stops_a_body_for_good_is_found_once_and_told():
    problem = scene([(0, 0), (60, 0)], (wall((30, -90), (30, 90)),))
    followed, once = follow_to_the_end(problem), follow(problem)
    assert "wall is in the way" in followed.reason and followed.nearest[-1] >= once.nearest[-1]
