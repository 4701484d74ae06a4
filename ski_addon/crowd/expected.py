"""What a crowd would take, known before anything starts."""

from __future__ import annotations

import math

from ..spec.estimate import Estimate, estimate, show_bytes, show_duration
from .crowd_spec import CrowdSpec

BASE_BYTES = 150e6
"""Memory of a process before it records anything [bytes]: Python and its libraries."""
PEAK_BYTES_PER_STEP = 5000
"""Memory of one step while a recording is put together and written [bytes]."""
FILE_BYTES_PER_STEP = 1884
"""Size of one step in a recording's file [bytes]."""


def disk_bytes(crowd: CrowdSpec) -> float:
    """Return about how much the recordings of `crowd` take [bytes]."""
    return FILE_BYTES_PER_STEP * sum(one.steps for one in _expected(crowd))


def describe(crowd: CrowdSpec, jobs: int) -> str:
    """Return one clause for a message: how many ski how long, and what that takes of disk, memory and time."""
    members = _expected(crowd)
    seconds = sum(one.simulated_seconds for one in members)
    memory = BASE_BYTES + PEAK_BYTES_PER_STEP * max(one.steps for one in members)
    shared = min(jobs or 1, len(members))
    wall = max(sum(one.wall_seconds for one in members) / shared, max(one.wall_seconds for one in members))
    processes = f"{shared} process{'es' if shared > 1 else ''}"
    return (
        f"{len(members)} skiers, {show_duration(seconds)} of skiing, {show_bytes(disk_bytes(crowd))} of recordings, "
        f"{processes} of {show_bytes(memory)}, about {show_duration(math.ceil(wall))} to wait"
    )


def _expected(crowd: CrowdSpec) -> list[Estimate]:
    """Return what each member would take, as its run does."""
    each = {id(run): estimate(run.spec) for run in crowd.runs}
    return [each[id(crowd.run_of(index))] for index in range(crowd.crowd.count)]
