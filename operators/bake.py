"""Bake: the simulated run, or the instant preview, becomes keyframes."""

from __future__ import annotations

from typing import Any

import bpy

from ..ski_addon.animation.span import FRAMES, SECONDS, WHOLE, Part
from ..ski_addon.blender.jobs import RUNNING
from ..ski_addon.blender.properties import tell
from ..ski_addon.blender.shown import required_skier, skier_of
from .failing import Failed, reported

SIMULATION, PREVIEW = "SIMULATION", "PREVIEW"
SETTINGS = "SETTINGS"


class SKI_OT_bake(bpy.types.Operator):
    """Bake the simulated run: keyframes on the skier, and the slope with the skis' tracks."""

    bl_idname = "ski.bake"
    bl_label = "Bake"
    bl_options = {"REGISTER", "UNDO"}

    source: bpy.props.EnumProperty(
        name="Source",
        description="What is baked",
        items=[
            (SIMULATION, "Simulation", "The run that was simulated by physics"),
            (PREVIEW, "Preview", "The instant motion of the preview, without a simulation"),
        ],
        default=SIMULATION,
        options={"SKIP_SAVE"},
    )
    part: bpy.props.EnumProperty(
        name="Part of the Run",
        description="What gets keys; as the Ski tab has it unless a script says",
        items=[
            (SETTINGS, "As in the Tab", "As the skier's settings have it"),
            (WHOLE, "Whole Run", "From the start to the end"),
            (SECONDS, "Seconds", "From one second of the run to another"),
            (FRAMES, "Frames", "From one frame of the scene to another"),
        ],
        default=SETTINGS,
        options={"SKIP_SAVE"},
    )
    begin: bpy.props.FloatProperty(
        name="Begin", description="Seconds from the start of the run, or a frame of the scene", options={"SKIP_SAVE"}
    )
    end: bpy.props.FloatProperty(
        name="End", description="As Begin; 0 seconds stand for the end of the run", options={"SKIP_SAVE"}
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a skier, and nothing that runs."""
        if RUNNING.text:
            cls.poll_message_set("Wait for the simulation, or stop it with Esc")
            return False
        return skier_of(context) is not None

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:
        """Return what the button does."""
        if properties.source == PREVIEW:
            return "Bake the instant motion of the preview: keyframes at once, without a simulation"
        return cls.__doc__ or ""

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Bake onto the skier in the tab."""
        try:
            with reported(self):
                from ..ski_addon.blender.baking import bake_preview, bake_simulation
                from ..ski_addon.blender.words import bake_lines

                context.view_layer.update()
                skier = required_skier(context)
                part = None if self.part == SETTINGS else Part(self.part, self.begin, self.end)
                made = bake_preview if self.source == PREVIEW else bake_simulation
                run, result = made(context.scene, skier, part)
        except Failed:
            return {"CANCELLED"}
        lines = bake_lines(result)
        tell(skier.ski, "bake", run, lines)
        self.report({"INFO"}, " ".join(lines))
        return {"FINISHED"}


CLASSES = (SKI_OT_bake,)
