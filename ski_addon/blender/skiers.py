"""Skiers of a scene: armatures that carry the settings of a run, made here or the user's own."""

from __future__ import annotations

import bpy
import numpy as np

from ..body import build_skeleton
from ..errors import SkiAddonError, SpecError
from ..spec import RunSpec
from ..turning.figures import build_figure as build_model
from .bake import fits, mark_skier, new_skier
from .figures import figure_fits, mark_figure, new_figure
from .properties import DEFAULT_PRESET, preset_specs, read_spec, write_spec
from .rig import refit
from .skier.figure import Figure, build_figure, figure_of

START_SIZE = 1.5
"""Size of the arrows that show where a run starts [m]."""


def add_skier(scene: bpy.types.Scene, spec: RunSpec | None = None, preset: str = DEFAULT_PRESET) -> bpy.types.Object:
    """Make a skier for `spec` (default: the shipped run `preset`) at the 3D cursor and return its armature."""
    spec = spec or preset_specs()[preset]
    armature = new_skier(spec.skier, build_skeleton(spec.skier), scene) if _alpine(spec) else _new_figure(spec, scene)
    _settle(armature, spec, preset, scene)
    armature.parent = armature.ski.start  # so that the baked motion goes with it
    bpy.context.view_layer.update()
    return armature


def adopt_armature(armature: bpy.types.Object, scene: bpy.types.Scene, preset: str = DEFAULT_PRESET) -> None:
    """Make the user's own `armature` a skier with the run `preset`; raises `SpecError` if it cannot be one."""
    if armature.type != "ARMATURE":
        raise SpecError(armature.name, armature.type, "ARMATURE", "select an armature", problem="is not an")
    if armature.library is not None or not armature.is_editable:
        hint = "make a library override of it first"
        raise SpecError(armature.name, problem="is linked from another file and cannot be changed", hint=hint)
    _settle(armature, preset_specs()[preset], preset, scene)
    armature.ski.is_own = True


def fit_figure(armature: bpy.types.Object, spec: RunSpec) -> bool:
    """Rebuild a skier made here whose person or gear are others than those of `spec`; return whether it was needed."""
    if armature.ski.is_own or wears(armature, spec):
        return False
    refit(armature, figure_for(spec))
    for key in [key for key in list(armature.data.keys()) if key.startswith("ski_")]:
        del armature.data[key]
    if _alpine(spec):
        mark_skier(armature, spec.skier)
    else:
        mark_figure(armature, spec)
    return True


def wears(armature: bpy.types.Object, spec: RunSpec) -> bool:
    """Return whether `armature` is a figure with just the person and the gear of `spec`."""
    return fits(armature, spec.skier) if _alpine(spec) else figure_fits(armature, spec)


def wears_shown(armature: bpy.types.Object) -> bool:
    """Return whether a skier made here is what its settings ask for; what cannot be read asks for nothing."""
    try:
        return bool(armature.ski.is_own) or wears(armature, read_spec(armature.ski))
    except SkiAddonError:
        return True


def figure_for(spec: RunSpec) -> Figure:
    """Return the figure, of any kind, that `spec` asks for."""
    return build_figure(build_skeleton(spec.skier)) if _alpine(spec) else figure_of(build_model(spec))


def _alpine(spec: RunSpec) -> bool:
    return spec.figure.kind == "alpine"


def _new_figure(spec: RunSpec, scene: bpy.types.Scene) -> bpy.types.Object:
    return new_figure(build_model(spec), spec, scene)


def _settle(armature: bpy.types.Object, spec: RunSpec, preset: str, scene: bpy.types.Scene) -> None:
    """Give `armature` settings and a start object of its own, and show it."""
    settings = armature.ski
    settings.is_skier, settings.preset = True, preset
    start = bpy.data.objects.new(f"{armature.name} start", None)
    start.empty_display_type, start.empty_display_size = "ARROWS", START_SIZE
    start.lock_rotation, start.lock_scale = (True, True, False), (True, True, True)
    start.location = scene.cursor.location if np.all(np.isfinite(scene.cursor.location)) else (0.0, 0.0, 0.0)
    collections = armature.users_collection or (scene.collection,)
    collections[0].objects.link(start)
    settings.start = start
    write_spec(settings, spec)
    scene.ski_skier = armature
