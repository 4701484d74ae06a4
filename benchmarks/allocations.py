"""What the stages of a step allocate, by passes of their own, for looking costs more time than the step.

`objects` are the small blocks of memory (Python objects) that are newly taken, counted from one instruction of Python
to the next, so what a compiled function takes and gives back within one call is not seen. `kib` is the most memory
[KiB] that a stage holds at once beyond what it found, arrays' data included.
"""

from __future__ import annotations

import sys
import tracemalloc
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from types import FrameType
from typing import Any

import numpy as np

from benchmarks.step import hook_stages
from ski_addon.pipeline import Planned, start_simulation

WHOLE = "whole step"


@dataclass(frozen=True)
class Allocated:
    """New small `objects` and the largest `kib` [KiB] held at once, in a call."""

    objects: float
    kib: float


class ObjectCounter:
    """Counts the small blocks that a call newly takes, instruction by instruction."""

    def __init__(self) -> None:
        self._count, self._last = 0, 0

    def count(self, function: Callable[[], Any]) -> tuple[Any, int]:
        """Return what the function returns, and the number of blocks it took."""
        self._count = 0
        before = sys.gettrace()
        sys.settrace(self._call)
        try:
            found = function()
        finally:
            sys.settrace(before)
        return found, self._count

    def _call(self, frame: FrameType, event: str, argument: Any) -> Any:
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        self._last = sys.getallocatedblocks()
        return self._look

    def _look(self, frame: FrameType, event: str, argument: Any) -> Any:
        now = sys.getallocatedblocks()
        if event == "opcode" and now > self._last:
            self._count += now - self._last
        self._last = now
        return self._look


def peak_kib(function: Callable[[], Any]) -> tuple[Any, float]:
    """Return what the function returns, and the most memory [KiB] it held; tracemalloc must be on."""
    before = tracemalloc.get_traced_memory()[0]
    tracemalloc.reset_peak()
    found = function()
    return found, (tracemalloc.get_traced_memory()[1] - before) / 1024.0


def step_allocations(planned: Planned, steps: int = 12, warm_up: int = 30) -> dict[str, Allocated]:
    """Return what each stage and the whole step allocate, medians of some steps."""
    counter = ObjectCounter()
    objects = _by_stage(planned, counter.count, steps, warm_up)
    tracemalloc.start()
    try:
        kib = _by_stage(planned, peak_kib, steps, warm_up)
    finally:
        tracemalloc.stop()
    return {stage: Allocated(objects[stage], kib[stage]) for stage in objects if stage in kib}


def _by_stage(
    planned: Planned, look: Callable[[Callable[[], Any]], tuple[Any, float]], steps: int, warm_up: int
) -> dict[str, float]:
    """Return medians by stage of what `look` sees in a step; the calls of a stage add up, nested ones count once."""
    staged, whole = start_simulation(planned), start_simulation(planned)
    rows: dict[str, list[float]] = defaultdict(list)
    seen: dict[str, float] = defaultdict(float)
    watching = _Watch(look, seen)
    hook_stages(staged, watching.wrap)
    for index in range(warm_up + steps):
        watching.on = index >= warm_up
        seen.clear()
        staged.step()
        if watching.on:
            for stage, amount in seen.items():
                rows[stage].append(amount)
            rows[WHOLE].append(look(whole.step)[1])
        else:
            whole.step()
    return {stage: float(np.median(values)) for stage, values in rows.items()}


class _Watch:
    """Wraps stages so that the outermost one is looked at."""

    def __init__(self, look: Callable[[Callable[[], Any]], tuple[Any, float]], seen: dict[str, float]) -> None:
        self._look, self._seen, self._inside, self.on = look, seen, False, False

    def wrap(self, stage: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def watched(*args: Any, **more: Any) -> Any:
            if self._inside or not self.on:
                return function(*args, **more)
            self._inside = True
            try:
                found, amount = self._look(lambda: function(*args, **more))
            finally:
                self._inside = False
            self._seen[stage] += amount
            return found

        return watched
