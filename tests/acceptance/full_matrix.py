"""Every case that the paper's reproduction promises, in full: `python -m tests.acceptance.full_matrix [WORD ...]`.

Prints one line a case and a table's worth of numbers; exits with 1 when a bound is missed. Words choose cases whose
names contain one of them. Takes some minutes on two cores; `--list` only names the cases.
"""

from __future__ import annotations

import argparse
import multiprocessing
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from typing import Any

from ski_addon.errors import SkiAddonError
from ski_addon.pipeline import make_plan, run_simulation
from ski_addon.simulation import summarise
from ski_addon.spec import RunSpec, find_document, list_presets
from tests.acceptance.bounds import violations

WITH_FRICTION = {"paper_main": range(4, 13), "paper_r10": range(4, 10), "paper_r25": range(4, 13)}
WITH_FRICTION["paper_fig15"] = range(4, 13)
WITHOUT_FRICTION = {"paper_main": (0.5, 1.0), "paper_r25": (0.5, 1.0, 2.0, 3.0), "paper_fig15": (0.5, 1.0, 2.0, 3.0)}
COLUMNS = (
    ("status", "status", "{:>9}"),
    ("T s", "duration_s", "{:6.2f}"),
    ("v max", "speed_max", "{:6.2f}"),
    ("lean", "inclination_max_deg", "{:5.1f}"),
    ("edge", "edge_angle_max_deg", "{:5.1f}"),
    ("force", "snow_force_max_bw", "{:5.2f}"),
    ("ski max mm", "ski_error_max_m", "{:10.2f}"),
    ("rms", "ski_error_rms_m", "{:5.2f}"),
    ("com", "com_error_max_m", "{:5.2f}"),
    ("torque", "torque_ratio_max", "{:6.2f}"),
    ("margin", "joint_margin_min_deg", "{:6.2f}"),
    ("root N", "root_residual_max", "{:7.4f}"),
    ("iter", "solver_iterations_max", "{:5d}"),
    ("failed", "unconverged_steps", "{:6d}"),
)


@dataclass(frozen=True)
class Case:
    """A shipped run, its start speed [m/s] (None: as shipped), and whether snow and plan have friction."""

    preset: str
    speed: float | None
    friction: bool
    factor: float = 1.0

    @property
    def name(self) -> str:
        """What the table calls it."""
        speed = "" if self.speed is None else f" {self.speed:g} m/s"
        return f"{self.preset}{speed}{'' if self.friction else ' frictionless'}"

    @property
    def spec(self) -> RunSpec:
        """The run document."""
        changes: dict[str, Any] = {} if self.speed is None else {"course.start_speed": self.speed}
        if not self.friction:
            changes |= {"snow.friction": 0, "snow.friction_per_speed": 0}
        return RunSpec.from_toml(find_document(self.preset)).with_overrides(changes)


def cases() -> list[Case]:
    """All cases: the paper's four with friction and without, and other carved turns as shipped, to twice the bounds.

    Gates, paths, bumps and stops are in `tests/test_presets.py` and beside this file, with bounds of their own.
    """
    rough = [Case(name, float(speed), True) for name, speeds in WITH_FRICTION.items() for speed in speeds]
    smooth = [Case(name, speed, False) for name, speeds in WITHOUT_FRICTION.items() for speed in speeds]
    others = [preset for preset in list_presets("runs") if preset.identifier not in WITH_FRICTION]
    shipped = [preset.identifier for preset in others if _is_carved(RunSpec.from_toml(preset.path))]
    return [*rough, *smooth, *(Case(name, None, True, 2.0) for name in shipped)]


def _is_carved(spec: RunSpec) -> bool:
    turns = spec.course.kind == "turns" and spec.course.finish == "glide"
    return turns and spec.figure.kind == "alpine"


def run_case(case: Case) -> tuple[dict[str, Any], list[str]]:
    """Plan and simulate a case; return its summary and what it misses."""
    try:
        recording, seconds = run_simulation(make_plan(case.spec))
    except SkiAddonError as error:
        return {"status": "refused"}, [str(error)]
    summary = summarise(recording, seconds)
    return summary, violations(summary, case.factor)


def line(name: str, summary: dict[str, Any]) -> str:
    """One row of the table; lengths in millimetres."""
    cells = []
    for title, key, form in COLUMNS:
        if key not in summary:
            break
        value = summary[key] * 1000 if key.endswith("_m") else summary[key]
        cells.append(form.format(value).rjust(len(title)))
    return f"{name:32s} " + " ".join(cells)


def heading() -> str:
    """The table's first line."""
    sample = {key: "" if key == "status" else 0 for _, key, _ in COLUMNS}
    widths = [len(form.format(sample[key])) for _, key, form in COLUMNS]
    return f"{'case':32s} " + " ".join(title.rjust(width) for (title, _, _), width in zip(COLUMNS, widths, strict=True))


def main(arguments: list[str] | None = None) -> int:
    """Run the chosen cases and print the table; return 1 when anything is missed."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("words", nargs="*", help="run only cases whose names contain one of these")
    parser.add_argument("--list", action="store_true", help="only name the cases")
    options = parser.parse_args(arguments)
    chosen = [case for case in cases() if not options.words or any(word in case.name for word in options.words)]
    if options.list:
        print("\n".join(case.name for case in chosen))
        return 0
    begin, missed = time.perf_counter(), []
    print(heading(), flush=True)
    with ProcessPoolExecutor(os.cpu_count(), multiprocessing.get_context("spawn")) as pool:
        for case, (summary, wrong) in zip(chosen, pool.map(run_case, chosen), strict=True):
            print(line(case.name, summary), flush=True)
            missed += [f"{case.name}: {words}" for words in wrong]
    print(f"{len(chosen)} cases in {time.perf_counter() - begin:.0f} s; {len(missed)} bounds missed")
    print("\n".join(missed))
    return 1 if missed or not chosen else 0


if __name__ == "__main__":
    sys.exit(main())
