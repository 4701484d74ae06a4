"""What is to be solved: a body, a lane, obstacles and settings, and what a plan for it looks like."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from ...frames import Array
from ..body import TurningBody
from .lane import Lane
from .obstacles import Obstacle, Obstacles
from .settings import SearchSettings
from .stepping import CURVATURE, LEAN, Bodies, Stage, X, Y, ridden


@dataclass(frozen=True)
class Problem:
    """A `body` that is to follow a `lane` past `obstacles`, planned with `settings`."""

    body: TurningBody
    lane: Lane
    obstacles: Obstacles
    settings: SearchSettings = field(default_factory=SearchSettings)

    def with_obstacles(self, obstacles: list[Obstacle]) -> Problem:
        """Return the same problem with other obstacles."""
        return replace(self, obstacles=Obstacles.of(obstacles))

    @property
    def rate_bound(self) -> float:
        """Bound of the rate of curvature [1/m/s]."""
        return float(self.body.curvature_rate_bound)

    @property
    def curvature_bound(self) -> float:
        """Bound of the curvature [1/m]."""
        return float(self.body.curvature_bound)

    def ahead(self, now: Bodies) -> Problem:
        """Return the problem with only those obstacles that a plan from `now` can reach."""
        reach = 1.3 * float(self.lane.speed.max()) * (self.settings.horizon + self.settings.stage_time)
        return replace(self, obstacles=self.obstacles.near(now.state[:2, 0], reach))

    def stage(self, now: Bodies, rate: Array) -> Stage:
        """Return the next stage of bodies whose curvature changes by `rate` (n,) [1/m/s]."""
        settings = self.settings
        return ridden(self.body, self.lane, now, rate, settings.sample_time, settings.samples)

    def touched(self, now: Bodies, stage: Stage) -> Array:
        """Return whether the tracks of `stage` from `now` on touch an obstacle (n,)."""
        return self.obstacles.hit_by_tracks(np.concatenate((now.state[None, :2], stage.states[:, :2])))


@dataclass(frozen=True)
class Plan:
    """Rates of curvature for the stages to come and what they lead to.

    `rates` (k,) [1/m/s] of k stages, fewer than asked for if `complete` is false: then nothing was found that goes on,
    for the `reason` told. `cost` [m] is the sum of the samples' distances from the path [f_opt]. `states` (s + 1, 6)
    and `nearest` samples of the lane (s + 1,) are those at every sample, the first of them now, `distance` (s + 1,)
    [m] begins with 0. `shares` (k,) say where in its range each rate is (`BalanceRange`), `nodes` were expanded, `age`
    stages were ridden since a search.
    """

    rates: Array
    cost: float
    states: Array
    nearest: Array
    distance: Array
    nodes: int
    shares: Array = field(default_factory=lambda: np.zeros(0))
    complete: bool = True
    reason: str = ""
    age: int = 0

    @property
    def places(self) -> Array:
        """Places (s + 1, 2) [m] of the support."""
        return self.states[:, :2]

    def at(self, sample: int) -> Bodies:
        """Return the body at a sample."""
        return Bodies(self.states[sample][:, None], self.nearest[sample : sample + 1])


def rolled_out(problem: Problem, now: Bodies, rates: Array) -> tuple[Array, Array, Array]:
    """Return states, nearest samples and distances, as in `Plan`, of one body that rides `rates` (k,); not clipped."""
    states, nearest, distance = [now.state[:, 0][None]], [now.nearest], [np.zeros(1)]
    for rate in rates:
        stage = problem.stage(now, np.array([rate]))
        states.append(stage.states[:, :, 0])
        nearest.append(stage.nearest[:, 0])
        distance.append(stage.distance[:, 0])
        now = stage.last
    return np.concatenate(states), np.concatenate(nearest), np.concatenate(distance)


def violation(problem: Problem, before: Array, after: Array) -> str:
    """Return in words which bound or obstacle a body meets between two states (6,), or nothing."""
    settings = problem.settings
    hit = problem.obstacles.first_hit(before[None, :2], after[None, :2])
    if hit is not None:
        return f"{hit.name or hit.kind} is in the way at x = {after[X]:.1f}, y = {after[Y]:.1f}"
    if not abs(after[LEAN]) <= settings.lean_bound:
        return f"the lean would pass its bound of {np.degrees(settings.lean_bound):g} degrees"
    if abs(after[CURVATURE]) > problem.curvature_bound * (1.0 + 1e-9):
        return f"the curvature would pass its bound of {problem.curvature_bound:g} 1/m"
    return ""
