"""Figures of the instant preview in Blender: their motion as keyframes, and whole files and pictures of it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from ..frames import Array
from ..spec import BakeSpec, RunSpec
from ..terrain import build_terrain
from ..turning.figures import build_figure, figure_channels, figure_poses
from ..turning.preview import preview_motion
from .bake import BakeResult, bake_poses, scene_rate
from .fewer_keys import KeyOptions
from .ground import Place, renew_ground
from .ride import figure_bone_map, instant_ride
from .rig import build_figure_rig
from .skier.figure import figure_of
from .strobe import render_ride

if TYPE_CHECKING:
    import bpy

    from ..animation.poses import BodyPoses
    from ..turning.figures import FigureModel
    from ..turning.motion import TurningMotion

FIGURE_PROPERTY = "ski_figure"
"""Custom property of an armature's data: the person and gear that it was made for."""


def bake_figure(
    model: FigureModel,
    spec: RunSpec,
    motion: TurningMotion,
    scene: bpy.types.Scene,
    *,
    armature: bpy.types.Object | None = None,
    options: BakeSpec | None = None,
    world_from_run: Array | None = None,
    keys: KeyOptions | None = None,
) -> BakeResult:
    """Bake `motion` of the figure `model` in `scene`, at the scene's own frame rate, onto `armature` (default: new).

    `options` (default: those of `spec`) give keys per frame, first frame and the action's name. As `bake_recording`
    it sets the frame range of scene and action, replaces the keys of an earlier bake, and touches nothing else.
    """
    options, keys = options or spec.bake, keys or KeyOptions()
    poses = instant_poses(model, spec, motion, scene_rate(scene), options).within(keys.span)
    channels = figure_channels(model, spec, motion, poses.time)
    poses = poses.moved(world_from_run)
    if armature is None:
        armature = new_figure(model, spec, scene)
    return bake_poses(poses, channels, armature, figure_of(model), figure_bone_map(model), scene, options.action, keys)


def instant_poses(
    model: FigureModel, spec: RunSpec, motion: TurningMotion, rate: float, options: BakeSpec
) -> BodyPoses:
    """Return the poses of the figure `model` on its ground at the keys that `options` ask for, in the run's frame."""
    terrain = build_terrain(spec.slope)
    return figure_poses(model, spec, motion, rate, options.subframes, options.frame_start, terrain=terrain)


def new_figure(model: FigureModel, spec: RunSpec, scene: bpy.types.Scene) -> bpy.types.Object:
    """Make a figure in `scene` and return its armature."""
    armature = build_figure_rig(model, scene).armature
    mark_figure(armature, spec)
    return armature


def mark_figure(armature: bpy.types.Object, spec: RunSpec) -> None:
    """Note in `armature` for which person and gear it was made; see `figure_fits`."""
    armature.data[FIGURE_PROPERTY] = _measures(build_figure(spec), spec)


def figure_fits(armature: bpy.types.Object, spec: RunSpec) -> bool:
    """Return whether `armature` is a figure made with just the person and the gear of `spec`."""
    if armature.type != "ARMATURE":
        return False
    measures = armature.data.get(FIGURE_PROPERTY)
    return measures is not None and measures.to_dict() == _measures(build_figure(spec), spec)


def _measures(model: FigureModel, spec: RunSpec) -> dict[str, float | str]:
    return {"kind": model.kind, **spec.to_dict()["skier"], **{f"gear {key}": v for key, v in model.sizes.items()}}


def preview_file(spec: RunSpec, motion: TurningMotion, target: str | Path) -> Path:
    """Write `target`, a new .blend with the figure of `spec` in `motion`, its ground and a camera, in one step.

    Raises `BlenderMissingError` or `OutputError`. The open file is closed.
    """
    from .headless import write_file

    model = build_figure(spec)
    ride = instant_ride(model, spec, motion)
    return write_file(ride, spec, target, lambda scene: bake_figure(model, spec, motion, scene))


def preview_picture(spec: RunSpec, motion: TurningMotion, target: str | Path) -> Path:
    """Write `target`, one picture of the ground with the figure of `spec` at several instants of `motion`."""
    return render_ride(instant_ride(build_figure(spec), spec, motion), spec, target)


def instant_ground(
    spec: RunSpec,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection | None,
    place: Place | None = None,
) -> bpy.types.Collection:
    """Put the slope of `spec`, with the tracks of its preview, into `collection`; see `renew_ground`."""
    ride = instant_ride(build_figure(spec), spec, preview_motion(spec))
    return renew_ground(ride, spec, scene, collection, spec.bake, place)
