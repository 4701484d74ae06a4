"""Crowd: many skiers on the run of one, simulated in processes of their own, and baked each at its start."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import bpy

from ..ski_addon.blender.jobs import RUNNING, JobRunner, run_to_end
from ..ski_addon.blender.properties import is_skier, tell
from ..ski_addon.blender.shown import required_skier, skier_of
from ..ski_addon.crowd.crowd_spec import CrowdSpec
from ..ski_addon.errors import SkiAddonError, SpecError
from .failing import Failed, reported


class SKI_OT_crowd(bpy.types.Operator):
    """Simulate many skiers on this skier's run, each in his own way. Esc stops it and keeps those who are done."""

    bl_idname = "ski.crowd"
    bl_label = "Simulate Crowd"
    bl_options = {"REGISTER"}

    _crowd: CrowdSpec
    _folder: Path
    _skier: str
    _runner: JobRunner | None = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a skier, and nothing that runs."""
        if RUNNING.text:
            cls.poll_message_set("Wait for the simulation, or stop it with Esc")
            return False
        return skier_of(context) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Simulate to the end at once: for scripts and Blender without a window."""
        try:
            job = self._begin(context)
            with reported(self):
                summary = self._told(lambda: run_to_end(job))
            return self._keep(summary)
        except Failed:
            return {"CANCELLED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Watch the processes while the window stays alive."""
        if bpy.app.background or context.window is None:
            return self.execute(context)
        try:
            from ..ski_addon.blender.crowds import busy_here

            self._runner = JobRunner(self._begin(context), context, busy=busy_here())
        except Failed:
            return {"CANCELLED"}
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Look at the processes with each tick of the timer."""
        runner = self._runner
        if runner is None:
            return {"CANCELLED"}
        try:
            with reported(self):
                if event.type == "ESC" and event.value == "PRESS":
                    runner.stop()
                elif event.type != "TIMER":
                    return {"PASS_THROUGH"}
                elif self._told(lambda: runner.slice(context)):
                    return {"RUNNING_MODAL"}
            self._end(context)
            return self._keep(runner.result)
        except Failed:
            self._end(context)
            return {"CANCELLED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Clean up when Blender ends the operator itself (another file is opened, the window is closed)."""
        if self._runner is not None:
            self._runner.stop()
        self._end(context)

    def _begin(self, context: bpy.types.Context) -> Any:
        """Return the job of the crowd that the settings ask for."""
        with reported(self):
            from ..ski_addon.blender.crowds import crowd_folder, crowd_job, read_crowd_spec

            context.view_layer.update()  # gates and curves may have been moved a moment ago
            skier = required_skier(context)
            self._skier = skier.name
            self._crowd = read_crowd_spec(skier.ski, context.scene)
            self._folder = crowd_folder(skier.name)
            return crowd_job(self._crowd, self._folder, skier.ski.crowd_jobs)

    def _told(self, work: Any) -> Any:
        """Do `work`; what fails is kept in the sidebar as the crowd's answer."""
        try:
            return work()
        except SkiAddonError as error:
            tell(self._settings(), "crowd", self._run, [str(error)], failed=True)
            raise

    @property
    def _run(self) -> Any:
        return self._crowd.runs[0].spec

    def _settings(self) -> Any:
        """Return the skier's settings: looked up by name, for undo may have made all objects anew meanwhile."""
        skier = bpy.data.objects.get(self._skier)
        if skier is None or not is_skier(None, skier):
            hint = "add a skier and simulate the crowd again"
            raise SpecError("the skier", self._skier, hint=hint, problem="was removed or renamed meanwhile")
        return skier.ski

    def _end(self, context: bpy.types.Context) -> None:
        if self._runner is not None:
            self._runner.close(context)
            self._runner = None

    def _keep(self, summary: Any) -> set[str]:
        """Keep where the recordings are, and say how it went."""
        if summary is None:
            self.report({"WARNING"}, "Stopped before anybody was skied to the end")
            return {"CANCELLED"}
        with reported(self):
            from ..ski_addon.blender.crowds import crowd_lines, kept_path

            settings = self._settings()
            settings.crowd_folder = kept_path(self._folder)
            lines = crowd_lines(summary)
            if summary["stopped"]:
                lines.insert(0, "Stopped: press Simulate Crowd again to go on with the others")
            whole = summary["finished"] == summary["count"]
            tell(settings, "crowd", self._run, lines, failed=not whole)
        self.report({"INFO"} if whole else {"WARNING"}, lines[0])
        return {"FINISHED"}


class SKI_OT_bake_crowd(bpy.types.Operator):
    """Make a skier with keyframes of everybody in the simulated crowd, each starting at its own time."""

    bl_idname = "ski.bake_crowd"
    bl_label = "Bake Crowd"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a skier, and nothing that runs."""
        return not RUNNING.text and skier_of(context) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bake the crowd of the skier in the tab."""
        try:
            with reported(self):
                from ..ski_addon.blender.crowd_bake import bake_on_slope
                from ..ski_addon.blender.crowds import found_folder
                from ..ski_addon.crowd.skied import read_skied

                context.view_layer.update()
                skier = required_skier(context)
                folder = found_folder(skier.ski)
                if folder is None:
                    hint = "press Simulate Crowd first"
                    raise SpecError("the crowd", problem="was not simulated, or its recordings are gone", hint=hint)
                with _progress(context.window_manager) as progress:
                    made = bake_on_slope(context.scene, skier, read_skied(folder), progress)
        except Failed:
            return {"CANCELLED"}
        frames = f"frames {made.frame_first:.0f} to {made.frame_last:.0f}"
        self.report({"INFO"}, f"Baked {len(made.armatures)} skiers, {frames}")
        return {"FINISHED"}


@contextlib.contextmanager
def _progress(manager: Any) -> Iterator[Callable[[float, str], None]]:
    """Show progress at the mouse while the block runs."""
    manager.progress_begin(0, 100)
    try:
        yield lambda fraction, _text: manager.progress_update(int(100 * fraction))
    finally:
        manager.progress_end()


CLASSES = (SKI_OT_crowd, SKI_OT_bake_crowd)
