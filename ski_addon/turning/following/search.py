"""The search for the best plan: whole layers of nodes at once, then descent of the best ones to their optimum.

Like the paper's branch and bound [VP93 Fig. 14] it grows a tree of stages and clips what hits, falls or costs too
much. Different is what it tries, and in which order:

- Inputs are spread over the range that leaves the body a way to stay up (`BalanceRange`), so that no node is doomed.
- A layer is expanded at once. Of nodes in nearly the same state only the cheapest goes on (`kept`).
- The plan of the stage before, shifted by one stage, is a bound from the beginning: what costs much more is clipped.
- The best leaf and that plan are descended (`descend`) between the inputs of the grid.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...frames import Array
from .balance_range import BalanceRange
from .descent import candidates_of, descend
from .dominance import kept
from .problem import Plan, Problem, violation
from .stepping import LEAN, Bodies

SPREAD = np.array([0.04, 0.3, 0.5, 0.7, 0.96])
"""Shares of the range of rates that a node tries."""
SLACK = 1.05, 0.2
"""A node is clipped beyond this multiple of the bound plus these metres: descent may still make it the best."""
ROUNDS_COLD, ROUNDS_WARM = 3, 1
"""Rounds of descent without and with a plan of the stage before."""
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


def best_plan(problem: Problem, now: Bodies, before: Plan | None = None) -> Plan:
    """Return the best plan found from `now` (one body); `before` is the one of which the first stage was ridden."""
    problem = problem.ahead(now)
    span = BalanceRange.of(problem)
    warm = _continued(span, now, before)
    bound = np.inf if warm is None else SLACK[0] * warm.cost + SLACK[1]
    shares = [] if warm is None else [warm.shares]
    nodes = 0
    for fineness in FINENESS:
        layers, grown = _grown(span, now, bound, fineness)
        nodes += grown
        if len(layers) > problem.settings.stages:
            shares.append(_traced(layers, int(np.argmin(layers[-1].cost))))
        if shares:
            break
    else:
        return _furthest(span, layers, nodes)
    rounds = ROUNDS_COLD if warm is None else ROUNDS_WARM
    best = descend(span, now, np.array(shares).T, rounds)
    if warm is not None and warm.cost <= best.cost[0]:
        return replace(warm, nodes=nodes + best.nodes)
    return best.plan(0, now, nodes + best.nodes)


def _continued(span: BalanceRange, now: Bodies, before: Plan | None) -> Plan | None:
    """Return the plan `before` without its first stage and with the best new last one, or None if there is none."""
    settings, problem = span.problem.settings, span.problem
    if (
        before is None
        or not before.complete
        or not np.allclose(before.at(settings.samples).state, now.state, atol=1e-6)
    ):
        return None
    states, nearest, distance = (part[settings.samples :] for part in (before.states, before.nearest, before.distance))
    if problem.obstacles.hit_by(states[:-1, :2], states[1:, :2]).any():
        return None
    end = Bodies(np.repeat(states[-1][:, None], len(SPREAD), 1), np.repeat(nearest[-1:], len(SPREAD)))
    low, high = span.rates(end)
    rate = low + SPREAD * (high - low)
    stage = problem.stage(end, rate)
    fell = ~(np.abs(stage.states[:, LEAN]) <= settings.lean_bound).all(axis=0)
    cost = np.where(fell | problem.touched(end, stage), np.inf, stage.distance.sum(axis=0))
    best = int(np.argmin(cost))
    if not np.isfinite(cost[best]):
        return None
    distance = np.concatenate(([0.0], distance[1:], stage.distance[:, best]))
    return Plan(
        np.append(before.rates[1:], rate[best]),
        float(distance.sum()),
        np.concatenate((states, stage.states[:, :, best])),
        np.concatenate((nearest, stage.nearest[:, best])),
        distance,
        len(SPREAD),
        np.append(before.shares[1:], SPREAD[best]),
    )


def _grown(span: BalanceRange, now: Bodies, bound: float, fineness: float) -> tuple[list[_Layer], int]:
    """Return the layers of nodes below `bound`, the first is `now`, and how many nodes were expanded."""
    layers = [_Layer(now, np.zeros(1), np.zeros(1, dtype=int), np.zeros(1))]
    nodes = 0
    for stage in range(span.problem.settings.stages):
        nodes += len(layers[-1].cost)
        children = _expanded(span, layers[-1], bound)
        if not len(children.cost):
            break
        layers.append(children.some(kept(span.problem, children.bodies, children.cost, stage, fineness)))
    return layers, nodes


def _expanded(span: BalanceRange, layer: _Layer, bound: float) -> _Layer:
    """Return the children of all nodes of `layer` that are not clipped."""
    problem = span.problem
    low, high = span.rates(layer.bodies)
    count, tries = len(layer.cost), len(SPREAD)
    rate = (low[:, None] + (high - low)[:, None] * SPREAD).ravel()
    parent, share = np.repeat(np.arange(count), tries), np.tile(SPREAD, count)
    before = layer.bodies.some(parent)
    stage = problem.stage(before, rate)
    cost = layer.cost[parent] + stage.distance.sum(axis=0)
    fine = (np.abs(stage.states[:, LEAN]) <= problem.settings.lean_bound).all(axis=0) & (cost < bound)
    fine &= ~problem.touched(before, stage)
    return _Layer(stage.last, cost, parent, share).some(np.flatnonzero(fine))


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
