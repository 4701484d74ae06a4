"""Parts of the Ski tab's panels: how to begin, bones of one's own armature, gates, and the buttons of the stages."""

from __future__ import annotations

from typing import Any

import bpy

from . import live
from .course_objects import gate_fields
from .jobs import RUNNING
from .panel_fields import draw_field, draw_rows


def draw_beginning(layout: Any) -> None:
    """Draw how to get a first skier."""
    column = layout.column()
    column.scale_y = 1.4
    column.operator("ski.add_skier", icon="ADD")
    layout.menu("SKI_MT_add_skier", icon="PRESET")
    layout.operator("ski.use_armature", icon="ARMATURE_DATA")


def draw_bones(layout: Any, armature: bpy.types.Object) -> None:
    """Draw the table of bones of an armature of the user's own."""
    settings = armature.ski
    row = layout.row(align=True)
    row.operator("ski.find_bones", icon="BONE_DATA")
    if not len(settings.bones):
        return
    row.operator("ski.save_bone_map", text="", icon="ADD")
    layout.template_list("SKI_UL_bones", "", settings, "bones", settings, "bones_index", rows=5)
    if 0 <= settings.bones_index < len(settings.bones):
        chosen = settings.bones[settings.bones_index]
        layout.prop_search(chosen, "bone", armature.data, "bones", text=chosen.wanted)


def draw_stage(layout: Any, operator: str, icon: str, possible: bool) -> None:
    """Draw the large button of a stage, which waits while a simulation runs."""
    row = layout.column()
    row.scale_y = 1.3
    row.enabled = not RUNNING.text and possible
    row.operator(operator, icon=icon)


def draw_part(layout: Any, settings: Any) -> None:
    """Draw which part of the run is baked."""
    column = layout.column(align=True)
    column.prop(settings, "part")
    for name in {"SECONDS": ("part_begin", "part_end"), "FRAMES": ("part_first", "part_last")}.get(settings.part, ()):
        column.prop(settings, name)


def draw_gates(layout: Any, context: bpy.types.Context, settings: Any) -> None:
    """Draw how to set gates, the one that is selected, and the rows that count while none stand in the scene."""
    column = layout.column(align=True)
    column.operator("ski.place_gates", icon="GREASEPENCIL")
    row = column.row(align=True)
    row.operator_menu_enum("ski.set_gates", "discipline", text="Set Course")
    row.operator("ski.refresh_gates", text="", icon="SORTSIZE")
    row.operator("ski.clear_gates", text="", icon="TRASH")
    if live.STATE.preview is not None and live.STATE.preview.off_snow:
        column.operator("ski.put_gates_on_snow", icon="SNAP_ON")
    if settings.course.gate_setting != "list":
        return
    gate = context.object
    if gate is not None and gate.ski_gate.is_gate:
        box = layout.box().column(align=True)
        box.label(text=gate.name, icon="OUTLINER_OB_FORCE_FIELD")
        for info in gate_fields():
            draw_field(box, gate.ski_gate, info)
    if settings.gates is None or not settings.gates.all_objects:
        draw_rows(layout, settings, "gate")
        layout.prop(settings, "curve", text="Or a Curve")
