"""The Ski tab of the 3D view's sidebar: one panel a step of the work, in its order."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import bpy

from ..crowd.crowd_spec import field_table as crowd_table
from ..dependencies import missing_dependencies
from ..errors import SkiAddonError
from ..spec import RunSpec, row_kinds
from . import live
from .frame_rate import scene_rate
from .gate_heights import off_snow_words
from .jobs import RUNNING
from .own_presets import find_preset, laid_over
from .panel_fields import EXPERT, MORE, draw_fields, draw_rows, folded_fields, row_words, top_fields
from .panel_parts import draw_beginning, draw_bones, draw_gates, draw_part, draw_stage
from .panel_stages import columns_of, draw_progress, draw_result, draw_words
from .preferences import is_expert
from .preset_menus import CLASSES as MENUS
from .preset_menus import draw_menu_button
from .properties import read_spec, run_hash
from .shown import settings_of, skier_of, skiers

CROWD_TOP = (
    *("crowd.count", "crowd.seed", "crowd.start_interval", "crowd.apart"),
    *("spread.height", "spread.women", "spread.speed", "spread.radius", "spread.knee_bend_deg", "spread.offset"),
)
"""Keys of a crowd that matter most, in the order of the tab."""
PHYSICS_ONLY = "alpine"
"""The kind of figure that the whole physics is for."""


class _InTab:
    """What all panels of the tab share."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Ski"


class _Step(_InTab):
    """A step of the work with a skier: shown as soon as there is one."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        """A skier must be shown."""
        return skier_of(context) is not None


class SKI_UL_rows(bpy.types.UIList):
    """Rows of a run: gates, times of a rhythm, obstacles or pushes."""

    def draw_item(
        self, _context: Any, layout: Any, _data: Any, item: Any, _icon: Any, _active_data: Any, _active_property: Any
    ) -> None:
        """Draw one row in a few words."""
        layout.label(text=row_words(item, self.list_id))


class SKI_UL_bones(bpy.types.UIList):
    """Bones of a user's own armature, and what they follow."""

    def draw_item(
        self, _context: Any, layout: Any, _data: Any, item: Any, _icon: Any, _active_data: Any, _active_property: Any
    ) -> None:
        """Draw one bone; those without one are marked."""
        split = layout.split(factor=0.45)
        split.label(text=item.wanted)
        split.label(text=item.bone or "none", icon="BONE_DATA" if item.bone else "ERROR")


class SKI_PT_skier(_InTab, bpy.types.Panel):
    """Who skis."""

    bl_label = "Skier"

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        """Draw the menu of persons."""
        if skier_of(context) is not None:
            draw_menu_button(self.layout, "skiers")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw how to get a skier, or whose run the tab shows."""
        layout, skier = _prepared(self.layout), skier_of(context)
        missing = missing_dependencies()
        if missing:
            remedy = "install the Ski Addon zip for this system again; without them nothing can be simulated"
            said = f"Parts of the add-on are missing ({', '.join(missing)}): {remedy}"
            draw_words(layout, said, columns_of(context), "ERROR", alert=True)
        if len(skiers(context.scene)) > 1:
            layout.prop(context.scene, "ski_skier", text="Shown")
        if skier is None:
            draw_beginning(layout)
            return
        settings = skier.ski
        row = layout.row(align=True)
        row.label(text=skier.name, icon="ARMATURE_DATA" if settings.is_own else "OUTLINER_OB_ARMATURE")
        row.operator("ski.add_skier", text="", icon="ADD")
        row = layout.row(align=True)
        draw_menu_button(row, "runs", _preset_name(settings))
        if _is_changed(settings):
            row.operator("ski.reset_to_preset", text="", icon="LOOP_BACK")
        if settings.is_own:
            draw_bones(layout, skier)
        draw_fields(layout, settings, top_fields(settings, "figure") + top_fields(settings, "skier"))
        from .skiers import wears_shown

        if not wears_shown(skier):
            layout.operator("ski.fit_figure", icon="FILE_REFRESH")


class SKI_PT_slope(_Step, bpy.types.Panel):
    """Where it goes down."""

    bl_label = "Slope"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the slope's shape, or the mesh that is the slope."""
        layout, settings = _prepared(self.layout), settings_of(context)
        draw_fields(layout, settings, top_fields(settings, "slope"))
        layout.operator("ski.make_slope", icon="MESH_GRID")
        column = layout.column(align=True)
        column.prop(settings, "slope_mesh", text="Or a Mesh")
        if settings.slope_mesh is not None:
            column.prop(settings, "slope_resolution")
            column.operator("ski.sample_slope", icon="SNAP_FACE")
            if settings.slope_said:
                icon = "ERROR" if settings.slope_failed else "CHECKMARK"
                draw_words(column, settings.slope_said, columns_of(context), icon)
        layout.prop(settings, "start")


class SKI_PT_course(_Step, bpy.types.Panel):
    """Where the skis go."""

    bl_label = "Course"

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the menu of courses."""
        draw_menu_button(self.layout, "courses")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw turns, gates, bumps, path or rhythm, and what the preview says of them."""
        layout, settings = _prepared(self.layout), settings_of(context)
        draw_fields(layout, settings, top_fields(settings, "course"))
        kind = settings.course.kind
        if kind == "gates":
            draw_gates(layout, context, settings)
        if kind in ("path", "follow"):
            layout.prop(settings, "curve")
        if kind == "rhythm":
            draw_rows(layout, settings, "rhythm")
        if kind == "follow":
            draw_rows(layout, settings, "obstacle")
        row = layout.row(align=True)
        row.prop(context.scene, "ski_preview", toggle=True)
        row.prop(context.scene, "ski_preview_figure", toggle=True)
        preview = live.STATE.preview
        if preview is not None and preview.problem:
            draw_words(layout, preview.problem, columns_of(context), "ERROR", alert=True)
        off = "" if preview is None else off_snow_words(preview.off_snow)
        if preview is not None and off and off != preview.problem:
            draw_words(layout, off, columns_of(context), "ERROR")


class SKI_PT_technique(_Step, bpy.types.Panel):
    """How it is skied."""

    bl_label = "Technique"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the menu of styles."""
        draw_menu_button(self.layout, "styles")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the fields of the style."""
        settings = settings_of(context)
        draw_fields(_prepared(self.layout), settings, top_fields(settings, "technique"))


class SKI_PT_snow(_Step, bpy.types.Panel):
    """What the skis run on."""

    bl_label = "Snow"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header_preset(self, _context: bpy.types.Context) -> None:
        """Draw the menu of snow."""
        draw_menu_button(self.layout, "snow")

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the fields of the snow."""
        settings = settings_of(context)
        draw_fields(_prepared(self.layout), settings, top_fields(settings, "snow"))


class SKI_PT_simulate(_Step, bpy.types.Panel):
    """Ski it by physics."""

    bl_label = "Simulate"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw Plan and Simulate with their answers."""
        layout, settings, columns = self.layout, settings_of(context), columns_of(context)
        if settings.figure.kind != PHYSICS_ONLY:
            draw_words(layout, "The physics is for alpine skiers: bake the preview of this figure", columns, "INFO")
            return
        asked = run_hash(settings)
        draw_stage(layout, "ski.plan", "CURVE_PATH", not missing_dependencies())
        draw_result(layout, settings, "plan", asked, columns)
        draw_stage(layout, "ski.simulate", "PHYSICS", not missing_dependencies())
        if settings.recording and not RUNNING.text:
            row = layout.row(align=True)
            row.enabled = not missing_dependencies()
            row.operator("ski.simulate", text="Go On").begin = "END"
            frame = f"From Frame {context.scene.frame_current}"
            row.operator("ski.simulate", text=frame).begin = "FRAME"
        if RUNNING.text:
            draw_progress(layout, columns)
        else:
            draw_result(layout, settings, "simulation", asked, columns)


class SKI_PT_bake(_Step, bpy.types.Panel):
    """Make keyframes of it."""

    bl_label = "Bake"

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the ways to bake and what the last one made."""
        layout, settings, columns = _prepared(self.layout), settings_of(context), columns_of(context)
        draw_fields(layout, settings, top_fields(settings, "bake"))
        draw_part(layout, settings)
        layout.prop(settings, "as_strip")
        column = layout.column(align=True)
        column.prop(settings, "tolerance_deg")
        column.prop(settings, "tolerance_mm")
        column.prop(settings, "tolerance_percent")
        column = layout.column(align=True)
        column.prop(settings, "tracks")
        column.prop(settings, "spray")
        if settings.is_own:
            column = layout.column(align=True)
            for name in ("root_motion", "legs", "equipment"):
                column.prop(settings, name)
        if settings.figure.kind == PHYSICS_ONLY:
            row = layout.column()
            row.scale_y = 1.3
            row.enabled = bool(settings.recording) and not RUNNING.text
            row.operator("ski.bake", icon="KEYFRAME_HLT").source = "SIMULATION"
        row = layout.column()
        row.enabled = not RUNNING.text
        row.operator("ski.bake", text="Bake Preview", icon="KEYFRAME").source = "PREVIEW"
        draw_result(layout, settings, "bake", run_hash(settings), columns)


class SKI_PT_crowd(_Step, bpy.types.Panel):
    """Let many ski it."""

    bl_label = "Crowd"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw how many ski and how they differ, and the buttons with their answer."""
        layout, settings, columns = _prepared(self.layout), settings_of(context), columns_of(context)
        draw_infos(layout, settings, CROWD_TOP)
        draw_stage(layout, "ski.crowd", "COMMUNITY", not missing_dependencies())
        if RUNNING.text:
            draw_progress(layout, columns)
        else:
            draw_result(layout, settings, "crowd", run_hash_at(settings, context.scene), columns)
        row = layout.column()
        row.scale_y = 1.3
        row.enabled = bool(settings.crowd_folder) and not RUNNING.text
        row.operator("ski.bake_crowd", icon="KEYFRAME_HLT")


class SKI_PT_crowd_more(_Step, bpy.types.Panel):
    """How they differ."""

    bl_label = "More"
    bl_parent_id = "SKI_PT_crowd"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw the rest of a crowd's numbers."""
        layout, settings = _prepared(self.layout), settings_of(context)
        rest = [key for key in crowd_table() if key not in CROWD_TOP]
        draw_infos(layout, settings, rest)
        layout.prop(settings, "crowd_jobs")


class SKI_PT_analyse(_Step, bpy.types.Panel):
    """Look into it."""

    bl_label = "Analyse"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        """Draw what shows the recording."""
        layout, settings = self.layout, settings_of(context)
        layout.enabled = bool(settings.recording)
        layout.operator("ski.show_report", icon="IMAGE_DATA")
        layout.operator("ski.toggle_overlay", icon="OVERLAY", depress=live.STATE.overlay == settings.id_data.name)


def draw_infos(layout: Any, settings: Any, keys: Iterable[str]) -> None:
    """Draw keys of a crowd, one under the other."""
    draw_fields(layout, settings, [crowd_table()[key] for key in keys])


def run_hash_at(settings: Any, scene: bpy.types.Scene) -> str:
    """Return the hash of the run that a crowd is asked to ski, at the scene's own frame rate."""
    try:
        return read_spec(settings).with_tables({"bake": {"fps": scene_rate(scene)}}).content_hash()
    except SkiAddonError:
        return ""


def _prepared(layout: Any) -> Any:
    layout.use_property_split = True
    layout.use_property_decorate = False
    return layout


def _preset_name(settings: Any) -> str:
    try:
        return find_preset("runs", settings.preset).name
    except SkiAddonError:
        return "Presets"


def _is_changed(settings: Any) -> bool:
    try:
        return laid_over(RunSpec(), "runs", settings.preset).content_hash() != run_hash(settings)
    except SkiAddonError:
        return False


def _folded(parent: str, sections: tuple[str, ...], level: str, draw_more: Callable[[Any, Any], None] | None) -> type:
    """Return a closed panel within `parent` with the fields of `sections` that are not on top."""
    label = "More" if level == MORE else "Expert"

    def infos(settings: Any) -> list[Any]:
        return [info for section in sections for info in folded_fields(settings, section, level)]

    def poll(_cls: type, context: Any) -> bool:
        skier = skier_of(context)
        if skier is None or (level == EXPERT and not is_expert(context)):
            return False
        return draw_more is not None or bool(infos(skier.ski))

    def draw(self: Any, context: Any) -> None:
        settings, layout = settings_of(context), _prepared(self.layout)
        draw_fields(layout, settings, infos(settings))
        if draw_more is not None:
            draw_more(layout, settings)

    name = f"{parent}_{level}"
    content = {
        "__doc__": f"{label} of it.",
        "bl_label": label,
        "bl_parent_id": parent,
        "bl_options": {"DEFAULT_CLOSED"},
        "poll": classmethod(poll),
        "draw": draw,
    }
    return type(name, (_InTab, bpy.types.Panel), content)


def _draw_pushes(layout: Any, settings: Any) -> None:
    layout.label(text=row_kinds()["push"].label)
    draw_rows(layout, settings, "push")


CLASSES = (
    *MENUS,
    SKI_UL_rows,
    SKI_UL_bones,
    SKI_PT_skier,
    _folded("SKI_PT_skier", ("figure", "skier"), MORE, None),
    _folded("SKI_PT_skier", ("figure", "skier"), EXPERT, None),
    SKI_PT_slope,
    _folded("SKI_PT_slope", ("slope",), MORE, None),
    _folded("SKI_PT_slope", ("slope",), EXPERT, None),
    SKI_PT_course,
    _folded("SKI_PT_course", ("course",), MORE, None),
    _folded("SKI_PT_course", ("course",), EXPERT, None),
    SKI_PT_technique,
    _folded("SKI_PT_technique", ("technique",), MORE, None),
    _folded("SKI_PT_technique", ("technique",), EXPERT, None),
    SKI_PT_snow,
    _folded("SKI_PT_snow", ("snow",), MORE, None),
    _folded("SKI_PT_snow", ("snow",), EXPERT, None),
    SKI_PT_simulate,
    _folded("SKI_PT_simulate", ("simulation",), EXPERT, _draw_pushes),
    SKI_PT_bake,
    _folded("SKI_PT_bake", ("bake",), MORE, None),
    _folded("SKI_PT_bake", ("bake",), EXPERT, None),
    SKI_PT_crowd,
    SKI_PT_crowd_more,
    SKI_PT_analyse,
)


def register() -> None:
    """Add the tab."""
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Take the tab away."""
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
