"""Presets: choose one, go back to it, keep one's own."""

from __future__ import annotations

from typing import Any

import bpy

from ..ski_addon.blender.own_presets import OWN, find_preset, laid_over, remove_own, save_own
from ..ski_addon.blender.properties import read_spec, write_spec
from ..ski_addon.blender.shown import required_skier
from ..ski_addon.errors import SkiAddonError, SpecError
from ..ski_addon.spec import PRESET_KINDS, RunSpec
from .failing import Failed, reported

KINDS = [(kind, kind.capitalize(), "") for kind in PRESET_KINDS]


class SKI_OT_apply_preset(bpy.types.Operator):
    """Set everything, or this part of it, as in this preset."""

    bl_idname = "ski.apply_preset"
    bl_label = "Apply Preset"
    bl_options = {"REGISTER", "UNDO"}

    kind: bpy.props.EnumProperty(name="Kind", items=KINDS, default="runs")
    preset: bpy.props.StringProperty(name="Preset")

    @classmethod
    def description(cls, _context: bpy.types.Context, properties: Any) -> str:
        """Return what the preset is for."""
        try:
            return find_preset(properties.kind, properties.preset).description or "One of your own presets"
        except SkiAddonError:
            return cls.__doc__ or ""

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply the preset to the skier in the tab."""
        try:
            with reported(self):
                from ..ski_addon.blender.skiers import fit_figure

                skier = required_skier(context)
                spec = laid_over(_spec_or_none(skier) or RunSpec(), self.kind, self.preset)
                write_spec(skier.ski, spec)
                if self.kind == "runs":
                    skier.ski.preset = self.preset
                fit_figure(skier, spec)
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


class SKI_OT_reset_to_preset(bpy.types.Operator):
    """Set everything as in the chosen preset again."""

    bl_idname = "ski.reset_to_preset"
    bl_label = "Reset to Preset"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Apply the preset that was chosen last."""
        try:
            with reported(self):
                from ..ski_addon.blender.skiers import fit_figure

                skier = required_skier(context)
                spec = laid_over(RunSpec(), "runs", skier.ski.preset)
                write_spec(skier.ski, spec)
                fit_figure(skier, spec)
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


class SKI_OT_save_preset(bpy.types.Operator):
    """Keep these settings as a preset of your own, for all files; one of the same name is replaced."""

    bl_idname = "ski.save_preset"
    bl_label = "Save Preset"
    bl_options = {"REGISTER"}

    kind: bpy.props.EnumProperty(name="Kind", items=KINDS, default="runs", options={"HIDDEN"})
    name: bpy.props.StringProperty(name="Name", default="My preset", maxlen=60)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Ask for the name."""
        return context.window_manager.invoke_props_dialog(self)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Write the preset."""
        try:
            with reported(self):
                skier = required_skier(context)
                kept = save_own(read_spec(skier.ski), self.kind, self.name)
                if self.kind == "runs":
                    skier.ski.preset = kept.identifier
        except Failed:
            return {"CANCELLED"}
        self.report({"INFO"}, f"Kept as {kept.path}")
        return {"FINISHED"}


class SKI_OT_remove_preset(bpy.types.Operator):
    """Delete this preset of your own."""

    bl_idname = "ski.remove_preset"
    bl_label = "Remove Preset"
    bl_options = {"REGISTER"}

    kind: bpy.props.EnumProperty(name="Kind", items=KINDS, default="runs")
    preset: bpy.props.StringProperty(name="Preset")

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask first: a file is deleted, which undo does not bring back."""
        return context.window_manager.invoke_confirm(self, event)

    def execute(self, _context: bpy.types.Context) -> set[str]:
        """Delete the file."""
        try:
            with reported(self):
                remove_own(self.kind, self.preset)
        except Failed:
            return {"CANCELLED"}
        self.report({"INFO"}, f"Removed {self.preset.removeprefix(OWN)}")
        return {"FINISHED"}


def _spec_or_none(skier: bpy.types.Object) -> RunSpec | None:
    """Return the skier's run, or None where the settings ask for none that can be: the preset mends that."""
    try:
        return read_spec(skier.ski)
    except SpecError:
        return None


CLASSES = (SKI_OT_apply_preset, SKI_OT_reset_to_preset, SKI_OT_save_preset, SKI_OT_remove_preset)
