"""Microseconds of a simulation step by stage: `python -m benchmarks.step [SPEC] [--steps N] [--json FILE]`.

Times are wall times of one thread. Machines differ and are shared, so a calibration loop (small matrix products and
plain Python, like the step itself) is timed in the same run; compare ratios to it, not microseconds. `python -m
benchmarks --only step` measures the step beside its peers, and its allocations.
"""

from __future__ import annotations

import argparse
import json
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.measuring import RUNS, calibration, percentiles
from ski_addon.pipeline import make_plan, start_simulation
from ski_addon.simulation import Simulation
from ski_addon.spec import RunSpec

PRESET = RUNS / "paper_main.toml"
STAGES = (
    ("reference look-up", "reference", "at"),
    ("MuJoCo and dynamics", "dynamics", "update"),
    ("read the reference", "controller.tasks.motion", "read"),
    ("sliding", "controller.slide", "apply"),
    ("balance", "controller.balance", "update"),
    ("balance", "controller.balance.observer", "commanded"),
    ("tasks", "controller.tasks", "follow"),
    ("assemble and solve", "controller.program", "solve"),
    ("pushes", "_pushes", "update"),
    ("forward dynamics", "dynamics", "accelerations"),
    ("integrate", "dynamics", "integrate"),
    ("record", "log", "add"),
)
"""Stage name, object within the simulation, method.

One that is not there, or is never called, is left out of the table; what it did is part of its caller or of the rest.
"""
REST = "everything else"
"""The step without its stages: what no stage names, and the timers themselves."""

Wrapper = Callable[[str, Callable[..., Any]], Callable[..., Any]]


def hook_stages(simulation: Simulation, wrap: Wrapper) -> set[str]:
    """Replace the method of every stage of `simulation` by `wrap(stage, method)`; return the stages that are there."""
    found = set()
    for stage, path, method in STAGES:
        owner: Any = simulation
        for part in path.split("."):
            owner = getattr(owner, part, None)
        function = getattr(owner, method, None)
        if function is not None:
            setattr(owner, method, wrap(stage, function))
            found.add(stage)
    return found


class StageTimer:
    """Replaces methods of a simulation by timed ones and collects seconds by stage; nested calls count once."""

    def __init__(self, simulation: Simulation) -> None:
        """Wrap every stage of `simulation`."""
        self.step: dict[str, float] = defaultdict(float)
        self._simulation, self._depth = simulation, 0
        self.stages = hook_stages(simulation, self._timed)

    def rows(self, steps: int) -> dict[str, list[float]]:
        """Make up to so many steps; return the seconds of each by stage, 0 where it was not called, and of the rest."""
        found: dict[str, list[float]] = {stage: [] for stage in (*self._order(), REST)}
        for _ in range(steps):
            self.step.clear()
            if not self._simulation.advance(1):
                break
            for stage in self.stages:
                found[stage].append(self.step[stage])
            found[REST].append(self._simulation.step_seconds[-1] - sum(self.step.values()))
        return found

    def _order(self) -> list[str]:
        return [stage for stage in dict.fromkeys(stage for stage, _, _ in STAGES) if stage in self.stages]

    def _timed(self, stage: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*args: Any, **more: Any) -> Any:
            self._depth += 1
            begin = perf_counter()
            try:
                return function(*args, **more)
            finally:
                self._depth -= 1
                if self._depth == 0:
                    self.step[stage] += perf_counter() - begin

        return timed


def measure(spec: RunSpec, steps: int, warm_up: int = 200) -> dict[str, Any]:
    """Return microseconds by stage (median, 99th percentile) over `steps` steps, with and without the stage timers.

    `planning_us` is what the whole plan took, by simulated step: the paper gives it so [SG19 sec. 7].
    """
    make_plan(spec)  # loads the libraries
    begin = perf_counter()
    planned = make_plan(spec)
    planning = 1e6 * (perf_counter() - begin) * spec.simulation.time_step / planned.plan.duration
    plain = start_simulation(planned)
    plain.advance(warm_up + steps)
    whole = np.array(plain.step_seconds[warm_up:]) * 1e6
    staged = start_simulation(planned)
    staged.advance(warm_up)
    rows = StageTimer(staged).rows(steps)
    stages = {name: percentiles(1e6 * np.array(seconds)) for name, seconds in rows.items() if any(seconds)}
    calibrated = calibration() * 1e6
    total = percentiles(whole)
    return {
        "steps": len(whole),
        "stages_us": stages,
        "step_us": total,
        "planning_us": planning,
        "calibration_us": calibrated,
        "step_over_calibration": total["median"] / calibrated,
    }


def table(result: dict[str, Any]) -> str:
    """Return the result as lines of text."""
    lines = [f"{'stage':24s}{'median us':>12s}{'p99 us':>10s}"]
    for stage, entry in result["stages_us"].items():
        lines.append(f"{stage:24s}{entry['median']:12.1f}{entry['p99']:10.1f}")
    whole = result["step_us"]
    lines.append(f"{'whole step':24s}{whole['median']:12.1f}{whole['p99']:10.1f}")
    lines.append(f"planning took {result['planning_us']:.1f} us for each of the run's steps")
    lines.append(
        f"calibration loop {result['calibration_us']:.2f} us; a step is {result['step_over_calibration']:.1f} x"
    )
    return "\n".join(lines)


def main() -> None:
    """Run the benchmark and print its table."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("spec", nargs="?", default=str(PRESET), help="run document (default: the paper's main case)")
    parser.add_argument("--steps", type=int, default=4000, help="steps to time")
    parser.add_argument("--json", help="also write the numbers to this file")
    arguments = parser.parse_args()
    result = measure(RunSpec.from_toml(arguments.spec), arguments.steps)
    print(table(result))
    if arguments.json:
        Path(arguments.json).write_text(json.dumps(result, indent=2) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
