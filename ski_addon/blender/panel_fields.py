"""Fields of a run in the sidebar: which are on top, which are folded away, and how one, or a list of rows, is drawn."""

from __future__ import annotations

from typing import Any

from ..spec import FieldInfo, row_kinds, section_fields
from ..spec.fields import PLACES
from .fields import WORD_SUFFIX

TOP = {
    "figure": ("kind",),
    "skier": ("height", "mass", "sex"),
    "slope": (
        *("kind", "angle_deg", "bump_count", "bump_height", "bump_width"),
        *("mogul_count", "mogul_height", "mogul_spacing", "grid_file"),
    ),
    "course": (
        *("kind", "turn_count", "turn_radius", "turn_duration", "transition_duration"),
        *("gate_setting", "gate_count", "gate_spacing", "gate_offset"),
        *("turn_amplitude", "pace", "path_shape", "start_speed", "first_turn", "finish"),
    ),
    "technique": ("angulation", "speed_limit", "knee_bend_deg", "absorption", "tuck"),
    "snow": ("friction",),
    "bake": ("frame_start", "action"),
}
"""The fields of each section that matter most, in the order of the tab."""
SLOPE_KINDS = {"bump_": ("bumps",), "mogul_": ("moguls",), "grid_": ("grid",), "bump_start": ("bumps", "moguls")}
"""Kinds of ground for which a field of the slope counts, by its name or how it begins."""
HIDDEN = {"bake.fps"}
"""Fields that Blender has its own word for: the scene's frame rate."""
MORE, EXPERT = "more", "expert"


def top_fields(settings: Any, section: str) -> list[FieldInfo]:
    """Return the fields of a section that are on top and count for its kind."""
    known = {info.name: info for info in section_fields(section)}
    return [known[name] for name in TOP.get(section, ()) if counts(settings, known[name])]


def folded_fields(settings: Any, section: str, level: str) -> list[FieldInfo]:
    """Return the other fields of a section that count: `MORE`, or those for experts (`EXPERT`)."""
    top = TOP.get(section, ())
    return [
        info
        for info in section_fields(section)
        if info.name not in top
        and info.key not in HIDDEN
        and info.advanced == (level == EXPERT)
        and counts(settings, info)
    ]


def counts(settings: Any, info: FieldInfo) -> bool:
    """Return whether a field does anything for the kind of its section that is chosen."""
    if info.section == "slope":
        begins = info.name.partition("_")[0] + "_"
        kinds = SLOPE_KINDS.get(info.name, SLOPE_KINDS.get(begins, ()))
    else:
        kinds = info.kinds
    gates = info.name.startswith("gate_") and info.name in ("gate_count", "gate_spacing", "gate_offset")
    if gates and settings.course.gate_setting == "list":
        return False
    return not kinds or getattr(settings, info.section).kind in kinds


def draw_fields(layout: Any, settings: Any, infos: list[FieldInfo]) -> None:
    """Draw fields one under the other."""
    column = layout.column(align=True)
    for info in infos:
        draw_field(column, getattr(settings, info.section), info)


def draw_field(column: Any, group: Any, info: FieldInfo) -> None:
    """Draw one field of `group`; a number with a word has a switch for that beside it."""
    if not info.word:
        column.prop(group, info.name)
        return
    row = column.row(align=True)
    value = row.row(align=True)
    value.enabled = not getattr(group, info.name + WORD_SUFFIX)
    value.prop(group, info.name)
    row.prop(group, info.name + WORD_SUFFIX, toggle=True)


def draw_rows(layout: Any, settings: Any, kind: str) -> None:
    """Draw the list of the rows of a `kind`, buttons to add and remove one, and the fields of the chosen one."""
    items, chosen = getattr(settings, kind), getattr(settings, f"{kind}_index")
    row = layout.row()
    row.template_list("SKI_UL_rows", kind, settings, kind, settings, f"{kind}_index", rows=3)
    buttons = row.column(align=True)
    buttons.operator("ski.add_row", text="", icon="ADD").kind = kind
    buttons.operator("ski.remove_row", text="", icon="REMOVE").kind = kind
    if 0 <= chosen < len(items):
        column = layout.column(align=True)
        for info in row_kinds()[kind].row_fields:
            draw_field(column, items[chosen], info)


def row_words(item: Any, kind: str) -> str:
    """Return what a row is in a few words, for its list."""
    words = []
    for info in row_kinds()[kind].row_fields:
        if info.word and getattr(item, info.name + WORD_SUFFIX):
            continue
        value = getattr(item, info.name)
        if info.kind == PLACES or (info.name == "name" and not value):
            continue
        if isinstance(value, float):
            degrees = info.unit == "deg"
            value = f"{value * 57.29578:.3g}\N{DEGREE SIGN}" if degrees else f"{value:.4g} {info.unit}"
        words.append(str(value))
    return ", ".join(words[:4])
