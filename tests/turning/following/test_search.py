from __future__ import annotations

import numpy as np
import pytest

from ski_addon.turning.following import best_plan, body_on, plain_plan
from ski_addon.turning.following.balance_range import BalanceRange
from ski_addon.turning.following.dominance import still_to_come
from ski_addon.turning.following.problem import rolled_out
from ski_addon.turning.following.stepping import CURVATURE, LEAN, Bodies

from .following_scenes import disc, scene, sine, wall


@pytest.mark.parametrize("rate", [0.1, 0.3, 1.0])
def test_rates_within_the_range_never_topple_a_body(rate):
    problem, random = sine(rate=rate), np.random.default_rng(5)
    span, one = BalanceRange.of(problem), body_on(problem.lane)
    bodies, leans = Bodies(np.repeat(one.state, 200, 1), np.repeat(one.nearest, 200)), []
    for _ in range(15):
        low, high = span.rates(bodies)
        assert (low <= high).all() and np.abs([low, high]).max() <= rate + 1e-12
        stage = problem.stage(bodies, low + random.uniform(0.1, 0.9, 200) * (high - low))
        bodies = stage.last
        leans.append(np.abs(stage.states[:, LEAN]).max(axis=0))
    assert np.degrees(np.percentile(np.max(leans, axis=0), 99)) < 35.0
    assert np.abs(bodies.state[CURVATURE]).max() <= problem.curvature_bound + 1e-12


def test_rates_outside_of_the_range_topple_a_body_whatever_comes_after():
    problem = sine(rate=0.3)
    span, now = BalanceRange.of(problem), body_on(problem.lane)
    low, high = span.rates(now)
    for rate, side in ((low - 0.06, 1.0), (high + 0.06, -1.0)):  # steering right topples to the left
        bodies = problem.stage(now, rate).last
        for _ in range(7):  # all that can be done: steer under the body
            bodies = problem.stage(bodies, np.array([side * 0.3])).last
        assert side * bodies.state[LEAN, 0] > problem.settings.lean_bound


def test_plan_is_what_its_rates_lead_to():
    problem = sine(obstacles=(disc(17, -1.2),))
    plan = best_plan(problem, body_on(problem.lane))
    states, nearest, distance = rolled_out(problem, body_on(problem.lane), plan.rates)
    assert plan.complete and len(plan.rates) == 10 and plan.states == pytest.approx(states, abs=1e-7)
    assert plan.cost == pytest.approx(distance.sum(), abs=1e-6) and plan.nearest.tolist() == nearest.tolist()
    assert not problem.obstacles.hit_by(plan.places[:-1], plan.places[1:]).any()


def test_next_plan_goes_on_with_the_last_one_or_better():
    problem = sine()
    plan = best_plan(problem, body_on(problem.lane))
    for _ in range(4):
        rest = plan.distance[4:].sum()
        again = best_plan(problem, plan.at(3), plan)
        assert again.distance[:28].sum() <= 1.3 * rest + 0.5  # the new last stage may be worth a little more before it
        plan = again


def test_obstacle_moved_into_the_way_is_passed_at_once():
    problem = sine()
    before = best_plan(problem, body_on(problem.lane))
    x, y = before.places[21]  # 1.8 s from where the plan is made
    moved = problem.with_obstacles([disc(x, y)])
    plan = best_plan(moved, before.at(3), before)
    assert plan.complete and not moved.obstacles.hit_by(plan.places[:-1], plan.places[1:]).any()


def test_costs_no_more_than_the_plain_reading_from_the_same_states():
    problem = sine(obstacles=(disc(13, 0.5), disc(27, 0.4), disc(38, 1.0)), inputs=7)
    now, plan, ours, plain = body_on(problem.lane), None, [], []
    for _ in range(8):
        plan = best_plan(problem, now, plan)
        ours.append(plan.cost)
        plain.append(plain_plan(problem, now).cost)
        now = plan.at(3)
    assert np.sum(ours) < np.sum(plain) and np.all(np.array(ours) < 1.05 * np.array(plain))


def test_mirrored_scene_has_the_mirrored_plan():
    one = scene([(0, 0), (20, 2), (40, -1), (60, 0)], (disc(18, 2.2),))
    other = scene([(0, 0), (20, -2), (40, 1), (60, 0)], (disc(18, -2.2),))
    first, second = (best_plan(problem, body_on(problem.lane)) for problem in (one, other))
    assert first.cost == pytest.approx(second.cost, rel=0.02)


def test_blocked_way_gives_the_furthest_plan_and_names_what_stops_it():
    problem = scene([(0, 0), (60, 0)], (wall((15, -40), (15, 40), name="fence"),))
    plan = best_plan(problem, body_on(problem.lane))
    assert not plan.complete and 4 <= len(plan.rates) < 10 and plan.cost == np.inf
    assert plan.reason.startswith("fence is in the way at x = 15.")


def test_way_back_to_the_path_is_never_overestimated():
    """Whatever a body does next adds at least what `still_to_come` says, which is worth something far from the path."""
    problem, random = scene([(0, 0), (60, 0)]), np.random.default_rng(3)
    span, one = BalanceRange.of(problem), body_on(problem.lane)
    bodies = Bodies(np.repeat(one.state, 400, 1), np.repeat(one.nearest, 400))
    for _ in range(3):
        low, high = span.rates(bodies)
        bodies = problem.stage(bodies, low + random.uniform(0, 1, 400) * (high - low)).last
    least, added = still_to_come(problem, bodies, 6), np.zeros(400)
    for _ in range(2):
        low, high = span.rates(bodies)
        stage = problem.stage(bodies, low + random.uniform(0, 1, 400) * (high - low))
        bodies, added = stage.last, added + stage.distance.sum(axis=0)
    assert (least <= added + 1e-9).all() and np.percentile(least / added, 90) > 0.2


def test_search_is_made_again_after_some_stages_and_where_the_plan_is_blocked():
    problem, now = sine(), body_on(sine().lane)
    ages, plan = [], None
    for _ in range(9):
        plan = best_plan(problem, now, plan)
        ages.append(plan.age)
        now = plan.at(3)
    assert ages[0] == 0 and max(ages) == 3 and ages.count(0) >= 2
    fresh = best_plan(problem, now, plan)
    x, y = fresh.places[22]
    walled = problem.with_obstacles([wall((x, y - 0.5), (x, y + 0.5))])
    assert best_plan(walled, now, plan).complete
