"""Instructions of a step, counted by valgrind: the same on a busy machine as on a quiet one.

One Python plans a short run and then parts in three (`fork`): one ends at once, one makes steps, one makes calibration
loops. Cachegrind counts each from the beginning, so the differences from the first are what the steps and loops took.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

from benchmarks.measuring import ROOT, RUNS, Measurement, NotMeasuredError, calibration

STEPS, LOOPS, WARM_UP = 40, 200, 20
SHORT = {"course.turn_count": 1, "course.turn_duration": 0.5}
TIMEOUT = 900.0
PARTS = ("nothing", "steps", "loops")


def instruction_rows() -> list[Measurement]:
    """Return the rows of instructions a step and a loop; raises `NotMeasuredError` without valgrind."""
    valgrind = shutil.which("valgrind")
    if valgrind is None:
        raise NotMeasuredError("valgrind is not here")
    with tempfile.TemporaryDirectory() as folder:
        command = [valgrind, "--tool=cachegrind", "--cache-sim=no", "--trace-children=yes"]
        command += [f"--cachegrind-out-file={folder}/count.%p", sys.executable, "-m", "benchmarks.instructions", folder]
        environment = os.environ | {"PYTHONHASHSEED": "0"}
        try:
            done = subprocess.run(
                command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=TIMEOUT, check=False
            )
        except subprocess.TimeoutExpired:
            raise NotMeasuredError(f"valgrind did not end within {TIMEOUT:.0f} s") from None
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
            raise NotMeasuredError(f"valgrind ended with code {done.returncode}: {last}")
        return rows(*(counted(Path(folder), part) for part in PARTS))


def counted(folder: Path, part: str) -> int:
    """Return how many instructions one of the three had made when it ended."""
    process = (folder / part).read_text()
    return total((folder / f"count.{process}").read_text())


def total(text: str) -> int:
    """Return the sum that cachegrind wrote."""
    found = re.search(r"^summary:\s*(\d+)", text, re.MULTILINE)
    if found is None:
        raise NotMeasuredError("valgrind wrote no sum")
    return int(found.group(1))


def rows(nothing: int, steps: int, loops: int) -> list[Measurement]:
    """Return the rows from what the three had counted."""
    step, loop = (steps - nothing) / STEPS, (loops - nothing) / LOOPS
    more: dict[str, Any] = {"unit": "k", "checked": False}
    return [
        Measurement("instructions", "a step", median=step / 1e3, p99=step / 1e3, n=STEPS, ratio=step / loop, **more),
        Measurement("instructions", "a calibration loop", median=loop / 1e3, p99=loop / 1e3, n=LOOPS, **more),
    ]


def main(folder: Path) -> None:
    """Plan, part in three, and wait for each."""
    from ski_addon.pipeline import make_plan, start_simulation
    from ski_addon.spec import RunSpec

    planned = make_plan(RunSpec.from_toml(RUNS / "paper_main.toml").with_overrides(SHORT))
    simulation = start_simulation(planned)
    simulation.advance(WARM_UP)
    calibration(10)
    work: dict[str, Callable[[], Any]] = {
        "nothing": int,
        "steps": lambda: simulation.advance(STEPS),
        "loops": lambda: calibration(LOOPS),
    }
    for part in PARTS:
        process = os.fork()
        if process == 0:
            (folder / part).write_text(str(os.getpid()))
            work[part]()
            os._exit(0)
        os.waitpid(process, 0)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
