"""Simulate: let the skier ski the track by physics."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import bpy

from ..ski_addon.blender.cache import save_recording
from ..ski_addon.blender.jobs import RUNNING, JobRunner, run_to_end, simulation_job
from ..ski_addon.blender.properties import is_skier, read_spec, tell
from ..ski_addon.blender.shown import required_skier
from ..ski_addon.blender.words import ending, recording_lines
from ..ski_addon.errors import SkiAddonError, SpecError
from ..ski_addon.spec import RunSpec, estimate
from .failing import Failed, reported


class SKI_OT_simulate(bpy.types.Operator):
    """Simulate the run by physics. Esc stops it and keeps what is done."""

    bl_idname = "ski.simulate"
    bl_label = "Simulate"
    bl_options = {"REGISTER"}

    _spec: RunSpec
    _skier: str
    _runner: JobRunner | None = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """One simulation at a time."""
        return not RUNNING.text

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Simulate to the end at once: for scripts and Blender without a window."""
        try:
            self._begin(context)
            with reported(self), _kept(self._settings(), self._spec):
                recording = run_to_end(simulation_job(self._spec))
            return self._keep(context, recording)
        except Failed:
            return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Simulate step by step while the window stays alive."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        try:
            self._begin(context)
        except Failed:
            return {"CANCELLED"}
        self._runner = JobRunner(simulation_job(self._spec), context)
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Compute one slice for each tick of the timer."""
        runner = self._runner
        if runner is None:
            return {"CANCELLED"}
        try:
            if event.type == "ESC" and event.value == "PRESS":
                with reported(self):
                    runner.stop()
            elif event.type != "TIMER":
                return {"PASS_THROUGH"}
            else:
                with reported(self), _kept(self._settings(), self._spec):
                    if runner.slice(context):
                        return {"RUNNING_MODAL"}
            self._end(context)
            return self._keep(context, runner.result)
        except Failed:
            self._end(context)
            return {"CANCELLED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Clean up when Blender ends the operator itself (another file is opened, the window is closed)."""
        self._end(context)

    def _begin(self, context: bpy.types.Context) -> None:
        with reported(self):
            context.view_layer.update()  # gates and curves may have been moved a moment ago
            skier = required_skier(context)
            self._skier = skier.name
            self._spec = read_spec(skier.ski)
            expected = estimate(self._spec)
            if expected.too_large:
                raise SpecError("course", problem=f"would take {expected.described}", hint="shorten the course")

    def _settings(self) -> Any:
        """Return the skier's settings: looked up by name, for undo may have made all objects anew meanwhile."""
        skier = bpy.data.objects.get(self._skier)
        if skier is None or not is_skier(None, skier):
            hint = "the simulation is lost; add a skier and simulate again"
            raise SpecError("the skier", self._skier, hint=hint, problem="was removed or renamed meanwhile")
        return skier.ski

    def _end(self, context: bpy.types.Context) -> None:
        if self._runner is not None:
            self._runner.close(context)
            self._runner = None

    def _keep(self, context: bpy.types.Context, recording: Any) -> set[str]:
        """Save the recording, whole or partial, and say how the run ended."""
        if recording is None or not len(recording.time):
            self.report({"WARNING"}, "Stopped before the first step: nothing was recorded")
            return {"CANCELLED"}
        with reported(self):
            settings = self._settings()
            settings.recording = save_recording(recording, self._skier)
        settings.bake_hash = ""  # what is baked is of another recording now
        finished = recording.status == "finished"
        tell(settings, "simulation", self._spec, recording_lines(recording), failed=not finished)
        self.report({"INFO"} if finished else {"WARNING"}, ending(recording))
        return {"FINISHED"}


@contextlib.contextmanager
def _kept(settings: Any, spec: RunSpec) -> Iterator[None]:
    """Keep what fails within in the sidebar as the simulation's answer, and let it pass."""
    try:
        yield
    except SkiAddonError as error:
        tell(settings, "simulation", spec, [str(error)], failed=True)
        raise


CLASSES = (SKI_OT_simulate,)
