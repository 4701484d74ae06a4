"""Slope, ski tracks and gates of a run in the user's own scene; made once, renewed by every bake."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..body import build_skeleton
from ..spec import BakeSpec
from ..terrain import build_terrain
from .bake import scene_rate
from .channels import MARK as BAKED
from .gates import bake_gates, build_gates
from .obstacles import build_obstacles
from .ride import Ride, recorded_ride
from .ski_tracks import build_traces
from .slope import build_slope
from .stage import swings_of

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..spec import RunSpec

MARK = "ski_addon_ground"


def update_ground(
    recording: Recording,
    spec: RunSpec,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection | None,
    options: BakeSpec | None = None,
) -> bpy.types.Collection:
    """Put slope and tracks of `recording` into `collection`; see `renew_ground`."""
    ride = recorded_ride(recording, build_skeleton(spec.skier))
    return renew_ground(ride, spec, scene, collection, options)


def renew_ground(
    ride: Ride,
    spec: RunSpec,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection | None,
    options: BakeSpec | None = None,
) -> bpy.types.Collection:
    """Put slope and tracks of `ride` into `collection` (default: a new one in `scene`) and return it.

    Gates go into the collection "Gates" within it, with keys where the skier knocks them over; `options` gives the
    first frame. What an earlier bake put there is replaced; what the user put there stays.
    """
    if collection is None:
        collection = bpy.data.collections.new("Ski slope")
        scene.collection.children.link(collection)
    _clear(collection)
    terrain, track = build_terrain(spec.slope), np.asarray(ride.timeline.track_position)
    made = [build_slope(terrain, track, collection, far=(), snow=ride.on_snow)]
    made += build_traces(ride.traces, terrain, collection)
    if spec.course.kind == "gates":
        gates = build_gates(spec, terrain, _gates_within(collection))
        swings = swings_of(ride, spec, terrain)
        bake_gates(gates, swings, scene_rate(scene), (options or BakeSpec()).frame_start)
        made += [obj for objects in gates for obj in objects]
    made += build_obstacles(spec, terrain, collection, snow=ride.on_snow)
    for obj in made:
        obj[MARK] = True
    return collection


def _clear(collection: bpy.types.Collection) -> None:
    """Remove what an earlier bake put into `collection` and those within it."""
    for obj in [obj for obj in collection.all_objects if obj.get(MARK)]:
        data, action = obj.data, obj.animation_data.action if obj.animation_data else None
        bpy.data.objects.remove(obj)
        if data is not None and data.users == 0:
            bpy.data.batch_remove([data])  # a mesh, or the curve of a track
        if action is not None and action.users == 0 and action.get(BAKED):
            bpy.data.actions.remove(action)


def _gates_within(collection: bpy.types.Collection) -> bpy.types.Collection:
    """Return the collection for gates within `collection`, made on first use."""
    for child in collection.children:
        if child.get(MARK):
            return child
    gates = bpy.data.collections.new("Gates")
    gates[MARK] = True
    collection.children.link(gates)
    return gates
