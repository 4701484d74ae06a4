"""Simulate: let the skier ski the track by physics."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import bpy

from ..ski_addon.blender.cache import load_recording, save_recording
from ..ski_addon.blender.frame_rate import scene_rate
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

    begin: bpy.props.EnumProperty(
        name="Begin",
        description="Where the simulation begins",
        items=[
            ("START", "At the Start", "The whole run"),
            ("END", "Go On", "Go on where the last simulation ended, on a course that may have become longer"),
            ("FRAME", "From This Frame", "Keep the run up to the current frame and simulate anew from there"),
        ],
        default="START",
        options={"SKIP_SAVE"},
    )
    _spec: RunSpec
    _after: tuple[Any, float] | None = None
    _skier: str
    _runner: JobRunner | None = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """One simulation at a time."""
        return not RUNNING.text

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:
        """Return what the button does."""
        if properties.begin == "END":
            return "Go on where the last simulation ended; the course may have become longer meanwhile"
        if properties.begin == "FRAME":
            return "Keep the simulated run up to the current frame, and simulate anew from there"
        return cls.__doc__ or ""

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Simulate to the end at once: for scripts and Blender without a window."""
        try:
            self._begin(context)
            with reported(self), _kept(self._settings(), self._spec):
                recording = run_to_end(simulation_job(self._spec, self._after))
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
        self._runner = JobRunner(simulation_job(self._spec, self._after), context)
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
            self._after = self._recorded(context, skier.ski)
            expected = estimate(self._spec)
            if expected.too_large:
                raise SpecError("course", problem=f"would take {expected.described}", hint="shorten the course")

    def _recorded(self, context: bpy.types.Context, settings: Any) -> tuple[Any, float] | None:
        """Return the recording to go on from and the moment [s], or None for a run from the start."""
        if self.begin == "START":
            return None
        recording = load_recording(settings.recording)
        end = float(recording.time[-1]) if len(recording.time) else 0.0
        if self.begin == "END":
            return recording, end
        frame = context.scene.frame_current_final - settings.bake.frame_start
        return recording, frame / scene_rate(context.scene)

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
            settings.recording, note = save_recording(recording, self._skier)
        settings.bake_hash = ""  # what is baked is of another recording now
        finished = recording.status == "finished"
        notes = [f"Note: {note}"] if note else []
        tell(settings, "simulation", self._spec, [*recording_lines(recording), *notes], failed=not finished)
        said = f"{ending(recording)}; {note}" if note else ending(recording)
        self.report({"INFO"} if finished and not note else {"WARNING"}, said)
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
