"""Everything that Bake does to a scene: the skier's keys, and slope, tracks and gates around it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import bpy

from ..body import build_skeleton
from ..errors import SpecError
from ..spec import BakeSpec, RunSpec
from ..turning.figures import build_figure
from ..turning.preview import preview_motion
from .armatures import ArmatureOptions, bake_on_armature
from .bake import BakeResult, KeyOptions, bake_recording, recorded_run
from .bone_tables import own_map
from .cache import load_recording
from .course_objects import gate_objects
from .figures import bake_figure
from .frame_rate import scene_rate
from .ground import Place, renew_ground
from .placing import world_from_run
from .properties import read_spec
from .ride import Ride, instant_ride, recorded_ride
from .skiers import fit_figure
from .spray import build_spray

if TYPE_CHECKING:
    from ..simulation.recording import Recording


def bake_simulation(scene: bpy.types.Scene, skier: bpy.types.Object) -> tuple[RunSpec, BakeResult]:
    """Bake the recording of `skier`, slope, tracks and gates with it; returns the run that was baked and what was made.

    Raises `SkiAddonError`.
    """
    settings = skier.ski
    recording = load_recording(settings.recording)
    run, options = recorded_run(recording), read_spec(settings).bake
    matrix, keys = world_from_run(settings), key_options(settings)
    if settings.is_own:
        result = _on_own_armature(recording, scene, skier, options)
    else:
        fit_figure(skier, run)
        result = bake_recording(recording, scene, armature=skier, options=options, world_from_run=matrix, keys=keys)
    _lay_ground(scene, settings, recorded_ride(recording, build_skeleton(run.skier)), run)
    if settings.spray:
        emitter = build_spray(recording, run, settings.ground, scene_rate(scene), options.frame_start)
        emitter.parent = settings.start
    return run, result


def _on_own_armature(
    recording: Recording, scene: bpy.types.Scene, armature: bpy.types.Object, options: BakeSpec
) -> BakeResult:
    """Bake on an armature of the user's own by the bone map that fits it."""
    settings = armature.ski
    how = ArmatureOptions(
        root=settings.root_motion,
        legs=settings.legs,
        equipment=settings.equipment,
        as_strip=settings.as_strip,
        tolerance_deg=settings.tolerance_deg,
        tolerance_mm=settings.tolerance_mm,
    )
    made = bake_on_armature(recording, scene, armature, own_map(armature), how, options, world_from_run(settings))
    return BakeResult(armature, made.action, made.frame_first, made.frame_last, "; ".join(made.notes))


def key_options(settings: Any) -> KeyOptions:
    """Return which keys a skier's settings ask for."""
    return KeyOptions(settings.as_strip, settings.tolerance_deg, settings.tolerance_mm)


def bake_preview(scene: bpy.types.Scene, skier: bpy.types.Object) -> tuple[RunSpec, BakeResult]:
    """Bake the instant motion of the run that the settings of `skier` ask for; see `bake_simulation`."""
    settings, run = skier.ski, read_spec(skier.ski)
    if settings.is_own:
        hint = "simulate the run and bake that"
        raise SpecError("the preview", skier.name, hint=hint, problem="cannot be baked on an armature of your own")
    model, motion = build_figure(run), preview_motion(run)
    fit_figure(skier, run)
    result = bake_figure(
        model, run, motion, scene, armature=skier, world_from_run=world_from_run(settings), keys=key_options(settings)
    )
    _lay_ground(scene, settings, instant_ride(model, run, motion), run)
    return run, result


def _lay_ground(scene: bpy.types.Scene, settings: Any, ride: Ride, run: RunSpec) -> None:
    """Put slope, tracks and gates of the run under the skier."""
    place = Place(settings.start, settings.slope_mesh is not None, gate_objects(settings, run), settings.tracks)
    settings.ground = renew_ground(ride, run, scene, settings.ground, read_spec(settings).bake, place)
