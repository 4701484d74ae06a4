"""Planning: `make_plan` of ten seconds, and its parts: `python -m benchmarks --only plan`."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import ExitStack
from typing import Any
from unittest.mock import patch

from benchmarks.measuring import CALIBRATION_ROUNDS, RUNS, How, Measurement, Samples, Spent, calibration, spent
from ski_addon import pipeline
from ski_addon.spec import RunSpec

SUBJECT = "plan"
DURATION = 10.0
TURNS = 5
PARTS = {
    "terrain": "build_terrain",
    "track": "build_track",
    "skier's model": "build_skier_model",
    "motion": "plan_motion",
}
"""Row and function of `ski_addon.pipeline`. One that is not there is left out of the table."""


def course() -> RunSpec:
    """Return the paper's main case with as many turns as take about ten seconds."""
    return RunSpec.from_toml(RUNS / "paper_main.toml").with_overrides({"course.turn_count": TURNS})


class PartTimer:
    """Times functions of the pipeline while plans are made: `took` by part, of the latest plan."""

    def __init__(self) -> None:
        self.took: dict[str, Spent] = {}

    def patches(self) -> ExitStack:
        """Return a context in which the parts are timed."""
        stack = ExitStack()
        for part, name in PARTS.items():
            if hasattr(pipeline, name):
                stack.enter_context(patch.object(pipeline, name, self._timed(part, getattr(pipeline, name))))
        return stack

    def _timed(self, part: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def timed(*args: Any, **more: Any) -> Any:
            found, self.took[part] = spent(lambda: function(*args, **more))
            return found

        return timed


def measurements(how: How) -> list[Measurement]:
    """Return the rows of planning, all for ten seconds of course."""
    spec = course()
    share = DURATION / pipeline.make_plan(spec).plan.duration
    whole, parts, timer = Samples(), {part: Samples() for part in PARTS}, PartTimer()
    with timer.patches():
        before = calibration(CALIBRATION_ROUNDS)
        for _ in range(how.rounds(7, 3)):
            _, took = spent(lambda: pipeline.make_plan(spec))
            after = calibration(CALIBRATION_ROUNDS)
            whole.add_spent([took], 0.5 * (before + after))
            for part, of_part in timer.took.items():
                parts[part].add_spent([of_part], 0.5 * (before + after))
            before = after
    rows = [whole.row(SUBJECT, "make_plan", "ms", share)]
    return rows + [
        samples.row(SUBJECT, part, "ms", share, checked=False) for part, samples in parts.items() if samples.seconds
    ]
