"""Runs an example as its reader would: as a script, in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

EXAMPLES = Path(__file__).resolve().parents[2] / "docs" / "examples"


def run_example(name: str, *arguments: object) -> list[str]:
    """The lines that the example `name` prints; it must end well and say nothing else."""
    done = subprocess.run(
        [sys.executable, EXAMPLES / name, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ | {"PYTHONPATH": str(EXAMPLES.parents[1])},
        cwd=EXAMPLES,
    )
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout.splitlines()
