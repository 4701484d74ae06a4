"""Lists of a run: gates, times of a rhythm, obstacles and pushes, row by row."""

from __future__ import annotations

import bpy

from ..ski_addon.blender import changes
from ..ski_addon.blender.rows import LISTED, duplicate_row
from ..ski_addon.blender.shown import required_skier
from .failing import Failed, reported

KINDS = [(kind, kind.capitalize(), "") for kind in LISTED]


class SKI_OT_add_row(bpy.types.Operator):
    """Add a row after the one that is chosen, like it."""

    bl_idname = "ski.add_row"
    bl_label = "Add"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(name="Kind", items=KINDS)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it and choose it."""
        try:
            with reported(self):
                settings = required_skier(context).ski
                duplicate_row(settings, self.kind)
        except Failed:
            return {"CANCELLED"}
        changes.changed(settings)
        return {"FINISHED"}


class SKI_OT_remove_row(bpy.types.Operator):
    """Remove the row that is chosen."""

    bl_idname = "ski.remove_row"
    bl_label = "Remove"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(name="Kind", items=KINDS)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove it and choose the one before."""
        try:
            with reported(self):
                settings = required_skier(context).ski
        except Failed:
            return {"CANCELLED"}
        items, chosen = getattr(settings, self.kind), getattr(settings, f"{self.kind}_index")
        if not 0 <= chosen < len(items):
            self.report({"WARNING"}, "No row is chosen")
            return {"CANCELLED"}
        items.remove(chosen)
        setattr(settings, f"{self.kind}_index", max(0, chosen - 1))
        changes.changed(settings)
        return {"FINISHED"}


CLASSES = (SKI_OT_add_row, SKI_OT_remove_row)
