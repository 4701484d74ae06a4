"""The Ski tab of the 3D view's sidebar."""

from __future__ import annotations

import textwrap
from typing import Any

import bpy

from ..dependencies import missing_dependencies
from ..errors import SpecError
from ..spec import find_field
from .fields import WORD_SUFFIX
from .jobs import RUNNING
from .properties import preset_specs, read_spec

SHOWN = {
    "Skier": ("skier.mass", "skier.height"),
    "Slope": ("slope.angle_deg", "snow.friction"),
    "Turns": (
        "course.turn_count",
        "course.first_turn",
        "course.turn_radius",
        "course.turn_duration",
        "course.transition_duration",
        "course.start_speed",
        "course.half_first_turn",
    ),
}
"""Keys of the run document that the tab shows, by heading."""


class SKI_PT_main(bpy.types.Panel):
    """Ski: from a track to keyframes."""

    bl_label = "Ski"
    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Ski"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the whole tab."""
        layout, settings = self.layout, context.scene.ski
        layout.use_property_split = True
        layout.use_property_decorate = False
        missing = missing_dependencies()
        if missing:
            _draw_missing(layout, missing, _columns(context))
        _draw_settings(layout, settings)
        run_hash = _run_hash(settings)
        stages = layout.column()
        stages.use_property_split = False
        for stage, operator, icon in (
            ("plan", "ski.plan", "CURVE_PATH"),
            ("simulation", "ski.simulate", "PHYSICS"),
            ("bake", "ski.bake", "KEYFRAME_HLT"),
        ):
            row = stages.column()
            row.scale_y = 1.3
            row.enabled = not RUNNING.text and not (missing and stage != "bake")
            row.operator(operator, icon=icon)
            if stage == "simulation" and RUNNING.text:
                _draw_progress(stages, _columns(context))
            else:
                _draw_result(stages, settings, stage, run_hash, _columns(context))


def _columns(context: bpy.types.Context) -> int:
    """Return about how many characters fit into a line of the sidebar."""
    scale = context.preferences.system.ui_scale or 1.0  # 0 without a window
    return max(20, int((context.region.width - 50 * scale) / (6.6 * scale)))


def _draw_missing(layout: Any, missing: list[str], columns: int) -> None:
    box = layout.box().column(align=True)
    box.alert = True
    box.label(text="Parts of the add-on are missing", icon="ERROR")
    remedy = "Install the Ski Addon zip for this system again; without them nothing can be simulated."
    said = f"Not found: {', '.join(missing)}. {remedy}"
    for line in textwrap.wrap(said, columns):
        box.label(text=line)


def _draw_settings(layout: Any, settings: Any) -> None:
    changed = _changed(settings)
    row = layout.row(align=True)
    row.prop(settings, "preset")
    if changed:
        row.operator("ski.reset_to_preset", text="", icon="LOOP_BACK")
    for heading, keys in SHOWN.items():
        column = layout.column(align=True, heading=heading) if len(keys) == 1 else layout.column(align=True)
        column.label(text=heading)
        for key in keys:
            _draw_field(column, settings, key)


def _draw_field(column: Any, settings: Any, key: str) -> None:
    info = find_field(key)
    group = getattr(settings, info.section)
    if not info.word:
        column.prop(group, info.name)
        return
    row = column.row(align=True)
    value = row.row(align=True)
    value.enabled = not getattr(group, info.name + WORD_SUFFIX)
    value.prop(group, info.name)
    row.prop(group, info.name + WORD_SUFFIX, toggle=True)


def _run_hash(settings: Any) -> str:
    try:
        return read_spec(settings).content_hash()
    except SpecError:
        return ""


def _changed(settings: Any) -> bool:
    preset = preset_specs().get(settings.preset)
    return preset is None or preset.content_hash() != _run_hash(settings)


def _draw_progress(layout: Any, columns: int) -> None:
    layout.progress(factor=RUNNING.fraction, text=f"{RUNNING.fraction:.0%}")
    box = layout.box().column(align=True)
    for line in textwrap.wrap(RUNNING.text, columns):
        box.label(text=line)
    box.label(text="Esc: stop and keep what is done")


def _draw_result(layout: Any, settings: Any, stage: str, run_hash: str, columns: int) -> None:
    text = getattr(settings, f"{stage}_text")
    if not text:
        return
    failed = getattr(settings, f"{stage}_failed")
    box = layout.box().column(align=True)
    if getattr(settings, f"{stage}_hash") != run_hash:
        box.label(text="From before the last change:", icon="TIME")
        box = box.column(align=True)
        box.active = False
    first = True
    for line in text.split("\n"):
        for part in textwrap.wrap(line, columns if not first else columns - 3):
            if first:
                box.label(text=part, icon="ERROR" if failed else "CHECKMARK")
            else:
                box.label(text=part)
            first = False


def register() -> None:
    """Add the tab."""
    bpy.utils.register_class(SKI_PT_main)


def unregister() -> None:
    """Take the tab away."""
    bpy.utils.unregister_class(SKI_PT_main)
