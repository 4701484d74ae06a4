"""A fresh file with everything a run needs to be looked at: slope, tracks, gates, trees, light."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..animation.gate_motion import GateSwing
from ..body import build_skeleton
from ..course import course_gates
from ..spec import RunSpec
from ..terrain import Terrain, build_terrain
from .gates import build_gates
from .light import build_sky, build_sun
from .obstacles import build_obstacles
from .ride import Ride, recorded_ride
from .scenery import build_mountains, build_trees
from .ski_tracks import build_traces
from .slope import build_slope

if TYPE_CHECKING:
    from ..simulation.recording import Recording


SUN = 120.0, 24.0
"""Azimuth and height of the sun [deg]."""
EXPOSURE = 0.8
"""Exposure [stops] that makes sunny snow look sunny."""


@dataclass(frozen=True)
class Stage:
    """What stands round a run: its `terrain`, the objects of each gate and how each gate `swings`."""

    terrain: Terrain
    gates: list[list[bpy.types.Object]]
    swings: list[GateSwing | None]


def empty_file() -> bpy.types.Scene:
    """Open an empty file, with what was open closed, and return its scene. Only for Blender without a window."""
    if not bpy.app.background:
        raise RuntimeError("an empty file may only be opened in background: it would close the user's")
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return bpy.context.scene


def add_collection(scene: bpy.types.Scene, name: str) -> bpy.types.Collection:
    """Return a new collection linked to `scene`."""
    collection = bpy.data.collections.new(name)
    scene.collection.children.link(collection)
    return collection


def build_stage(
    recording: Recording,
    spec: RunSpec,
    scene: bpy.types.Scene,
    *,
    sun_deg: tuple[float, float] = SUN,
    trees: bool = True,
) -> Stage:
    """Set `scene` up round the track of `recording`; see `stage_ride`."""
    ride = recorded_ride(recording, build_skeleton(spec.skier))
    return stage_ride(ride, spec, scene, sun_deg=sun_deg, trees=trees)


def stage_ride(
    ride: Ride, spec: RunSpec, scene: bpy.types.Scene, *, sun_deg: tuple[float, float] = SUN, trees: bool = True
) -> Stage:
    """Set `scene` up round the way of `ride`; trees may be left out, gates stand upright.

    `sun_deg` are azimuth and height of the sun, see `build_sun`.
    """
    terrain, track = build_terrain(spec.slope), np.asarray(ride.timeline.track_position)
    build_slope(terrain, track, add_collection(scene, "Slope"), snow=ride.on_snow)
    build_traces(ride.traces, terrain, add_collection(scene, "Ski tracks" if ride.on_snow else "Tyre lines"))
    gates = build_gates(spec, terrain, add_collection(scene, "Gates")) if spec.course.kind == "gates" else []
    if spec.course.kind == "follow":
        build_obstacles(spec, terrain, add_collection(scene, "Obstacles"), snow=ride.on_snow)
    scenery = add_collection(scene, "Scenery")
    if trees:
        build_trees(terrain, track, scenery, snow=ride.on_snow)
    build_mountains(track.mean(axis=0), scenery)
    build_sun(add_collection(scene, "Light"), *sun_deg)
    build_sky(scene)
    scene.view_settings.view_transform = "AgX"
    scene.view_settings.look = "AgX - Medium High Contrast"
    scene.view_settings.exposure = EXPOSURE
    return Stage(terrain, gates, swings_of(ride, spec, terrain))


def swings_of(ride: Ride, spec: RunSpec, terrain: Terrain) -> list[GateSwing | None]:
    """Return how the gates of `spec` swing in `ride`, one entry a gate."""
    gates = course_gates(spec, terrain)
    return [] if gates is None else ride.swings(gates)
