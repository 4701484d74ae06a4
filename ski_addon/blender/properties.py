"""`armature.ski`: the run of one skier as Blender properties, and what its last plan, simulation and bake said.

The settings live on the skier's armature, so that a scene has as many skiers as it likes and a linked or appended one
brings its own. The groups are made from the table of the run document's keys, so the sidebar, the presets and the
command line have the same names, ranges and explanations.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import bpy

from ..crowd.crowd_spec import SECTIONS as CROWD_SECTIONS
from ..crowd.crowd_spec import section_fields as crowd_fields
from ..errors import SpecError
from ..spec import SECTIONS, RunSpec, field_table, list_presets, row_kinds, section_fields
from ..spec.document import parse_document, write_document
from ..spec.table import get_value
from . import changes
from .bone_tables import bone_group
from .course_objects import curve_points, gate_group, gate_rows
from .fields import make_properties, read_field, write_field
from .rows import LISTED, read_rows, row_group, write_rows

DEFAULT_PRESET = "giant_slalom"
STAGES = ("plan", "simulation", "bake", "crowd")
"""Stages that keep the hash of the run they were made from and what they said, as `<stage>_hash` and `<stage>_text`."""


@cache
def preset_specs() -> dict[str, RunSpec]:
    """Return the shipped runs by the names of their files."""
    return {preset.identifier: RunSpec.from_toml(preset.path) for preset in list_presets("runs")}


def read_spec(settings: Any) -> RunSpec:
    """Return the run that a skier's settings ask for, its gates and path from the scene; raises `SpecError`."""
    content: dict[str, Any] = {"name": settings.run_name, "description": settings.run_description}
    content |= {section: _read_section(settings, section) for section in SECTIONS}
    content |= parse_document(settings.rows, "the points of this skier").content
    for kind in LISTED:
        rows = read_rows(settings, kind)
        if rows:
            content[kind] = rows
    return RunSpec.from_dict({**content, **_of_scene(settings)})


def read_slope(settings: Any) -> RunSpec:
    """Return a run of which only the slope is that of the settings: it can be read while a course is half set."""
    return RunSpec.from_dict({"slope": _read_section(settings, "slope")})


def _read_section(settings: Any, section: str) -> dict[str, Any]:
    group = getattr(settings, section)
    return {info.name: read_field(group, info) for info in section_fields(section)}


def _of_scene(settings: Any) -> dict[str, Any]:
    """Return the rows of the gates that stand in the scene, or of the path that a curve draws there."""
    course = settings.course
    if course.kind == "gates" and course.gate_setting == "list":
        gates = gate_rows(settings, read_slope(settings))
        return {} if gates is None else {"gate": gates}
    if course.kind in ("path", "follow"):
        points = curve_points(settings, read_slope(settings))
        return {} if points is None else {"point": points}
    return {}


def write_spec(settings: Any, spec: RunSpec) -> None:
    """Set a skier's settings to ask for the run `spec`; gates and curves that stand in the scene stay there."""
    with changes.held():
        settings.run_name, settings.run_description = spec.name, spec.description
        rows = {key: rows for key, rows in spec.to_dict().items() if key in row_kinds()}
        for kind in LISTED:
            write_rows(settings, kind, rows.pop(kind, []))
        settings.rows = write_document(rows)
        for info in field_table().values():
            if info.section:
                write_field(getattr(settings, info.section), info, get_value(spec, info.key))
    changes.changed(settings)


def run_hash(settings: Any) -> str:
    """Return the hash of the run that the settings ask for, or nothing where they ask for none that can be."""
    try:
        return read_spec(settings).content_hash()
    except SpecError:
        return ""


def tell(settings: Any, stage: str, spec: RunSpec, lines: list[str], *, failed: bool = False) -> None:
    """Keep what `stage` said about the run `spec`, to be shown in the sidebar."""
    setattr(settings, f"{stage}_hash", spec.content_hash())
    setattr(settings, f"{stage}_text", "\n".join(lines))
    setattr(settings, f"{stage}_failed", failed)


def _changed(group: Any, _context: Any) -> None:
    changes.changed(group.id_data.ski)


def _shown_changed(scene: Any, _context: Any) -> None:
    changes.changed(scene)


def _gate_changed(group: Any, context: Any) -> None:
    """Tell whoever shows the run of which a gate is."""
    gate = group.id_data
    for obj in context.scene.objects:
        if is_skier(None, obj) and obj.ski.gates is not None and gate.name in obj.ski.gates.all_objects:
            changes.changed(obj.ski)


def _section_group(section: str, spec: RunSpec) -> type:
    """Return a new property group of one section with the values of `spec` as defaults."""
    annotations: dict[str, Any] = {}
    for info in section_fields(section):
        annotations |= make_properties(info, get_value(spec, info.key), _changed)
    group = type(f"SKI_PG_{section}", (bpy.types.PropertyGroup,), {"__doc__": f"The section [{section}] of a run."})
    group.__annotations__ = annotations
    return group


def _crowd_group(section: str) -> type:
    """Return a new property group of one section of a crowd document."""
    annotations: dict[str, Any] = {}
    for info in crowd_fields(section):
        annotations |= make_properties(info, info.default)
    name = f"SKI_PG_crowd_{section}"
    group = type(name, (bpy.types.PropertyGroup,), {"__doc__": f"The section [{section}] of a crowd."})
    group.__annotations__ = annotations
    return group


def _is_curve(_settings: Any, obj: bpy.types.Object) -> bool:
    return obj.type == "CURVE"


def _is_mesh(_settings: Any, obj: bpy.types.Object) -> bool:
    return obj.type == "MESH"


def is_skier(_owner: Any, obj: bpy.types.Object) -> bool:
    """Return whether `obj` is an armature with a run of its own."""
    return obj.type == "ARMATURE" and obj.ski.is_skier


def _scene_properties() -> dict[str, Any]:
    """Return the properties of a skier's settings that name objects of the scene."""
    string, pointer = bpy.props.StringProperty, bpy.props.PointerProperty
    return {
        "start": pointer(
            name="Start", description="Where the run starts, its arrow X down the fall line; move it to move the run",
            type=bpy.types.Object,
        ),
        "curve": pointer(
            name="Curve", description="A curve of the scene whose course is the path, or with a gate at each point",
            type=bpy.types.Object, poll=_is_curve, update=_changed,
        ),
        "slope_mesh": pointer(
            name="Mesh", description="A mesh of the scene that is the slope",
            type=bpy.types.Object, poll=_is_mesh,
        ),
        "slope_resolution": bpy.props.FloatProperty(
            name="Resolution", description="Distance between the heights taken from the mesh; 0 = chosen by its faces",
            default=0.0, min=0.0, max=20.0, unit="LENGTH",
        ),
        "slope_said": string(name="Sampled", options={"HIDDEN"}),
        "slope_failed": bpy.props.BoolProperty(options={"HIDDEN"}),
    }  # fmt: skip


def _bake_properties() -> dict[str, Any]:
    """Return the properties that say how a run is baked in Blender, beyond the run document's own."""
    return {
        "as_strip": bpy.props.BoolProperty(
            name="As NLA Strip", description="Make a strip on a track of its own instead of the active action",
        ),
        "tolerance_deg": bpy.props.FloatProperty(
            name="Fewer Keys", description="Leave out keys that deviate by less than so many degrees; 0 = keep all",
            default=0.0, min=0.0, max=10.0,
        ),
        "tolerance_mm": bpy.props.FloatProperty(
            name="and Millimetres", description="Leave out keys of places that deviate by less; 0 = keep all",
            default=0.0, min=0.0, max=100.0,
        ),
        "tolerance_percent": bpy.props.FloatProperty(
            name="and Percent",
            description="Leave out keys of animated numbers (speed, angles, forces) that deviate by less than so many "
            "percent of the range that the number has in the run; 0 = keep all",
            default=0.0, min=0.0, max=20.0,
        ),
        "part": bpy.props.EnumProperty(
            name="Part of the Run",
            description="What gets keys; slope and tracks are always those of the whole run",
            items=[("WHOLE", "Whole Run", "From the start to the end"),
                   ("SECONDS", "Seconds", "From one second of the run to another"),
                   ("FRAMES", "Frames", "From one frame of the scene to another; the run stays at the frames it has")],
        ),
        "part_begin": bpy.props.FloatProperty(
            name="Begin", description="Where the part begins, from the start of the run", min=0.0, max=3600.0,
            unit="TIME_ABSOLUTE",
        ),
        "part_end": bpy.props.FloatProperty(
            name="End", description="Where the part ends; 0 = at the end of the run", min=0.0, max=3600.0,
            unit="TIME_ABSOLUTE",
        ),
        "part_first": bpy.props.IntProperty(name="First", description="First frame that is baked", default=1),
        "part_last": bpy.props.IntProperty(name="Last", description="Last frame that is baked", default=100),
        "tracks": bpy.props.EnumProperty(
            name="Ski Tracks", description="What the skis leave in the snow",
            items=[("mesh", "Mesh", "Grooves that can be seen"), ("curve", "Curves", "Curves as wide as the tracks"),
                   ("none", "None", "No tracks")],
        ),
        "spray": bpy.props.BoolProperty(
            name="Snow Spray",
            description="An emitter at the outside ski with a keyed strength, to drive particles of your own with",
        ),
        "root_motion": bpy.props.EnumProperty(
            name="Root Motion", description="What carries your character down the slope",
            items=[("pelvis", "Hips", "The hips' bone alone"), ("bone", "Root Bone", "The bone at the root"),
                   ("object", "Object", "The armature object itself")],
        ),
        "legs": bpy.props.EnumProperty(
            name="Legs", description="What is kept where your character has other proportions than the skier",
            items=[("reach", "Feet on Skis", "The feet stay on the skis, the knees bend as they must"),
                   ("angles", "Joint Angles", "Every angle stays, the feet may leave the skis a little")],
        ),
        "equipment": bpy.props.EnumProperty(
            name="Skis and Poles", description="Whether skis and poles are made for your character",
            items=[("objects", "As Objects", "Skis and poles of their own, keyed"), ("none", "None", "No gear")],
        ),
    }  # fmt: skip


def _settings_group(groups: dict[str, type], lists: dict[str, type], bones: type, spec: RunSpec) -> type:
    """Return the property group of `armature.ski`."""
    string, pointer = bpy.props.StringProperty, bpy.props.PointerProperty
    annotations: dict[str, Any] = {
        "is_skier": bpy.props.BoolProperty(name="Is a Skier", options={"HIDDEN"}),
        "is_own": bpy.props.BoolProperty(name="Is an Armature of the User", options={"HIDDEN"}),
        "preset": string(name="Preset", description="The preset that was chosen last", options={"HIDDEN"}),
        "run_name": string(name="Name", description="Name of the run", default=spec.name, maxlen=120),
        "run_description": string(name="Description", default=spec.description, maxlen=2000),
        "rows": string(name="Points", options={"HIDDEN"}),
        "ground": pointer(name="Ground", type=bpy.types.Collection),
        "gates": pointer(name="Gates", type=bpy.types.Collection),
        "recording": string(name="Recording", options={"HIDDEN"}),
        "crowd_folder": string(name="Crowd's Recordings", options={"HIDDEN"}),
        "crowd_collection": pointer(name="Crowd", type=bpy.types.Collection),
        "crowd_ground": pointer(name="Crowd's Ground", type=bpy.types.Collection),
        "crowd_jobs": bpy.props.IntProperty(
            name="Processes", description="How many simulate at the same time; 0 = as many as there are processors",
            default=0, min=0, max=64,
        ),
    }  # fmt: skip
    annotations |= _scene_properties() | _bake_properties()
    annotations |= {name: pointer(type=group) for name, group in groups.items()}
    annotations["bones"] = bpy.props.CollectionProperty(name="Bones", type=bones)
    annotations["bones_index"] = bpy.props.IntProperty(options={"HIDDEN"})
    annotations["bone_map"] = string(name="Bone Map", options={"HIDDEN"})
    for kind, group in lists.items():
        annotations[kind] = bpy.props.CollectionProperty(name=row_kinds()[kind].label, type=group)
        annotations[f"{kind}_index"] = bpy.props.IntProperty(options={"HIDDEN"})
    for stage in STAGES:
        annotations[f"{stage}_hash"] = string(options={"HIDDEN"})
        annotations[f"{stage}_text"] = string(options={"HIDDEN"})
        annotations[f"{stage}_failed"] = bpy.props.BoolProperty(options={"HIDDEN"})
    settings = type("SKI_PG_settings", (bpy.types.PropertyGroup,), {"__doc__": "One run, and how far it has come."})
    settings.__annotations__ = annotations
    return settings


_classes: list[type] = []


def register() -> None:
    """Make the groups, add `ski` to every object and `ski_skier`, the one shown in the sidebar, to every scene."""
    spec = RunSpec()  # reading the presets takes longer than all of this
    groups = {section: _section_group(section, spec) for section in SECTIONS}
    groups |= {section: _crowd_group(section) for section in CROWD_SECTIONS}
    lists = {kind: row_group(kind, _changed) for kind in LISTED}
    bones = bone_group()
    settings = _settings_group(groups, lists, bones, spec)
    gate = gate_group(_gate_changed)
    for group in (*groups.values(), *lists.values(), bones, gate, settings):
        bpy.utils.register_class(group)
        _classes.append(group)
    bpy.types.Object.ski = bpy.props.PointerProperty(type=settings)
    bpy.types.Object.ski_gate = bpy.props.PointerProperty(type=gate)
    _register_scene()


def _register_scene() -> None:
    """Add to every scene what the tab shows."""
    bpy.types.Scene.ski_preview = bpy.props.BoolProperty(
        name="Preview", description="Draw the planned track over the slope while anything changes", default=True,
        update=_shown_changed,
    )  # fmt: skip
    bpy.types.Scene.ski_preview_figure = bpy.props.BoolProperty(
        name="Figure", description="Let the instant figure move along the track with the timeline", default=True,
        update=_shown_changed,
    )  # fmt: skip
    bpy.types.Scene.ski_skier = bpy.props.PointerProperty(
        name="Skier", description="The skier whose run the tab shows while no skier is selected",
        type=bpy.types.Object, poll=is_skier, update=_shown_changed,
    )  # fmt: skip


def unregister() -> None:
    """Take everything from objects and scenes again."""
    for name in ("ski_skier", "ski_preview_figure", "ski_preview"):
        delattr(bpy.types.Scene, name)
    del bpy.types.Object.ski_gate
    del bpy.types.Object.ski
    while _classes:
        bpy.utils.unregister_class(_classes.pop())
