"""Presets: go back to one after changing something."""

from __future__ import annotations

import bpy

from ..ski_addon.blender.properties import preset_specs, write_spec


class SKI_OT_reset_to_preset(bpy.types.Operator):
    """Set everything as in the chosen preset again."""

    bl_idname = "ski.reset_to_preset"
    bl_label = "Reset to Preset"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply the preset."""
        settings = context.scene.ski
        write_spec(settings, preset_specs()[settings.preset])
        return {"FINISHED"}
