"""A simulation as a generator, so that a window stays alive while it runs, and the state the sidebar shows."""

from __future__ import annotations

import time
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import bpy

from ..spec import RunSpec
from ..spec.estimate import show_duration

if TYPE_CHECKING:
    from ..simulation.recording import Recording

SLICE_SECONDS = 0.08
"""Time to compute between two looks at the window: long slices, because every look costs a redraw."""
REDRAW_SECONDS = 0.25
DRAWING_SHARE, LONGEST_PAUSE = 0.15, 2.0
"""Drawing takes at most this share of the time, as far as the sidebar is still drawn every so many seconds."""
STEPS = 20
"""Simulation steps between two looks at the clock."""

Job = Generator[tuple[float, str], bool, Any]
"""Yields (fraction, text); sending True asks it to stop; returns the recording, whole or partial (or what became of a
crowd).
"""


@dataclass
class Running:
    """What the sidebar shows of the job that runs now; `text` is empty while none does. Never saved."""

    fraction: float = 0.0
    text: str = ""


RUNNING = Running()


def simulation_job(spec: RunSpec, after: tuple[Recording, float] | None = None) -> Job:
    """Plan and simulate `spec` step by step; a stopped job returns the recording up to there.

    With `after` it goes on from that recording at that time [s]. Raises `PlanInfeasible` or `SpecError` on the first
    step.
    """
    stop = yield 0.0, "Planning"  # before anything that may fail or take long

    from ..pipeline import make_plan, resume_simulation, start_simulation

    planned = make_plan(spec)
    simulation = start_simulation(planned) if after is None else resume_simulation(planned, *after)
    while not stop and simulation.advance(STEPS):
        done = simulation.step_done * simulation.time_step
        stop = yield simulation.fraction, f"{done:.1f} of {planned.plan.duration:.1f} s skied"
    return simulation.recording()


def run_to_end(job: Job) -> Any:
    """Run a job without a window."""
    try:
        while True:
            next(job)
    except StopIteration as finished:
        return finished.value


class JobRunner:
    """Runs a job in slices from a modal operator's timer, and shows its progress at most four times a second.

    A job that is not `busy` only looks at what others do: a slice is one look.
    """

    def __init__(self, job: Job, context: bpy.types.Context, *, busy: bool = True) -> None:
        self._job = job
        self._busy = busy
        self._started = time.monotonic()
        self._drawn = self._left = 0.0
        self._pause = REDRAW_SECONDS
        self.result: Any = None
        window_manager = context.window_manager
        self._timer = window_manager.event_timer_add(0.01, window=context.window)
        window_manager.progress_begin(0, 100)
        next(job)
        self._show(context, 0.0, "Planning")

    def slice(self, context: bpy.types.Context) -> bool:
        """Compute for one slice; return True while there is more to do. The job's own errors pass through."""
        now = time.monotonic()
        if self._left and self._left - self._drawn < 0.01:  # it was drawn since the slice before
            self._pause = min(max(REDRAW_SECONDS, (now - self._left) / DRAWING_SHARE), LONGEST_PAUSE)
        until = now + (SLICE_SECONDS if self._busy else 0.0)
        try:
            fraction, text = next(self._job)
            while time.monotonic() < until:
                fraction, text = next(self._job)
        except StopIteration as finished:
            self.result = finished.value
            return False
        now = time.monotonic()
        if now - self._drawn >= self._pause:
            self._show(context, fraction, text + self._time_left(now, fraction))
        self._left = time.monotonic()
        return True

    def stop(self) -> None:
        """Ask the job to stop; its partial recording is the result (None if it had not started)."""
        try:
            self._job.send(True)
            self._job.close()
        except StopIteration as finished:
            self.result = finished.value

    def close(self, context: bpy.types.Context) -> None:
        """Take timer and progress away; needed however the job ends."""
        RUNNING.text, RUNNING.fraction = "", 0.0
        window_manager = context.window_manager
        window_manager.event_timer_remove(self._timer)
        window_manager.progress_end()
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        redraw_sidebars(context)

    def _show(self, context: bpy.types.Context, fraction: float, text: str) -> None:
        self._drawn = time.monotonic()
        RUNNING.fraction, RUNNING.text = fraction, text
        context.window_manager.progress_update(int(100 * fraction))
        if context.workspace is not None:
            context.workspace.status_text_set(f"Ski: {text}   |   Esc: stop and keep what is done")
        redraw_sidebars(context)

    def _time_left(self, now: float, fraction: float) -> str:
        elapsed = now - self._started
        if fraction < 0.02 or elapsed < 0.5:
            return ""
        return f", {show_duration(max(1, round(elapsed * (1.0 - fraction) / fraction)))} left"


def redraw_sidebars(context: bpy.types.Context) -> None:
    """Ask for a redraw of the sidebars of all 3D views, and of nothing else."""
    for region in _sidebars(context):
        region.tag_redraw()


def _sidebars(context: bpy.types.Context) -> Iterator[Any]:
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "VIEW_3D":
                yield from (region for region in area.regions if region.type == "UI")
