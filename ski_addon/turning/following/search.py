"""The search for the best plan: whole layers of nodes at once, then descent of the best ones to their optimum.

Like the paper's branch and bound [VP93 Fig. 14] it grows a tree of stages and clips what hits, falls or costs too
much. Different is what it tries, and in which order:

- Inputs are spread over the range that leaves the body a way to stay up (`BalanceRange`), so that no node is doomed.
- A layer is expanded at once. Of nodes in nearly the same state only the cheapest goes on (`cells`).
- The plan of the stage before, shifted by one stage and descended (`descend`) between the inputs of the grid, is the
  new plan as long as it is clear and nothing new comes into its way; every fourth stage, and where it is not, the
  search looks for another way.
- Its cost bounds that search. So does the way back to the path that a body has before it (`still_to_come`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...frames import Array
from .balance_range import BalanceRange
from .descent import Candidates, candidates_of, descend
from .dominance import cells, still_to_come
from .problem import Plan, Problem, violation
from .stepping import LEAN, Bodies, Stage

SPREAD = np.array([0.04, 0.3, 0.5, 0.7, 0.96])
"""Shares of the range of rates that a node tries."""
SLACK = 1.05, 0.2
"""A node is clipped beyond this multiple of the bound plus these metres: descent may still make it the best."""
ROUNDS_COLD, ROUNDS_WARM = 3, 1
"""Rounds of descent without and with a plan of the stage before."""
WIDE_EVERY = 4
"""The plan before is only descended, without a search, for so many stages less one, as long as it is clear."""
DEARER = 1.2, 1.0
"""A search is made at once where the plan costs this multiple of the one before plus these metres: something new is
in the way."""
GUESS = 1.5, 6.0
"""Where the plan before is blocked, one is looked for first below this multiple of its cost plus these metres."""
HIT = 1e3
"""What a last stage that hits or falls counts [m]: it is the last choice."""
FINENESS = 1.0, 2.0, 3.0
"""How fine states are told apart; the next is tried when nothing is found."""


@dataclass(frozen=True)
class _Layer:
    """Nodes of one stage: `bodies` at its end, `cost` (n,) [m] so far, index of the `parent` (n,) in the layer
    before, and the `share` (n,) of the range of rates that led here.
    """

    bodies: Bodies
    cost: Array
    parent: Array
    share: Array

    def some(self, index: Array) -> _Layer:
        """Return those of `index`."""
        return _Layer(self.bodies.some(index), self.cost[index], self.parent[index], self.share[index])


def best_plan(problem: Problem, now: Bodies, before: Plan | None = None, every: int = WIDE_EVERY) -> Plan:
    """Return the best plan found from `now` (one body); `before` is the one of which the first stage was ridden.

    A search is made `every` so many stages at least.
    """
    problem = problem.ahead(now)
    span = BalanceRange.of(problem)
    seed = _continued(span, now, before)
    known = None if seed is None else descend(span, now, seed[:, None], ROUNDS_WARM)
    if before is None or known is None:
        return _searched(span, now, [np.inf], None, ROUNDS_COLD)
    cost = float(known.cost[0])
    if before.age + 1 < every and cost < DEARER[0] * before.cost + DEARER[1]:
        return replace(known.plan(0, now, known.nodes), age=before.age + 1)
    if np.isfinite(cost):
        return _searched(span, now, [SLACK[0] * cost + SLACK[1]], known, ROUNDS_WARM)
    return _searched(span, now, [GUESS[0] * before.cost + GUESS[1], np.inf], known, ROUNDS_WARM)


def _searched(span: BalanceRange, now: Bodies, bounds: list[float], known: Candidates | None, rounds: int) -> Plan:
    """Return the best plan of a search of all that costs less than the first of `bounds` that leaves anything,
    descended `rounds` times; or that `known` before. If there is neither, states are told apart more finely.
    """
    nodes = 0 if known is None else known.nodes
    tries = [(bound, FINENESS[0]) for bound in bounds] + [(np.inf, fineness) for fineness in FINENESS[1:]]
    for bound, fineness in tries:
        layers, grown = _grown(span, now, bound, fineness)
        nodes += grown
        if len(layers) > span.problem.settings.stages:
            leaf = _traced(layers, int(np.argmin(layers[-1].cost)))
            found = descend(span, now, leaf[:, None], rounds)
            best = found if known is None or found.cost[0] < known.cost[0] else known
            return best.plan(0, now, nodes + found.nodes)
        if known is not None and np.isfinite(known.cost[0]):
            return known.plan(0, now, nodes)
    return _furthest(span, layers, nodes)


def _continued(span: BalanceRange, now: Bodies, before: Plan | None) -> Array | None:
    """Return the shares (stages,) of the plan `before` without its first stage and with the best new last one.

    None if there is no such plan, or `now` is not where it led. What is in its way is for the descent to go round.
    """
    settings, problem = span.problem.settings, span.problem
    if (
        before is None
        or not before.complete
        or not np.allclose(before.at(settings.samples).state, now.state, atol=1e-6)
    ):
        return None
    end = before.at(len(before.nearest) - 1)
    end = Bodies(np.repeat(end.state, len(SPREAD), 1), np.repeat(end.nearest, len(SPREAD)))
    low, high = span.rates(end)
    stage = problem.stage(end, low + SPREAD * (high - low))
    fell = ~(np.abs(stage.states[:, LEAN]) <= settings.lean_bound).all(axis=0)
    cost = stage.distance.sum(axis=0) + HIT * (fell | problem.touched(end, stage))
    return np.append(before.shares[1:], SPREAD[int(np.argmin(cost))])


def _grown(span: BalanceRange, now: Bodies, bound: float, fineness: float) -> tuple[list[_Layer], int]:
    """Return the layers of nodes below `bound`, the first is `now`, and how many nodes were expanded."""
    layers = [_Layer(now, np.zeros(1), np.zeros(1, dtype=int), np.zeros(1))]
    nodes = 0
    for stage in range(span.problem.settings.stages):
        nodes += len(layers[-1].cost)
        children = _expanded(span, layers[-1], stage + 1, bound)
        alive = _clear(span.problem, layers[-1].bodies, children, stage, fineness)
        if not len(alive.cost):
            break
        layers.append(alive)
    return layers, nodes


@dataclass(frozen=True)
class _Children:
    """Bodies after a `stage`: index of the `parent` (n,) each, and what `_Layer` has of it."""

    stage: Stage
    cost: Array
    parent: Array
    share: Array

    def some(self, index: Array) -> _Children:
        """Return those of `index`."""
        return _Children(self.stage.some(index), self.cost[index], self.parent[index], self.share[index])


def _expanded(span: BalanceRange, layer: _Layer, depth: int, bound: float) -> _Children:
    """Return the children of all nodes of `layer` that do not fall or cost too much."""
    problem = span.problem
    low, high = span.rates(layer.bodies)
    count, tries = len(layer.cost), len(SPREAD)
    rate = (low[:, None] + (high - low)[:, None] * SPREAD).ravel()
    parent, share = np.repeat(np.arange(count), tries), np.tile(SPREAD, count)
    stage = problem.stage(layer.bodies.some(parent), rate)
    cost = layer.cost[parent] + stage.distance.sum(axis=0)
    fine = np.abs(stage.states[:, LEAN]).max(axis=0) <= problem.settings.lean_bound
    if np.isfinite(bound):
        left = problem.settings.stages - depth
        fine &= cost + still_to_come(problem, stage.last, left * problem.settings.samples) < bound
    return _Children(stage, cost, parent, share).some(np.flatnonzero(fine))


def _clear(problem: Problem, before: Bodies, children: _Children, stage: int, fineness: float) -> _Layer:
    """Return the cheapest child of each cell among those that hit nothing.

    Only the cheapest of a cell are tested for hits, and where one hits the next cheapest, until nobody hits.
    """
    cell, order = cells(problem, children.stage.last, children.cost, stage, fineness)
    clear: list[Array] = []
    while len(order):
        first = np.concatenate(([True], cell[order[1:]] != cell[order[:-1]]))
        chosen = order[first]
        tested = children.some(chosen)
        hit = problem.touched(before.some(tested.parent), tested.stage)
        clear.append(chosen[~hit])
        if not hit.any():
            break
        order = order[~first]
        order = order[np.isin(cell[order], cell[chosen[hit]])]
    index = np.concatenate([np.zeros(0, dtype=int), *clear])
    return _Layer(children.stage.last.some(index), children.cost[index], children.parent[index], children.share[index])


def _traced(layers: list[_Layer], leaf: int) -> Array:
    """Return the shares (stages,) that lead to the node `leaf` of the last of `layers`."""
    shares = []
    for layer in reversed(layers[1:]):
        shares.append(float(layer.share[leaf]))
        leaf = int(layer.parent[leaf])
    return np.array(shares[::-1])


def _furthest(span: BalanceRange, layers: list[_Layer], nodes: int) -> Plan:
    """Return the incomplete plan to the best node of the last layer, with what stops everything after it."""
    now, leaf = layers[0].bodies, int(np.argmin(layers[-1].cost))
    found = candidates_of(span, now, _traced(layers, leaf)[:, None])
    reason = _stopper(span, layers[-1].bodies.some(np.array([leaf])))
    return replace(found.plan(0, now, nodes), cost=np.inf, complete=False, reason=reason)


def _stopper(span: BalanceRange, now: Bodies) -> str:
    """Return what meets the body that steers to the middle of its range from `now`."""
    low, high = span.rates(now)
    stage = span.problem.stage(now, 0.5 * (low + high))
    before = now.state[:, 0]
    for after in stage.states[:, :, 0]:
        reason = violation(span.problem, before, after)
        if reason:
            return reason
        before = after
    return "every rate of curvature within the bounds meets an obstacle or a bound"
