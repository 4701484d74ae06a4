"""Bake: the recording becomes keyframes."""

from __future__ import annotations

import bpy

from ..ski_addon.blender.bake import bake_recording, fits, recorded_run
from ..ski_addon.blender.cache import load_recording
from ..ski_addon.blender.ground import update_ground
from ..ski_addon.blender.jobs import RUNNING
from ..ski_addon.blender.properties import read_spec, tell
from ..ski_addon.blender.words import bake_lines
from .failing import Failed, reported


class SKI_OT_bake(bpy.types.Operator):
    """Bake the simulated run: keyframes on the skier, and the slope with the skis' tracks."""

    bl_idname = "ski.bake"
    bl_label = "Bake"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a recording."""
        if RUNNING.text:
            return False
        if not context.scene.ski.recording:
            cls.poll_message_set("Simulate first")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bake onto the skier of the last bake, or a new one if the person has other measures."""
        scene, settings = context.scene, context.scene.ski
        try:
            with reported(self):
                recording = load_recording(settings.recording)
                run = recorded_run(recording)
                armature = settings.armature
                if armature is not None and not (armature.name in scene.objects and fits(armature, run.skier)):
                    armature = None
                options = read_spec(settings).bake
                result = bake_recording(recording, scene, armature=armature, options=options)
                settings.armature = result.armature
                settings.ground = update_ground(recording, run, scene, settings.ground, options)
        except Failed:
            return {"CANCELLED"}
        lines = bake_lines(result)
        tell(settings, "bake", run, lines)
        self.report({"INFO"}, " ".join(lines))
        return {"FINISHED"}
