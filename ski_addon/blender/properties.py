"""`scene.ski`: the run document as Blender properties, and what the last plan, simulation and bake said.

The groups are made from the table of the run document's keys, so the sidebar, the presets and the command line have
the same names, ranges and explanations.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import bpy

from ..spec import SECTIONS, RunSpec, field_table, list_presets, row_kinds, section_fields
from ..spec.document import parse_document, write_document
from ..spec.table import get_value
from .fields import make_properties, read_field, write_field

DEFAULT_PRESET = "giant_slalom"
STAGES = ("plan", "simulation", "bake")
"""Stages that keep the hash of the run they were made from and what they said, as `<stage>_hash` and `<stage>_text`."""


@cache
def preset_specs() -> dict[str, RunSpec]:
    """Return the shipped runs by the names of their files."""
    return {preset.identifier: RunSpec.from_toml(preset.path) for preset in list_presets("runs")}


def read_spec(settings: Any) -> RunSpec:
    """Return the run that `scene.ski` asks for; raises `SpecError`."""
    content: dict[str, Any] = {"name": settings.run_name, "description": settings.run_description}
    for section in SECTIONS:
        group = getattr(settings, section)
        content[section] = {info.name: read_field(group, info) for info in section_fields(section)}
    rows = parse_document(settings.rows, "the rows of this scene").content
    return RunSpec.from_dict({**content, **rows})


def write_spec(settings: Any, spec: RunSpec) -> None:
    """Set `scene.ski` to ask for the run `spec`."""
    settings.run_name, settings.run_description = spec.name, spec.description
    settings.rows = _rows_text(spec)
    for info in field_table().values():
        if info.section:
            write_field(getattr(settings, info.section), info, get_value(spec, info.key))


def _rows_text(spec: RunSpec) -> str:
    """Return the rows of a run (gates, points, pushes) as TOML; the sidebar carries them along as they are."""
    return write_document({key: rows for key, rows in spec.to_dict().items() if key in row_kinds()})


def _apply_preset(settings: Any, _context: Any) -> None:
    spec = preset_specs().get(settings.preset)
    if spec is not None:
        write_spec(settings, spec)


def _is_armature(_settings: Any, obj: bpy.types.Object) -> bool:
    return obj.type == "ARMATURE"


def _section_group(section: str, spec: RunSpec) -> type:
    """Return a new property group of one section with the values of `spec` as defaults."""
    annotations: dict[str, Any] = {}
    for info in section_fields(section):
        annotations |= make_properties(info, get_value(spec, info.key))
    group = type(f"SKI_PG_{section}", (bpy.types.PropertyGroup,), {"__doc__": f"The section [{section}] of a run."})
    group.__annotations__ = annotations
    return group


def _settings_group(groups: dict[str, type], spec: RunSpec) -> type:
    """Return the property group of `scene.ski`."""
    items = [(name, run.name, run.description) for name, run in preset_specs().items()]
    annotations: dict[str, Any] = {
        "preset": bpy.props.EnumProperty(
            name="Preset", description="Set everything below as in this run", items=items, default=DEFAULT_PRESET,
            update=_apply_preset,
        ),
        "run_name": bpy.props.StringProperty(name="Name", default=spec.name, maxlen=120),
        "run_description": bpy.props.StringProperty(name="Description", default=spec.description, maxlen=2000),
        "rows": bpy.props.StringProperty(name="Rows", default=_rows_text(spec), options={"HIDDEN"}),
        "armature": bpy.props.PointerProperty(
            name="Skier", description="The skier that was baked last; baking again replaces its keys",
            type=bpy.types.Object, poll=_is_armature,
        ),
        "ground": bpy.props.PointerProperty(name="Ground", type=bpy.types.Collection),
        "recording": bpy.props.StringProperty(name="Recording"),
    }  # fmt: skip
    annotations |= {name: bpy.props.PointerProperty(type=group) for name, group in groups.items()}
    for stage in STAGES:
        annotations[f"{stage}_hash"] = bpy.props.StringProperty()
        annotations[f"{stage}_text"] = bpy.props.StringProperty()
        annotations[f"{stage}_failed"] = bpy.props.BoolProperty()
    settings = type("SKI_PG_settings", (bpy.types.PropertyGroup,), {"__doc__": "One run, and how far it has come."})
    settings.__annotations__ = annotations
    return settings


def tell(settings: Any, stage: str, spec: RunSpec, lines: list[str], *, failed: bool = False) -> None:
    """Keep what `stage` said about the run `spec`, to be shown in the sidebar."""
    setattr(settings, f"{stage}_hash", spec.content_hash())
    setattr(settings, f"{stage}_text", "\n".join(lines))
    setattr(settings, f"{stage}_failed", failed)


_classes: list[type] = []


def register() -> None:
    """Make the groups and add `ski` to every scene."""
    spec = preset_specs()[DEFAULT_PRESET]
    groups = {section: _section_group(section, spec) for section in SECTIONS}
    _classes.extend(groups.values())
    for group in _classes:
        bpy.utils.register_class(group)
    settings = _settings_group(groups, spec)
    bpy.utils.register_class(settings)
    _classes.append(settings)
    bpy.types.Scene.ski = bpy.props.PointerProperty(type=settings)


def unregister() -> None:
    """Take `ski` from the scenes again."""
    del bpy.types.Scene.ski
    while _classes:
        bpy.utils.unregister_class(_classes.pop())
