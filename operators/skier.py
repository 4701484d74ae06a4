"""Skiers: add one, take one's own armature, choose and fit."""

from __future__ import annotations

import bpy

from ..ski_addon.blender.own_presets import laid_over
from ..ski_addon.blender.properties import DEFAULT_PRESET, read_spec
from ..ski_addon.blender.shown import required_skier
from ..ski_addon.spec import RunSpec
from .failing import Failed, reported


class SKI_OT_add_skier(bpy.types.Operator):
    """Add a skier with a run of its own at the 3D cursor."""

    bl_idname = "ski.add_skier"
    bl_label = "Add Skier"
    bl_options = {"REGISTER", "UNDO"}

    preset: bpy.props.StringProperty(name="Preset", description="Run to begin with", default=DEFAULT_PRESET)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Add it and make it the active object."""
        try:
            with reported(self):
                from ..ski_addon.blender.skiers import add_skier

                spec = laid_over(RunSpec(), "runs", self.preset)
                armature = add_skier(context.scene, spec, self.preset)
        except Failed:
            return {"CANCELLED"}
        _select(context, armature)
        return {"FINISHED"}


class SKI_OT_use_armature(bpy.types.Operator):
    """Give the active armature, your own character, a run to ski."""

    bl_idname = "ski.use_armature"
    bl_label = "Use My Armature"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """An armature must be active that is no skier yet."""
        obj = context.object
        if obj is None or obj.type != "ARMATURE":
            cls.poll_message_set("Select your character's armature first")
            return False
        return not obj.ski.is_skier

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Make it a skier."""
        try:
            with reported(self):
                from ..ski_addon.blender.skiers import adopt_armature

                adopt_armature(context.object, context.scene)
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


class SKI_OT_fit_figure(bpy.types.Operator):
    """Rebuild the figure for the person and the gear that are asked for now; keys and settings stay."""

    bl_idname = "ski.fit_figure"
    bl_label = "Fit Figure"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Rebuild it if it needs to be."""
        try:
            with reported(self):
                from ..ski_addon.blender.skiers import fit_figure

                skier = required_skier(context)
                fit_figure(skier, read_spec(skier.ski))
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


def _select(context: bpy.types.Context, obj: bpy.types.Object) -> None:
    """Make `obj` the one selected and active object."""
    for other in context.view_layer.objects.selected:
        other.select_set(False)
    obj.select_set(True)
    context.view_layer.objects.active = obj


CLASSES = (SKI_OT_add_skier, SKI_OT_use_armature, SKI_OT_fit_figure)
