"""Figures of the instant preview in Blender: their armatures, and their motion as keyframes, for any kind."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..animation.bone_map import BoneEntry, BoneMap
from ..spec import BakeSpec, RunSpec
from ..turning.figures import build_figure, figure_channels, figure_poses
from .bake import BakeResult, bake_poses, scene_rate
from .rig import build_figure_rig
from .skier.figure import figure_of

if TYPE_CHECKING:
    import bpy

    from ..turning.figures import FigureModel
    from ..turning.motion import TurningMotion

FIGURE_PROPERTY = "ski_figure"
"""Custom property of an armature's data: the person and gear that it was made for."""


def figure_bone_map(model: FigureModel) -> BoneMap:
    """Return the table of a figure's own armature: every bone follows the body of its name."""
    entries = tuple(BoneEntry(name, name, name in model.free) for name in model.body_names)
    return BoneMap(f"Ski Addon {model.kind}", entries)


def bake_figure(
    model: FigureModel,
    spec: RunSpec,
    motion: TurningMotion,
    scene: bpy.types.Scene,
    *,
    armature: bpy.types.Object | None = None,
    options: BakeSpec | None = None,
) -> BakeResult:
    """Bake `motion` of the figure `model` in `scene`, at the scene's own frame rate, onto `armature` (default: new).

    `options` (default: those of `spec`) give keys per frame, first frame and the action's name. As `bake_recording`
    it sets the frame range of scene and action, replaces the keys of an earlier bake, and touches nothing else.
    """
    options = options or spec.bake
    poses = figure_poses(model, spec, motion, scene_rate(scene), options.subframes, options.frame_start)
    channels = figure_channels(model, spec, motion, poses.time)
    if armature is None:
        armature = new_figure(model, spec, scene)
    return bake_poses(poses, channels, armature, figure_of(model), figure_bone_map(model), scene, options.action)


def new_figure(model: FigureModel, spec: RunSpec, scene: bpy.types.Scene) -> bpy.types.Object:
    """Make a figure in `scene` and return its armature."""
    armature = build_figure_rig(model, scene).armature
    armature.data[FIGURE_PROPERTY] = _measures(model, spec)
    return armature


def figure_fits(armature: bpy.types.Object, spec: RunSpec) -> bool:
    """Return whether `armature` is a figure made with just the person and the gear of `spec`."""
    if armature.type != "ARMATURE":
        return False
    measures = armature.data.get(FIGURE_PROPERTY)
    return measures is not None and measures.to_dict() == _measures(build_figure(spec), spec)


def _measures(model: FigureModel, spec: RunSpec) -> dict[str, float | str]:
    return {"kind": model.kind, **spec.to_dict()["skier"], **{f"gear {key}": v for key, v in model.sizes.items()}}
