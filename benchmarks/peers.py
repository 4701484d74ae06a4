"""Other people's control steps, timed in the same run: `../shared/peers/run NAME` prints one line of JSON.

The folder is optional and no part of this project; `SKI_ADDON_PEERS` names another one. Every script in it times one
step of a skier like ours, in microseconds.
"""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from benchmarks.measuring import ROOT

VARIABLE = "SKI_ADDON_PEERS"
TIMEOUT = 900.0
"""Seconds for one script; the first use of one makes its environment."""


@dataclass(frozen=True)
class Entry:
    """A figure of a peer: the script that gives it, the path to it in the script's line, and its name in the table."""

    script: str
    path: tuple[str, ...]
    label: str


STEP = Entry("tsid", ("eiquadprog/6d", "total"), "TSID")
STAGES = {
    "assemble and solve": Entry("tsid", ("eiquadprog/6d", "total"), "TSID step"),
    "MuJoCo and dynamics": Entry(
        "floor", ("lean: kinematics+comPos+crb+comVel+rne+fullM+2 ski jac",), "MuJoCo's calls"
    ),
    "integrate": Entry("floor", ("mj_integratePos",), "mj_integratePos"),
}
"""What does the work of a stage of ours alone."""
OTHERS = (
    Entry("placo", ("6d/limits=True", "time"), "placo, with limits"),
    Entry("paper", ("piqp_sparse/nc=40", "total"), "the paper's stack"),
    Entry("floor", ("mj_step (Euler, no contact)",), "mj_step alone"),
)


class PeerError(Exception):
    """A peer did not give a figure; the text is one line that says which and why."""


@dataclass(frozen=True)
class Figure:
    """Median and 99th percentile [us] of `n` steps of a peer."""

    median: float
    p99: float
    n: int


@dataclass
class Peers:
    """The scripts of a folder, and the last line each has printed."""

    folder: Path
    lines: dict[str, dict[str, Any]] = field(default_factory=dict)

    def run(self, script: str) -> dict[str, Any]:
        """Run a script and return its line; raises `PeerError`."""
        command = [str(self.folder / "run"), script]
        try:
            done = subprocess.run(command, capture_output=True, text=True, timeout=TIMEOUT, check=False)
        except (OSError, subprocess.TimeoutExpired) as problem:
            raise PeerError(f"peer {script}: it did not run ({_one_line(problem)})") from None
        if done.returncode:
            last = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
            raise PeerError(f"peer {script}: it ended with code {done.returncode} ({_one_line(last)})")
        self.lines[script] = parse(script, done.stdout)
        return self.lines[script]


def find_peers(environment: Mapping[str, str] = os.environ) -> Peers | None:
    """Return the peers' folder, or None if there is none."""
    folder = Path(environment.get(VARIABLE) or ROOT.parent / "shared" / "peers")
    return Peers(folder) if os.access(folder / "run", os.X_OK) else None


def parse(script: str, text: str) -> dict[str, Any]:
    """Return the figures in the line that a script printed; raises `PeerError`."""
    lines = text.strip().splitlines()
    if not lines:
        raise PeerError(f"peer {script}: it printed nothing")
    try:
        found = json.loads(lines[-1])["res"]
    except (ValueError, TypeError, KeyError):
        raise PeerError(f'peer {script}: its line is not JSON with a "res": {lines[-1][:40]!r}') from None
    if not isinstance(found, dict):
        raise PeerError(f'peer {script}: its "res" is not a table')
    return found


def figure(found: dict[str, Any], entry: Entry) -> Figure:
    """Return one figure of a script's line; raises `PeerError` if it is not there."""
    value: Any = found
    for part in entry.path:
        value = value.get(part) if isinstance(value, dict) else None
    try:
        return Figure(float(value["med_us"]), float(value["p99_us"]), int(value["n"]))
    except (TypeError, KeyError, ValueError):
        raise PeerError(f"peer {entry.script}: its line has no time at {' > '.join(entry.path)}") from None


def _one_line(problem: object) -> str:
    return " ".join(str(problem).split())[:90]
