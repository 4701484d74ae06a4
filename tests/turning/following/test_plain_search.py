from __future__ import annotations

import itertools
import math

import numpy as np
import pytest

from ski_addon.turning.following import body_on, plain_plan
from ski_addon.turning.following.problem import rolled_out

from .following_scenes import disc, scene, sine, wall


def test_simulates_as_the_arrays_do():
    plan = plain_plan(sine(stages=8), body_on(sine().lane))
    assert plan.complete and plan.cost == pytest.approx(plan.distance.sum(), abs=1e-9)


def test_claim_12_finds_the_best_of_all_plans_of_a_small_grid():
    problem = sine(rate=0.3, obstacles=(disc(12.5, 0.0),), stages=4, inputs=5)
    now, best = body_on(problem.lane), math.inf
    for rates in itertools.product(problem.settings.rates(0.3), repeat=4):
        states, _, distance = rolled_out(problem, now, np.array(rates))
        track = states[:, :2]
        upright = np.abs(states[:, 3]).max() <= problem.settings.lean_bound
        if upright and np.abs(states[:, 5]).max() <= 0.3 and not problem.obstacles.hit_by(track[:-1], track[1:]).any():
            best = min(best, distance.sum())
    plan = plain_plan(problem, now)
    assert plan.complete and plan.cost == pytest.approx(best, abs=1e-9)
    assert plan.nodes < 5**3


def test_no_way_through_gives_the_furthest_plan_and_a_reason():
    problem = scene([(0, 0), (60, 0)], (wall((12, -40), (12, 40)),), stages=8, inputs=5)
    plan = plain_plan(problem, body_on(problem.lane))
    assert not plan.complete and plan.cost == math.inf and 0 < len(plan.rates) < 8
    assert plan.reason == "every input of the grid meets an obstacle or a bound"


def test_limit_of_nodes_ends_the_search():
    plan = plain_plan(sine(node_limit=5), body_on(sine().lane))
    assert not plan.complete and plan.nodes == 5 and plan.reason == "the limit of nodes was reached"


def test_claim_12_wide_range_of_rates_on_a_coarse_grid_leaves_only_straight_on():
    plan = plain_plan(sine(rate=0.5, stages=10, inputs=5), body_on(sine().lane))
    assert plan.complete and np.abs(plan.rates[:6]).max() == 0.0


@pytest.mark.parametrize(
    ("stages", "inputs", "fewest", "most"), [(10, 5, 250, 700), (10, 7, 1300, 4000), (12, 7, 2100, 7200)]
)
def test_claim_12_expands_few_of_all_nodes(stages, inputs, fewest, most):
    for rate in (0.2, 0.25, 0.3):
        plan = plain_plan(sine(rate=rate, stages=stages, inputs=inputs), body_on(sine().lane))
        assert plan.complete and fewest <= plan.nodes <= most < 1e-3 * inputs**stages
