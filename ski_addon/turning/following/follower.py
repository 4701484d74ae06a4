"""Following: plan ahead, ride the first stage, plan again [VP93 sec. 6.1]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from ...frames import Array
from .plain_search import plain_plan
from .problem import Plan, Problem
from .search import best_plan
from .stepping import Bodies, body_on, ridden

MORE_STAGES = 0, 3
"""How many stages further the second and third attempt look ahead."""

Planner = Callable[[Problem, Bodies, Plan | None], Plan]
"""From a problem, where the body is and the plan before to the plan from here on."""


@dataclass(frozen=True)
class Followed:
    """What a body that followed a path did; read-only arrays over n samples.

    `time` (n,) [s]; `states` (n, 6) by rows of `stepping`; `nearest` samples of the lane (n,); `distance` (n,) [m] from
    them; `rates` (k,) [1/m/s] of the stages ridden. `reason` is empty if the path's end was reached; else it says what
    stopped the body at its last place. `nodes` (k,) were expanded for each stage.
    """

    time: Array
    states: Array
    nearest: Array
    distance: Array
    rates: Array
    nodes: Array
    reason: str = ""

    def __post_init__(self) -> None:
        for value in vars(self).values():
            if isinstance(value, np.ndarray):
                value.setflags(write=False)

    @property
    def places(self) -> Array:
        """Places (n, 2) [m] of the support."""
        return self.states[:, :2]

    @property
    def cost(self) -> float:
        """Sum of the distances from the path [m], as the plans count it."""
        return float(self.distance.sum())


def plain(problem: Problem, now: Bodies, before: Plan | None = None) -> Plan:
    """Plan as the paper does, which makes nothing of the plan before."""
    return plain_plan(problem, now)


def follow(problem: Problem, start: Bodies | None = None, planner: Planner = best_plan) -> Followed:
    """Return how a body follows the path of `problem` from `start` (default: upright, at its beginning and along it).

    Where no plan reaches as far as asked for, the one that comes furthest is ridden on, in case a way opens up. The
    motion ends at the furthest place along the path if not even one more stage can be ridden, or if the body has come
    no further for as long as a plan looks ahead.
    """
    now = body_on(problem.lane) if start is None else start
    lane, settings = problem.lane, problem.settings
    states, nearest, distance = [now.state[:, 0][None]], [now.nearest], [np.zeros(1)]
    rates: list[float] = []
    nodes: list[int] = []
    plan, reason, furthest, since = None, "", -1, 0
    while now.nearest[0] < lane.path.last and not reason:
        furthest, since = max((int(now.nearest[0]), len(nodes)), (furthest, since))
        plan = planner(problem, now, plan)
        nodes.append(plan.nodes)
        if not len(plan.rates):
            reason = plan.reason
        elif len(nodes) - since > settings.stages:
            reason = _turned_back(problem, furthest)
        else:
            ridden = slice(1, settings.samples + 1)
            states.append(plan.states[ridden])
            nearest.append(plan.nearest[ridden])
            distance.append(plan.distance[ridden])
            rates.append(float(plan.rates[0]))
            now = plan.at(settings.samples)
    reached = np.concatenate(nearest)
    end = int(np.argmax(reached >= (reached.max() if reason else lane.path.last))) + 1
    every, apart = np.concatenate(states)[:end], np.concatenate(distance)[:end]
    time = settings.sample_time * np.arange(end)
    taken = np.array(rates[: -(-(end - 1) // settings.samples)], dtype=float)
    return Followed(time, every, reached[:end], apart, taken, np.array(nodes), reason)


def follow_to_the_end(problem: Problem, start: Bodies | None = None) -> Followed:
    """Return how a body follows the path of `problem`, as `follow` does.

    Where that ends early it is tried again with a search at every stage, then with plans that look further ahead; the
    first that comes to the end is returned, or the one that comes furthest.
    """
    found = [follow(problem, start)]
    for more in MORE_STAGES:
        if not found[-1].reason:
            return found[-1]
        longer = replace(problem, settings=replace(problem.settings, stages=problem.settings.stages + more))
        found.append(follow(longer, start, partial(best_plan, every=1)))
    return max(found, key=lambda followed: (not followed.reason, followed.nearest[-1]))


def _turned_back(problem: Problem, furthest: int) -> str:
    """Return in words what is in the way of a body that comes no further along the path than to a sample."""
    places = problem.lane.path.places[furthest:]
    across = problem.obstacles.first_hit(places[:-1], places[1:])
    x, y = places[0]
    what = "the bounds leave no way on" if across is None else f"{across.name or across.kind} is in the way"
    return f"{what} at x = {x:.1f}, y = {y:.1f}"


def between_samples(problem: Problem, followed: Followed, rate: float = 100.0) -> tuple[Array, Array, Array]:
    """Return time (n,) [s], states (n, 6) and speed (n,) [m/s] of a motion at about `rate` moments a second.

    All stages are integrated again side by side, from their first samples on.
    """
    lane, settings = problem.lane, problem.settings
    fine = max(round(rate * settings.sample_time), 1)
    begins = np.arange(len(followed.rates)) * settings.samples
    bodies = Bodies(np.ascontiguousarray(followed.states[begins].T), followed.nearest[begins])
    step, count = settings.sample_time / fine, fine * settings.samples
    stage = ridden(problem.body, lane, bodies, followed.rates, step, count)
    states = np.concatenate((followed.states[:1], stage.states.transpose(2, 0, 1).reshape(-1, 6)))
    nearest = np.concatenate((followed.nearest[:1], stage.nearest.T.ravel()))
    size = (len(followed.time) - 1) * fine + 1
    return step * np.arange(size), states[:size], lane.speed[nearest[:size]]
