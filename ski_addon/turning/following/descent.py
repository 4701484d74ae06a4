"""Descent of plans to the nearest optimum, between the inputs of any grid.

A plan is written as its shares of the range of rates, stage by stage (`BalanceRange`). In these numbers the unstable
pendulum is tame: any shares keep the body up, and the last sample feels the first stage no more than it should.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...frames import Array
from .balance_range import BalanceRange
from .problem import Plan, Problem
from .stepping import LEAN, Bodies, Stage, X, Y

PROBE = 0.02
"""By how much a share is varied to see what it does."""
MARGIN = 0.12
"""Room [m] beyond the tolerance of obstacles that the descent aims at; nearer is allowed."""
PUSH = 6.0
"""Weight of a metre into that room against a metre off the path."""
SOFT = 0.08
"""Offsets [m] below which the sum of distances is taken as quadratic."""
DAMPING = np.array([0.03, 0.3, 3.0, 30.0])
STEPS = np.array([1.0, 0.5])


@dataclass(frozen=True)
class Candidates:
    """Plans side by side: `shares` and `rates` (k, n) of k stages, `cost` (n,) [m], infinite if it hits or falls.

    `stages` are what they lead to; `nodes` counts the stages simulated.
    """

    shares: Array
    rates: Array
    cost: Array
    stages: tuple[Stage, ...]
    nodes: int

    def chosen(self, index: int) -> Candidates:
        """Return one of the plans."""
        one = slice(index, index + 1)
        stages = tuple(stage.some(one) for stage in self.stages)
        return Candidates(self.shares[:, one], self.rates[:, one], self.cost[one], stages, self.nodes)

    def plan(self, index: int, now: Bodies, nodes: int) -> Plan:
        """Return one of them as the plan from `now` for which `nodes` were expanded."""
        return Plan(
            self.rates[:, index],
            float(self.cost[index]),
            np.concatenate([now.state[:, 0][None], *(stage.states[:, :, index] for stage in self.stages)]),
            np.concatenate([now.nearest, *(stage.nearest[:, index] for stage in self.stages)]),
            np.concatenate([[0.0], *(stage.distance[:, index] for stage in self.stages)]),
            nodes,
            self.shares[:, index],
        )


def candidates_of(span: BalanceRange, now: Bodies, shares: Array, *, clipped: bool = True) -> Candidates:
    """Return the plans of `shares` (k, n) from `now` (one body); unless `clipped`, hits and falls are let through."""
    problem, count = span.problem, shares.shape[1]
    rates, stages = np.empty_like(shares), []
    bodies = Bodies(np.repeat(now.state, count, 1), np.repeat(now.nearest, count))
    cost = np.zeros(count)
    for index, share in enumerate(shares):
        low, high = span.rates(bodies)
        rates[index] = low + share * (high - low)
        stage = problem.stage(bodies, rates[index])
        cost += stage.distance.sum(axis=0)
        stages.append(stage)
        bodies = stage.last
    if clipped:
        states = np.concatenate((np.repeat(now.state[None], count, 2), *(stage.states for stage in stages)))
        fell = ~(np.abs(states[:, LEAN]).max(axis=0) <= problem.settings.lean_bound)
        cost[fell | problem.obstacles.hit_by_tracks(states[:, [X, Y]])] = np.inf
    return Candidates(shares, rates, cost, tuple(stages), len(shares) * count)


def descend(span: BalanceRange, now: Bodies, shares: Array, rounds: int) -> Candidates:
    """Return the best plan found by descending `rounds` times from each of the plans `shares` (k, n)."""
    count, nodes = shares.shape[1], 0
    best: Candidates | None = None
    for _ in range(rounds):
        probes = [_probed(shares[:, i]) for i in range(count)]
        found = candidates_of(span, now, np.concatenate(probes, axis=1), clipped=False)
        misfit, weight = _misfit(span.problem, found)
        tries = [shares]
        for i, probe in enumerate(probes):
            at = i * probe.shape[1]
            varied = slice(at + 1, at + probe.shape[1])
            slope = (misfit[:, varied] - misfit[:, at : at + 1]) / np.diagonal(probe[:, 1:] - probe[:, :1])
            tries.append(_steps(shares[:, i], slope, misfit[:, at], weight[:, at]))
        reached = candidates_of(span, now, np.concatenate(tries, axis=1))
        nodes += found.nodes + reached.nodes
        each = tries[-1].shape[1]
        groups = [[i, *range(count + i * each, count + (i + 1) * each)] for i in range(count)]
        winners = [group[int(np.argmin(reached.cost[group]))] for group in groups]
        shares = reached.shares[:, winners]
        chosen = min(winners, key=lambda winner: reached.cost[winner])
        if best is None or reached.cost[chosen] < best.cost[0]:
            best = reached.chosen(chosen)
    if best is None:
        raise ValueError("there is nothing to descend without a round")
    return replace(best, nodes=nodes)


def _probed(shares: Array) -> Array:
    """Return `shares` (k,) and each of them varied by itself (k, k + 1)."""
    varied = np.repeat(shares[:, None], len(shares) + 1, axis=1)
    varied[range(len(shares)), range(1, len(shares) + 1)] += np.where(shares > 0.5, -PROBE, PROBE)
    return varied


def _misfit(problem: Problem, found: Candidates) -> tuple[Array, Array]:
    """Return offsets from the path and depths in the room of obstacles (r, n) [m], and their weights (r, n)."""
    path = problem.lane.path
    state = np.concatenate([stage.states for stage in found.stages])  # (s, 6, n)
    at = np.concatenate([stage.nearest for stage in found.stages])
    x, y, along = state[:, X] - path.places[at, 0], state[:, Y] - path.places[at, 1], path.heading[at]
    offset = y * np.cos(along) - x * np.sin(along)
    weight = 1.0 / np.maximum(np.abs(offset), SOFT)
    if not len(problem.obstacles):
        return offset, weight
    places = state[:, :2].transpose(0, 2, 1)
    room = problem.obstacles.clearance(places.reshape(-1, 2)).reshape(offset.shape)
    depth = np.maximum(MARGIN - room, 0.0)
    return np.concatenate((offset, depth)), np.concatenate((weight, np.full_like(depth, PUSH / MARGIN)))


def _steps(shares: Array, slope: Array, misfit: Array, weight: Array) -> Array:
    """Return shares (k, m) of m steps of different boldness down the slope (r, k) of `misfit` (r,)."""
    weighted = slope * weight[:, None]
    normal, down = slope.T @ weighted, -(weighted.T @ misfit)
    scale = float(np.trace(normal)) / len(shares) + 1e-9
    damped = normal + scale * DAMPING[:, None, None] * np.eye(len(shares))
    steps = np.linalg.solve(damped, np.broadcast_to(down[:, None], (len(DAMPING), len(shares), 1)))[..., 0]
    found = shares + (STEPS[:, None, None] * steps).reshape(-1, len(shares))
    return np.clip(found.T, 0.0, 1.0)
