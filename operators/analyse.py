"""Analyse: the report as an image, and the overlay of the 3D view."""

from __future__ import annotations

import bpy

from ..ski_addon.blender import live
from ..ski_addon.blender.cache import load_recording
from ..ski_addon.blender.frame_rate import scene_rate
from ..ski_addon.blender.placing import world_from_run
from ..ski_addon.blender.shown import required_skier, skier_of
from .failing import Failed, reported


class SKI_OT_show_report(bpy.types.Operator):
    """Draw the plots of the simulated run as an image, and open it where an Image Editor is."""

    bl_idname = "ski.show_report"
    bl_label = "Show Report"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a skier."""
        return skier_of(context) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Draw it; without an Image Editor a new window is opened for it."""
        try:
            with reported(self):
                from ..ski_addon.blender.analysis import show_report

                skier = required_skier(context)
                image = show_report(load_recording(skier.ski.recording), skier.name)
                image.use_fake_user = True  # it shall stay with the file, shown or not
        except Failed:
            return {"CANCELLED"}
        if context.window is not None and not bpy.app.background:
            _open_image(context, image)
        self.report({"INFO"}, f"The report is the image {image.name}")
        return {"FINISHED"}


class SKI_OT_toggle_overlay(bpy.types.Operator):
    """Draw centre of mass, snow forces, plan and edge angles of the simulated run over the 3D view, or stop it."""

    bl_idname = "ski.toggle_overlay"
    bl_label = "Overlay"
    bl_options = {"REGISTER"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """There must be a skier."""
        return skier_of(context) is not None

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Show it for the skier in the tab, or hide it if it is shown."""
        try:
            with reported(self):
                from ..ski_addon.blender import overlay
                from ..ski_addon.blender.bake import recorded_run

                skier = required_skier(context)
                if overlay.is_shown() and live.STATE.overlay == skier.name:
                    overlay.hide()
                    live.STATE.overlay = ""
                    return {"FINISHED"}
                recording = load_recording(skier.ski.recording)
                rate, first = scene_rate(context.scene), skier.ski.bake.frame_start
                shown = overlay.show(
                    recording, recorded_run(recording), world_from_run(skier.ski), lambda frame: (frame - first) / rate
                )
                live.STATE.overlay = skier.name if shown else ""
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


def _open_image(context: bpy.types.Context, image: bpy.types.Image) -> None:
    """Show `image` in an Image Editor: one that is open, or a new window."""
    for window in context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = image
                return
    before = set(context.window_manager.windows)
    bpy.ops.wm.window_new()
    for window in set(context.window_manager.windows) - before:
        area = max(window.screen.areas, key=lambda area: area.width * area.height)
        area.type = "IMAGE_EDITOR"
        area.spaces.active.image = image


CLASSES = (SKI_OT_show_report, SKI_OT_toggle_overlay)
