"""Courses on the slope: gates by mouse, a whole course of gates, the slope itself."""

from __future__ import annotations

import dataclasses
from typing import Any

import bpy
import numpy as np
from bpy_extras import view3d_utils

from ..ski_addon.blender import live
from ..ski_addon.blender.course_objects import gate_objects, standing_gates
from ..ski_addon.blender.gate_heights import gates_off_snow, off_snow_words, put_on_snow
from ..ski_addon.blender.gate_placing import (
    add_gate,
    clear_gates,
    ground_under_ray,
    refresh_gates,
    set_gates,
)
from ..ski_addon.blender.properties import read_slope, read_spec
from ..ski_addon.blender.shown import required_skier, skier_of
from ..ski_addon.errors import SkiAddonError
from ..ski_addon.spec import RunSpec
from .failing import Failed, reported

DISCIPLINES = [
    ("slalom", "Slalom", "About 10 m from gate to gate and 2 m aside, single poles"),
    ("giant_slalom", "Giant Slalom", "About 24 m from gate to gate and 4.5 m aside, panels between two poles"),
]


class SKI_OT_place_gates(bpy.types.Operator):
    """Place gates with the mouse: every click on the slope sets one more."""

    bl_idname = "ski.place_gates"
    bl_label = "Place Gates"
    bl_options = {"REGISTER"}

    _placed: list[str]

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """A skier must be there for whom gates are set."""
        return skier_of(context) is not None

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Begin; gates that stand there already stay."""
        try:
            with reported(self):
                self._begin(context)
        except Failed:
            return {"CANCELLED"}
        self._placed = []
        context.window_manager.modal_handler_add(self)
        context.window.cursor_modal_set("CROSSHAIR")
        self._say(context)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Without a mouse there is nothing to place: scripts add gates with ski.add_gate."""
        self.report({"ERROR"}, "gates are placed with the mouse in a 3D view; scripts use bpy.ops.ski.add_gate")
        return {"CANCELLED"}

    def modal(self, context: bpy.types.Context, event: Any) -> set[str]:
        """Set a gate for each click; navigation goes on as usual."""
        undo = event.type == "Z" and event.ctrl or event.type == "BACK_SPACE"
        if event.value == "PRESS" and event.type in ("ESC", "RET", "NUMPAD_ENTER", "RIGHTMOUSE"):
            return self._end(context)
        if event.value == "PRESS" and undo:
            self._take_back(context)
            return {"RUNNING_MODAL"}
        if event.type not in ("MOUSEMOVE", "LEFTMOUSE"):
            return {"PASS_THROUGH"}
        found = _view_under(context, event)
        if found is None:
            return {"PASS_THROUGH"}
        try:
            with reported(self):
                place = self._ground(context, event, *found)
                live.CURSOR.place = place
                found[0].tag_redraw()
                if event.type == "LEFTMOUSE" and event.value == "PRESS":
                    self._click(context, place)
        except Failed:
            return self._end(context)
        return {"RUNNING_MODAL"} if event.type == "LEFTMOUSE" else {"PASS_THROUGH"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Clean up when Blender ends the operator itself."""
        self._end(context)

    def _begin(self, context: bpy.types.Context) -> None:
        settings = required_skier(context).ski
        spec = read_spec(settings)
        listed = spec.course.kind == "gates" and spec.course.gate_setting == "list"
        if listed and spec.gate and not standing_gates(settings, spec):
            set_gates(settings, spec)

    def _ground(self, context: bpy.types.Context, event: Any, area: Any, region: Any) -> Any:
        """Return the place on the ground under the mouse, or None."""
        settings = required_skier(context).ski
        at = event.mouse_x - region.x, event.mouse_y - region.y
        view = area.spaces.active.region_3d
        origin = np.array(view3d_utils.region_2d_to_origin_3d(region, view, at))
        direction = np.array(view3d_utils.region_2d_to_vector_3d(region, view, at))
        return ground_under_ray(settings, read_slope(settings), origin, direction)

    def _click(self, context: bpy.types.Context, place: Any) -> None:
        if place is None:
            self.report({"WARNING"}, "There is no slope under the mouse: click on the snow")
            return
        pole = add_gate(required_skier(context).ski, place)
        self._placed.append(pole.name)
        bpy.ops.ed.undo_push(message="Place Gate")
        self._say(context)

    def _take_back(self, context: bpy.types.Context) -> None:
        """Remove the gate placed last."""
        settings = required_skier(context).ski
        poles = [] if settings.gates is None else [o for o in settings.gates.all_objects if o.ski_gate.is_gate]
        newest = max(poles, key=lambda pole: pole.session_uid, default=None)
        if newest is None or not self._placed:
            return
        self._placed.pop()
        for obj in (*newest.children, newest):
            bpy.data.objects.remove(obj)
        if len(poles) > 1:
            refresh_gates(settings)
        bpy.ops.ed.undo_push(message="Take Back Gate")
        self._say(context)

    def _say(self, context: bpy.types.Context) -> None:
        if context.workspace is not None:
            said = "Click: place a gate   |   Backspace: take the last one back   |   Enter or Esc: done"
            context.workspace.status_text_set(f"Ski: {len(self._placed)} placed   |   {said}")

    def _end(self, context: bpy.types.Context) -> set[str]:
        live.CURSOR.place = None
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        if context.window is not None:
            context.window.cursor_modal_restore()
        live.redraw_views()
        return {"FINISHED"} if self._placed else {"CANCELLED"}


class SKI_OT_add_gate(bpy.types.Operator):
    """Stand one more gate at a place on the slope."""

    bl_idname = "ski.add_gate"
    bl_label = "Add Gate"
    bl_options = {"REGISTER", "UNDO"}

    location: bpy.props.FloatVectorProperty(name="Location", description="In the scene", subtype="TRANSLATION")

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Stand it there, on the snow."""
        try:
            with reported(self):
                add_gate(required_skier(context).ski, np.array(self.location))
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


class SKI_OT_set_gates(bpy.types.Operator):
    """Set a whole course of gates by the rules of a discipline, in place of those that stand there."""

    bl_idname = "ski.set_gates"
    bl_label = "Set Course"
    bl_options = {"REGISTER", "UNDO"}

    discipline: bpy.props.EnumProperty(name="Discipline", items=DISCIPLINES)
    count: bpy.props.IntProperty(name="Gates", description="How many gates are set", default=15, min=1, max=200)
    variation: bpy.props.FloatProperty(
        name="Unevenness", description="How unevenly gates are set; 0 = evenly", default=0.0, min=0.0, max=1.0
    )
    seed: bpy.props.IntProperty(name="Seed", description="Another seed, another course", default=0, min=0)

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Set them as objects that can be moved."""
        try:
            with reported(self):
                settings = required_skier(context).ski
                spec = read_slope(settings)
                course = dataclasses.replace(
                    RunSpec().course,
                    kind="gates",
                    gate_setting=self.discipline,
                    gate_count=self.count,
                    gate_variation=self.variation,
                    first_turn=settings.course.first_turn,
                )
                simulation = dataclasses.replace(spec.simulation, seed=self.seed)
                set_gates(settings, dataclasses.replace(spec, course=course, simulation=simulation))
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


class SKI_OT_refresh_gates(bpy.types.Operator):
    """Number and colour the gates anew from the top down, and put them on the snow."""

    bl_idname = "ski.refresh_gates"
    bl_label = "Number Gates"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do it."""
        try:
            with reported(self):
                refresh_gates(required_skier(context).ski)
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


class SKI_OT_put_gates_on_snow(bpy.types.Operator):
    """Put gates that were dragged over or under the snow straight on it; numbers and colours stay."""

    bl_idname = "ski.put_gates_on_snow"
    bl_label = "Put on Snow"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Do it, and say which gate has no snow under it."""
        try:
            with reported(self):
                context.view_layer.update()
                settings = required_skier(context).ski
                spec = read_slope(settings)
                count = put_on_snow(settings, spec)
                left = off_snow_words(gates_off_snow(settings, spec))
        except Failed:
            return {"CANCELLED"}
        said = f"{count} {'gate' if count == 1 else 'gates'} put on the snow"
        self.report({"WARNING"} if left else {"INFO"}, f"{said}; {left}" if left else said)
        return {"FINISHED"}


class SKI_OT_clear_gates(bpy.types.Operator):
    """Remove all gates of this skier."""

    bl_idname = "ski.clear_gates"
    bl_label = "Remove Gates"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Remove them."""
        try:
            with reported(self):
                clear_gates(required_skier(context).ski)
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


class SKI_OT_make_slope(bpy.types.Operator):
    """Make the slope as a mesh under the track that is planned now."""

    bl_idname = "ski.make_slope"
    bl_label = "Make Slope"
    bl_options = {"REGISTER", "UNDO"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Make it, in place of the one that was made before."""
        try:
            with reported(self):
                from ..ski_addon.blender.figures import instant_ground
                from ..ski_addon.blender.ground import Place

                context.view_layer.update()
                settings = required_skier(context).ski
                spec = read_spec(settings)
                place = Place(settings.start, settings.slope_mesh is not None, gate_objects(settings, spec))
                settings.ground = instant_ground(spec, context.scene, settings.ground, place)
        except Failed:
            return {"CANCELLED"}
        return {"FINISHED"}


class SKI_OT_sample_slope(bpy.types.Operator):
    """Take the slope from the mesh: heights and fall line, with its modifiers and its place in the scene."""

    bl_idname = "ski.sample_slope"
    bl_label = "Take Slope from Mesh"
    bl_options = {"REGISTER", "UNDO"}

    use_start: bpy.props.BoolProperty(
        name="Start Where It Is",
        description="The run starts where its start object stands now; off = at the upper end of the mesh",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Sample the mesh into a file of heights and put the start on it."""
        try:
            with reported(self):
                from ..ski_addon.blender.slope_taking import take_slope

                context.view_layer.update()
                settings = required_skier(context).ski
                try:
                    said = take_slope(settings, context.evaluated_depsgraph_get(), use_start=self.use_start)
                except SkiAddonError as error:
                    settings.slope_said, settings.slope_failed = str(error), True
                    raise
        except Failed:
            return {"CANCELLED"}
        settings.slope_said, settings.slope_failed = said, False
        self.report({"INFO"}, f"Slope taken from {settings.slope_mesh.name}: {said}")
        return {"FINISHED"}


def _view_under(context: bpy.types.Context, event: Any) -> tuple[Any, Any] | None:
    """Return the 3D view and its main region under the mouse, or None over buttons and other editors."""
    for area in context.window.screen.areas:
        if area.type != "VIEW_3D":
            continue
        others = [region for region in area.regions if region.type != "WINDOW" and region.width > 1]
        if any(_inside(region, event) for region in others if region.type in ("UI", "TOOLS", "HEADER", "TOOL_HEADER")):
            continue
        for region in area.regions:
            if region.type == "WINDOW" and _inside(region, event):
                return area, region
    return None


def _inside(region: Any, event: Any) -> bool:
    x, y = event.mouse_x - region.x, event.mouse_y - region.y
    return 0 <= x < region.width and 0 <= y < region.height


CLASSES = (
    SKI_OT_place_gates,
    SKI_OT_add_gate,
    SKI_OT_set_gates,
    SKI_OT_refresh_gates,
    SKI_OT_put_gates_on_snow,
    SKI_OT_clear_gates,
    SKI_OT_make_slope,
    SKI_OT_sample_slope,
)
