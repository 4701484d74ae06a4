"""Everything that Bake does to a scene: the skier's keys, and slope, tracks and gates around it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import bpy

from ..animation.span import FRAMES, SECONDS, Part
from ..body import build_skeleton
from ..errors import SpecError
from ..spec import BakeSpec, RunSpec
from ..turning.figures import build_figure, figure_channels
from ..turning.preview import preview_motion
from .armatures import ArmatureBake, ArmatureOptions, BakedRun, bake_on_armature, lay_on_armature
from .bake import BakeResult, bake_recording, recorded_run
from .bone_tables import own_map
from .cache import load_recording
from .course_objects import gate_objects
from .fewer_keys import KeyOptions
from .figures import bake_figure, instant_poses
from .frame_rate import scene_rate
from .ground import Place, renew_ground
from .placing import world_from_run
from .properties import read_spec
from .ride import Ride, instant_ride, recorded_ride
from .skiers import fit_figure
from .spray import build_spray

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..turning.figures import FigureModel
    from ..turning.motion import TurningMotion

LIKE_A_PERSON = "alpine"
"""The kind of figure that can be laid on an armature of the user's own: its feet stay in boots that lie on skis."""


def bake_simulation(
    scene: bpy.types.Scene, skier: bpy.types.Object, part: Part | None = None
) -> tuple[RunSpec, BakeResult]:
    """Bake the recording of `skier`, slope, tracks and gates with it; returns the run that was baked and what was made.

    `part` (default: what the skier's settings say) is the part of the run that gets keys. Raises `SkiAddonError`.
    """
    settings = skier.ski
    recording = load_recording(settings.recording)
    run, options = recorded_run(recording), read_spec(settings).bake
    keys = key_options(settings, part, scene_rate(scene), options, _duration(recording))
    matrix = world_from_run(settings)
    if settings.is_own:
        result = _told(bake_on_armature(recording, scene, skier, own_map(skier), _how(settings, keys), options, matrix))
    else:
        fit_figure(skier, run)
        result = bake_recording(recording, scene, armature=skier, options=options, world_from_run=matrix, keys=keys)
    _lay_ground(scene, settings, recorded_ride(recording, build_skeleton(run.skier)), run, keys)
    if settings.spray:
        emitter = build_spray(recording, run, settings.ground, scene_rate(scene), options.frame_start, keys)
        emitter.parent = settings.start
    return run, result


def bake_preview(
    scene: bpy.types.Scene, skier: bpy.types.Object, part: Part | None = None
) -> tuple[RunSpec, BakeResult]:
    """Bake the instant motion of the run that the settings of `skier` ask for; see `bake_simulation`."""
    settings, run = skier.ski, read_spec(skier.ski)
    if settings.is_own and run.figure.kind != LIKE_A_PERSON:
        hint = f"set figure.kind to {LIKE_A_PERSON}, or bake on a figure made by Add Skier"
        raise SpecError("figure.kind", run.figure.kind, hint=hint, problem="cannot be laid on an armature of your own")
    model, motion = build_figure(run), preview_motion(run)
    keys = key_options(settings, part, scene_rate(scene), run.bake, motion.duration)
    if settings.is_own:
        result = _preview_on_own_armature(model, run, motion, scene, skier, keys)
    else:
        fit_figure(skier, run)
        matrix = world_from_run(settings)
        result = bake_figure(model, run, motion, scene, armature=skier, world_from_run=matrix, keys=keys)
    _lay_ground(scene, settings, instant_ride(model, run, motion), run, keys)
    return run, result


def _preview_on_own_armature(
    model: FigureModel,
    run: RunSpec,
    motion: TurningMotion,
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    keys: KeyOptions,
) -> BakeResult:
    """Bake `motion` on an armature of the user's own by the bone map that fits it."""
    settings = armature.ski
    poses = instant_poses(model, run, motion, scene_rate(scene), run.bake).within(keys.span)
    channels = figure_channels(model, run, motion, poses.time)
    moved = BakedRun(poses.moved(world_from_run(settings)), channels, model.skeleton)
    return _told(lay_on_armature(moved, scene, armature, own_map(armature), _how(settings, keys), run.bake.action))


def _how(settings: Any, keys: KeyOptions) -> ArmatureOptions:
    """Return how a skier's settings ask to bake on an armature of the user's own."""
    return ArmatureOptions(
        root=settings.root_motion,
        legs=settings.legs,
        equipment=settings.equipment,
        as_strip=keys.as_strip,
        tolerance_deg=keys.tolerance_deg,
        tolerance_mm=keys.tolerance_mm,
        tolerance_percent=keys.tolerance_percent,
        span=keys.span,
    )


def _told(made: ArmatureBake) -> BakeResult:
    return BakeResult(made.armature, made.action, made.frame_first, made.frame_last, "; ".join(made.notes))


def _duration(recording: Recording) -> float:
    """Return the time from the first recorded moment to the last [s]."""
    return float(recording.time[-1] - recording.time[0]) if len(recording.time) else 0.0


def part_of(settings: Any) -> Part:
    """Return the part of the run that a skier's settings ask to bake."""
    if settings.part == SECONDS:
        return Part(SECONDS, settings.part_begin, settings.part_end)
    if settings.part == FRAMES:
        return Part(FRAMES, settings.part_first, settings.part_last)
    return Part()


def key_options(settings: Any, part: Part | None, rate: float, options: BakeSpec, duration: float) -> KeyOptions:
    """Return which keys a skier's settings ask for, of a run of `duration` [s] at `rate` [frames/s]."""
    return replace(whole_keys(settings), span=(part or part_of(settings)).span(rate, options.frame_start, duration))


def whole_keys(settings: Any) -> KeyOptions:
    """Return which keys a skier's settings ask for, whatever part of the run they name."""
    return KeyOptions(settings.as_strip, settings.tolerance_deg, settings.tolerance_mm, settings.tolerance_percent)


def _lay_ground(scene: bpy.types.Scene, settings: Any, ride: Ride, run: RunSpec, keys: KeyOptions) -> None:
    """Put slope, tracks and gates of the run under the skier."""
    place = Place(settings.start, settings.slope_mesh is not None, gate_objects(settings, run), settings.tracks)
    settings.ground = renew_ground(ride, run, scene, settings.ground, read_spec(settings).bake, place, keys)
