"""Branch and bound as the paper prints it, one node at a time [VP93 Fig. 13, Fig. 14]; kept to compare with.

The queue is ordered by f_opt, the least first; every input of the even grid is simulated for one stage; children are
clipped that hit an obstacle, fall, or exceed the best complete path. Plain numbers throughout: for one node at a time
they are quicker than arrays.
"""

from __future__ import annotations

import heapq
import itertools
import math
from dataclasses import dataclass

import numpy as np

from .problem import Plan, Problem, rolled_out
from .stepping import Bodies

Node = tuple[float, float, float, float, float, float]
"""x, y, heading, lean, rate of lean, curvature."""


def plain_plan(problem: Problem, now: Bodies) -> Plan:
    """Return the best plan on the grid of inputs from `now` (one body), or the furthest one if none is complete."""
    search = _PlainSearch.of(problem, now)
    start: Node = tuple(float(value) for value in now.state[:, 0])  # type: ignore[assignment]
    order = itertools.count()
    queue: list[tuple[float, int, Node, int, tuple[float, ...]]] = [(0.0, 0, start, int(now.nearest[0]), ())]
    best: tuple[float, ...] = ()
    furthest: tuple[float, ...] = ()
    bound, expanded = math.inf, 0
    stages = problem.settings.stages
    while queue and expanded < problem.settings.node_limit:
        cost, _, node, hint, taken = heapq.heappop(queue)
        if cost >= bound:
            break  # all others cost more
        expanded += 1
        for rate in search.inputs:
            child = search.simulated(node, rate, hint, cost, bound)
            if child is None:
                continue
            reached, total, near = child
            path = (*taken, rate)
            if len(path) == stages:
                if total < bound:
                    bound, best = total, path
                continue
            if len(path) > len(furthest):
                furthest = path
            heapq.heappush(queue, (total, -next(order), reached, near, path))
    rates = np.array(best or furthest, dtype=float)
    complete = bool(best)
    reason = "" if complete else _reason(queue)
    cost = bound if complete else math.inf
    return Plan(rates, cost, *rolled_out(problem, now, rates), expanded, complete=complete, reason=reason)


def _reason(queue: list) -> str:
    return "the limit of nodes was reached" if queue else "every input of the grid meets an obstacle or a bound"


@dataclass(frozen=True)
class _PlainSearch:
    """A problem as plain numbers."""

    length: float
    effective: float
    inputs: tuple[float, ...]
    curvature_bound: float
    lean_bound: float
    step: float
    samples: int
    path: list[tuple[float, float]]
    speed: list[float]
    passed: list[float]
    normal: list[float]
    pull: list[tuple[float, float]]
    back: int
    ahead: int
    segments: list[tuple[float, float, float, float, float]]

    @classmethod
    def of(cls, problem: Problem, now: Bodies) -> _PlainSearch:
        body, lane, settings = problem.body, problem.lane, problem.settings
        near = problem.ahead(now).obstacles
        back, window, _ = lane.window
        length = float(body.leg_length)
        return cls(
            length,
            length + float(body.inertia) / length,
            tuple(settings.rates(problem.rate_bound).tolist()),
            problem.curvature_bound * (1.0 + 1e-9),
            settings.lean_bound,
            settings.sample_time,
            settings.samples,
            [(float(x), float(y)) for x, y in lane.path.places],
            lane.speed.tolist(),
            (settings.sample_time * lane.samples_per_second).tolist(),
            lane.normal.tolist(),
            [(float(x), float(y)) for x, y in lane.pull],
            back,
            window.shape[1] - back,
            [
                (float(begin[0]), float(begin[1]), float(end[0]), float(end[1]), float(reach))
                for begin, end, reach in zip(near.begin, near.end, near.reach, strict=True)
            ],
        )

    def simulated(
        self, node: Node, rate: float, hint: int, cost: float, bound: float
    ) -> tuple[Node, float, int] | None:
        """Return the node after one stage with its cost and nearest sample, or None if it is clipped."""
        if abs(node[5] + self.samples * self.step * rate) > self.curvature_bound:
            return None
        step, last = self.step, len(self.path) - 1
        at = min(hint + int(0.5 * self.passed[hint] * self.samples), last)
        ground = self.speed[at], self.normal[at], *self.pull[at]
        begin, begun = node, hint
        for k in range(self.samples):
            after = self.stepped(node, rate, begin, k * step, ground)
            if self.hits(node[0], node[1], after[0], after[1]) or not abs(after[3]) <= self.lean_bound:
                return None
            hint, distance = self.nearest(after[0], after[1], min(begun + int(self.passed[begun] * (k + 1)), last))
            cost += distance
            if cost >= bound:
                return None
            node = after
        return node, cost, hint

    def stepped(
        self, node: Node, rate: float, begin: Node, since: float, ground: tuple[float, float, float, float]
    ) -> Node:
        """Return the node one sample later, `since` [s] after the stage's `begin`; the formulas of `motion_after`."""
        x, y, heading, lean, lean_rate, curve = node
        step, length = self.step, self.length
        speed, normal, down, left = ground
        half = 0.5 * step
        pulls = [0.0, 0.0, 0.0]
        if down or left:
            for k in range(3):
                time = since + k * half
                turned = begin[2] + speed * time * (begin[5] + 0.5 * time * rate)
                pulls[k] = left * math.cos(turned) - down * math.sin(turned)
        curve_mid, curve_end = curve + half * rate, curve + step * rate
        first, pace = self._lean(lean, curve, speed, normal, pulls[0])
        lean_mid = lean + half * (lean_rate + 0.5 * half * first)
        second, pace_mid = self._lean(lean_mid, curve_mid, speed, normal, pulls[1])
        third, _ = self._lean(lean + step * (lean_rate + half * second), curve_end, speed, normal, pulls[2])
        lean_end = lean + step * (lean_rate + step / 6.0 * (first + 2.0 * second))
        pace_end = speed / (1.0 - curve_end * length * math.sin(lean_end))
        turn, turn_mid, turn_end = curve * pace, curve_mid * pace_mid, curve_end * pace_end
        middle = heading + step / 24.0 * (5.0 * turn + 8.0 * turn_mid - turn_end)
        end = heading + step / 6.0 * (turn + 4.0 * turn_mid + turn_end)
        share = step / 6.0
        return (
            x + share * (pace * math.cos(heading) + 4.0 * pace_mid * math.cos(middle) + pace_end * math.cos(end)),
            y + share * (pace * math.sin(heading) + 4.0 * pace_mid * math.sin(middle) + pace_end * math.sin(end)),
            end,
            lean_end,
            lean_rate + share * (first + 4.0 * second + third),
            curve_end,
        )

    def _lean(self, lean: float, curve: float, speed: float, normal: float, across: float) -> tuple[float, float]:
        """Return acceleration of the lean and speed of the support."""
        sine, cosine = math.sin(lean), math.cos(lean)
        radius_share = 1.0 - curve * self.length * sine
        steering = curve * speed * speed * cosine / radius_share
        return (normal * sine + across * cosine - steering) / self.effective, speed / radius_share

    def nearest(self, x: float, y: float, hint: int) -> tuple[int, float]:
        """Return index and distance of the nearest sample of the path about `hint`."""
        low = max(hint - self.back, 0)
        best, at = math.inf, low
        for index, (px, py) in enumerate(self.path[low : hint + self.ahead], low):
            square = (px - x) * (px - x) + (py - y) * (py - y)
            if square < best:
                best, at = square, index
        return at, math.sqrt(best)

    def hits(self, ax: float, ay: float, bx: float, by: float) -> bool:
        """Return whether the track from a to b touches an obstacle."""
        return any(_gap(ax, ay, bx, by, *wall[:4]) <= wall[4] for wall in self.segments if _near(ax, ay, bx, by, wall))


def _near(ax: float, ay: float, bx: float, by: float, wall: tuple[float, float, float, float, float]) -> bool:
    """Return whether boxes round two segments overlap."""
    cx, cy, dx, dy, reach = wall
    return (
        (ax if ax > bx else bx) + reach >= (cx if cx < dx else dx)
        and (ax if ax < bx else bx) - reach <= (cx if cx > dx else dx)
        and (ay if ay > by else by) + reach >= (cy if cy < dy else dy)
        and (ay if ay < by else by) - reach <= (cy if cy > dy else dy)
    )


def _gap(ax: float, ay: float, bx: float, by: float, cx: float, cy: float, dx: float, dy: float) -> float:
    """Return the distance of the segments a-b and c-d."""
    if (cx, cy) == (dx, dy):
        return _to_segment(cx, cy, ax, ay, bx, by)
    one = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    two = (bx - ax) * (dy - ay) - (by - ay) * (dx - ax)
    three = (dx - cx) * (ay - cy) - (dy - cy) * (ax - cx)
    four = (dx - cx) * (by - cy) - (dy - cy) * (bx - cx)
    if one * two < 0.0 and three * four < 0.0:
        return 0.0
    return min(
        _to_segment(ax, ay, cx, cy, dx, dy),
        _to_segment(bx, by, cx, cy, dx, dy),
        _to_segment(cx, cy, ax, ay, bx, by),
        _to_segment(dx, dy, ax, ay, bx, by),
    )


def _to_segment(px: float, py: float, ax: float, ay: float, bx: float, by: float) -> float:
    ux, uy = bx - ax, by - ay
    square = ux * ux + uy * uy
    share = ((px - ax) * ux + (py - ay) * uy) / square if square > 0.0 else 0.0
    share = 0.0 if share < 0.0 else 1.0 if share > 1.0 else share
    return math.hypot(px - ax - share * ux, py - ay - share * uy)
