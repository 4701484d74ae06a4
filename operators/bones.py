"""Bones of the user's own armature: find what they are, and keep the table as a bone map."""

from __future__ import annotations

from pathlib import Path

import bpy

from ..ski_addon.blender.shown import required_skier
from .failing import Failed, reported


class SKI_OT_find_bones(bpy.types.Operator):
    """Find which bones of your armature are hips, spine, arms and legs, by the bone map that fits it best."""

    bl_idname = "ski.find_bones"
    bl_label = "Find Bones"
    bl_options = {"REGISTER", "UNDO"}

    bone_map: bpy.props.StringProperty(name="Bone Map", description="A map's file; empty = the one that fits best")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Fill the table; bones that were not found are told."""
        try:
            with reported(self):
                from ..ski_addon.blender.armature_maps import detect_bone_map
                from ..ski_addon.blender.bone_tables import fill_table

                armature = required_skier(context)
                path = Path(bpy.path.abspath(self.bone_map)) if self.bone_map else detect_bone_map(armature).path
                missing = fill_table(armature, path)
        except Failed:
            return {"CANCELLED"}
        found = len(armature.ski.bones) - len(missing)
        said = f"{path.stem}: {found} bones found" + (f", not found: {', '.join(missing)}" if missing else "")
        self.report({"WARNING"} if missing else {"INFO"}, said)
        return {"FINISHED"}


class SKI_OT_save_bone_map(bpy.types.Operator):
    """Keep this table of bones as a bone map of your own, which is found for armatures like this one."""

    bl_idname = "ski.save_bone_map"
    bl_label = "Save Bone Map"
    bl_options = {"REGISTER"}

    name: bpy.props.StringProperty(name="Name", default="My character", maxlen=60)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Ask for the name."""
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write it."""
        try:
            with reported(self):
                from ..ski_addon.blender.bone_tables import save_map

                path = save_map(required_skier(context), self.name)
        except Failed:
            return {"CANCELLED"}
        self.report({"INFO"}, f"Kept as {path}")
        return {"FINISHED"}


CLASSES = (SKI_OT_find_bones, SKI_OT_save_bone_map)
