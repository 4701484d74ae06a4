"""The paper's search beside ours: `python -m benchmarks.path_search` prints the tables of docs/path_following.md.

Both follow the path of each example to its end, or as far as they come, in one run on one core. The plain reading has
the most obliging of several bounds of the rate of curvature, since its even grid of inputs depends on it; both look
as far ahead as the paper's larger case, 12 stages, and its smaller one, 10. Then both plan once from each of the same
states, and every example is replanned after an obstacle has been moved.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from benchmarks.measuring import CALIBRATION_ROUNDS, How, Measurement, Samples, Spent, calibration, spent
from ski_addon.course.drawn_points import distinct_points
from ski_addon.course.follow_problem import follow_problem
from ski_addon.spec import RunSpec, find_document
from ski_addon.terrain import build_terrain
from ski_addon.turning.body import TurningBody
from ski_addon.turning.following import Bodies, Followed, Plan, Problem, best_plan, follow, plain

SUBJECT = "path"
EXAMPLES = ("tree_skiing", "slalom_by_planning", "corner", "potholes")
RATES = (0.2, 0.3, 0.4)
"""Bounds of the rate of curvature [1/m/s] that the plain reading may choose from."""
INPUTS = 7
MOVES = (-0.4, 0.4)
"""How far aside the obstacle nearest to the way ahead is moved [m]."""


def example(name: str, stages: int = 10) -> Problem:
    """Return the problem of a preset, planned so many stages ahead."""
    spec = RunSpec.from_toml(find_document(name))
    problem, _ = follow_problem(spec, build_terrain(spec.slope), distinct_points(spec)[0])
    return replace(problem, settings=replace(problem.settings, inputs=INPUTS, stages=stages))


@dataclass(frozen=True)
class Run:
    """How a path was followed: what came of it, and what each plan took with the state it began from."""

    followed: Followed
    took: list[Spent]
    states: list[tuple[Bodies, Plan | None]]

    @property
    def seconds(self) -> np.ndarray:
        """Wall time of each plan (n,) [s]."""
        return np.array([one.wall for one in self.took])


def timed(problem: Problem, planner: Callable[[Problem, Bodies, Plan | None], Plan]) -> Run:
    """Follow the path of `problem` with a planner and a stop-watch."""
    took: list[Spent] = []
    states: list[tuple[Bodies, Plan | None]] = []

    def watched(problem: Problem, now: Bodies, before: Plan | None) -> Plan:
        plan, one = spent(lambda: planner(problem, now, before))
        took.append(one)
        states.append((now, before))
        return plan

    followed = follow(problem, planner=watched)
    return Run(followed, took, states)


def with_rate(problem: Problem, rate: float) -> Problem:
    """Return `problem` with another bound of the rate of curvature."""
    body = problem.body
    return replace(problem, body=TurningBody(body.leg_length, body.inertia, body.curvature_bound, rate))


def best_plain(problem: Problem) -> Run:
    """Return the plain run of the bound that comes furthest, at the lowest cost."""
    runs = [timed(with_rate(problem, rate), plain) for rate in RATES]
    return min(runs, key=lambda run: (bool(run.followed.reason), -run.followed.nearest[-1], run.followed.cost))


def line(name: str, label: str, run: Run) -> str:
    """Return a row of the table."""
    followed = run.followed
    end = "end" if not followed.reason else f"stopped at x = {followed.places[-1, 0]:.0f}"
    median, first = 1e3 * np.median(run.seconds), 1e3 * run.seconds[0]
    return (
        f"| {name} | {label} | {end} | {followed.nodes.mean():.0f} | {median:.1f} | {first:.0f} | "
        f"{run.seconds.sum():.2f} | {followed.cost:.1f} |"
    )


def moved(problem: Problem, plan: Plan, aside: float) -> Problem:
    """Return `problem` with the obstacle nearest to the middle of `plan` moved to the left by `aside` [m]."""
    middle = plan.places[len(plan.places) // 2 :]
    obstacles = list(problem.obstacles.all)
    gaps = [problem.with_obstacles([one]).obstacles.clearance(middle).min() for one in obstacles]
    nearest = int(np.argmin(gaps))
    obstacles[nearest] = obstacles[nearest].moved(np.array([0.0, aside]))
    return problem.with_obstacles(obstacles)


def replans(problem: Problem, run: Run) -> tuple[float, int, int]:
    """Return the median time [s] of plans after a move of an obstacle, how many there were, how many complete."""
    seconds, complete = [], 0
    for now, before in run.states[2::3]:
        if before is None or len(before.places) < 2:
            continue
        for aside in MOVES:
            other = moved(problem, before, aside)
            plan, one = spent(partial(best_plan, other, now, before))
            seconds.append(one.wall)
            complete += plan.complete
    return float(np.median(seconds)), len(seconds), complete


def from_same_states(problem: Problem, ours: Run) -> tuple[float, float, int, int]:
    """Return the sums of both searches' costs from our states, how often ours is no more, and of how many plans."""
    one, other, cheaper = 0.0, 0.0, 0
    count = 0
    for now, before in ours.states[::3]:
        mine, theirs = best_plan(problem, now, before), plain(problem, now)
        if mine.complete and theirs.complete:
            one, other, count = one + mine.cost, other + theirs.cost, count + 1
            cheaper += mine.cost <= theirs.cost + 1e-9
    return one, other, cheaper, count


def beside_plain(problem: Problem, run: Run, count: int = 6) -> tuple[Samples, Samples]:
    """Return samples of our plans and of plain ones, in turn from some of the same states."""
    ours, theirs = Samples(), Samples()
    obliging = with_rate(problem, RATES[0])
    for now, before in run.states[1 :: max(len(run.states) // count, 1)][:count]:
        for samples, planner in (
            (ours, partial(best_plan, problem, now, before)),
            (theirs, partial(plain, obliging, now)),
        ):
            samples.add_spent([spent(planner)[1]], calibration(CALIBRATION_ROUNDS))
    return ours, theirs


def measurements(how: How) -> list[Measurement]:
    """Return the rows of following paths, by plan; the peer is a plain reading of the paper's search."""
    rows = []
    for name in EXAMPLES[: how.rounds(2, 1)]:
        problem, samples = example(name), Samples()
        for _ in range(how.rounds(2, 1)):
            before = calibration(CALIBRATION_ROUNDS)
            run = timed(problem, best_plan)
            samples.add_spent(run.took, 0.5 * (before + calibration(CALIBRATION_ROUNDS)))
        more: dict[str, Any] = {}
        if not how.quick:
            ours, theirs = beside_plain(problem, run)
            more = {"peer": "plain search", "peer_ratio": ours.over(theirs)}
        rows.append(samples.row(SUBJECT, name.replace("_", " "), "ms", **more))
    return rows


def main() -> None:
    """Print the tables."""
    ours: dict[str, Run] = {}
    for stages in (12, 10):
        print(f"\nPlans of {stages} stages, {INPUTS} inputs:\n")
        print("| example | search | reached | nodes a stage | median [ms] | first [ms] | in all [s] | cost [m] |")
        print("|---|---|---|---|---|---|---|---|")
        for name in EXAMPLES:
            problem = example(name, stages)
            ours[name], theirs = timed(problem, best_plan), best_plain(problem)
            print(line(name, "plain reading", theirs), line(name, "ours", ours[name]), sep="\n", flush=True)
            ratio = np.median(theirs.seconds) / np.median(ours[name].seconds)
            in_all = theirs.seconds.sum() / ours[name].seconds.sum()
            cost = ours[name].followed.cost / theirs.followed.cost
            print(f"| {name} | ratio | | | {ratio:.1f} | | {in_all:.1f} | {cost:.2f} |")
    print("\n| example | same states: ours [m] | plain [m] | ours no more | moved: replan [ms] | complete |")
    print("|---|---|---|---|---|---|", flush=True)
    for name in EXAMPLES:
        problem = example(name)
        one, other, cheaper, count = from_same_states(problem, ours[name])
        median, plans, complete = replans(problem, ours[name])
        print(
            f"| {name} | {one:.1f} | {other:.1f} | {cheaper} of {count} | {1e3 * median:.1f} | {complete} of {plans} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
