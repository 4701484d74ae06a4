"""Small crowds that several tests look at."""

from __future__ import annotations

from typing import Any

import numpy as np

from ski_addon.crowd import CrowdSpec, MemberRun
from ski_addon.crowd.tracks import STEP, Way
from tests.ski_runs import preset

QUICK = {
    "course.turn_count": 3,
    "course.entry": "straight",
    "course.turn_duration": 0.3,
    "course.transition_duration": 0.4,
    "simulation.time_step": 0.004,
}
"""Two seconds of skiing that are simulated in about one."""


def crowd_of(count: int = 3, changes: dict[str, Any] | None = None, **run: Any) -> CrowdSpec:
    """A crowd on the paper's main run cut short; `changes` are keys of the crowd, `run` dotted keys of the run."""
    spec = preset("paper_main", QUICK | {key.replace("__", "."): value for key, value in run.items()})
    made = CrowdSpec((MemberRun(spec),), "Quick crowd")
    return made.with_values({"crowd.count": count, **(changes or {})})


def straight_way(speed: float = 5.0, duration: float = 10.0, across: float = 0.0) -> Way:
    """Somebody who skis straight down at `speed` [m/s], `across` [m/s] to the left."""
    time = np.arange(round(duration / STEP) + 1) * STEP
    return Way(np.stack((speed * time, across * time, 0.0 * time), axis=1), duration)
