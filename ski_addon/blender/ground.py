"""Slope, ski tracks and gates of a run in the user's own scene; made once, renewed by every bake."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..body import build_skeleton
from ..spec import BakeSpec
from ..terrain import build_terrain
from .bake import scene_rate
from .channels import MARK as BAKED
from .fewer_keys import KeyOptions
from .gate_carrier import carry
from .gate_placing import GROUND_MARK
from .gates import bake_gates, build_gates
from .obstacles import build_obstacles
from .ride import Ride, recorded_ride
from .ski_tracks import build_traces, build_track_curves
from .slope import build_slope
from .stage import swings_of

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..spec import RunSpec
    from ..terrain import Terrain

MARK = GROUND_MARK


MESH = "mesh"


@dataclass(frozen=True)
class Place:
    """Where a run lies: `start`, the object that carries its frame (None: the world's), whether a mesh of the user is
    the slope (`own_slope`), the objects of each gate that stands there already (`gates`), and what the `tracks` are
    laid as: "mesh", "curve" or "none".
    """

    start: bpy.types.Object | None = None
    own_slope: bool = False
    gates: list[list[bpy.types.Object]] = field(default_factory=list)
    tracks: str = MESH


def update_ground(
    recording: Recording,
    spec: RunSpec,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection | None,
    options: BakeSpec | None = None,
    place: Place | None = None,
) -> bpy.types.Collection:
    """Put slope and tracks of `recording` into `collection`; see `renew_ground`."""
    ride = recorded_ride(recording, build_skeleton(spec.skier))
    return renew_ground(ride, spec, scene, collection, options, place)


def renew_ground(
    ride: Ride,
    spec: RunSpec,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection | None,
    options: BakeSpec | None = None,
    place: Place | None = None,
    keys: KeyOptions | None = None,
) -> bpy.types.Collection:
    """Put slope and tracks of `ride` into `collection` (default: a new one in `scene`) and return it.

    Gates go into the collection "Gates" within it, with keys where the skier knocks them over; `options` gives the
    first frame, `place` where all of it lies, `keys` which frames the gates' motion is baked for; slope and tracks are
    always those of the whole run. What an earlier bake put there is replaced; what the user put there
    stays.
    """
    if collection is None:
        collection = bpy.data.collections.new("Ski slope")
        scene.collection.children.link(collection)
    _clear(collection)
    place = place or Place()
    terrain, track = build_terrain(spec.slope), np.asarray(ride.timeline.track_position)
    made = [] if place.own_slope else [build_slope(terrain, track, collection, far=(), snow=ride.on_snow)]
    if place.tracks != "none":
        lay = build_traces if place.tracks == MESH else build_track_curves
        made += lay(ride.traces, terrain, collection)
    if spec.course.kind == "gates":
        gates = place.gates or _new_gates(spec, terrain, _gates_within(collection), place.start)
        swings = swings_of(ride, spec, terrain)
        if len(swings) == len(gates):  # gates that stand there may be others than those of an older recording
            first = (options or BakeSpec()).frame_start
            bake_gates(gates, swings, scene_rate(scene), first, _turn(place.start), keys)
    made += build_obstacles(spec, terrain, collection, snow=ride.on_snow)
    for obj in made:
        obj[MARK] = True
        obj.parent = place.start
    return collection


def _new_gates(
    spec: RunSpec, terrain: Terrain, collection: bpy.types.Collection, start: bpy.types.Object | None
) -> list[list[bpy.types.Object]]:
    """Return the objects of each gate of `spec`, new in `collection`, which lie where the run lies and go with it."""
    gates = build_gates(spec, terrain, collection)
    for obj in [obj for objects in gates for obj in objects]:
        obj[MARK] = True
        carry(obj, collection, start)
        if start is not None:
            obj.parent[MARK] = True  # renewed with them
    return gates


def _turn(start: bpy.types.Object | None) -> tuple[float, float, float, float]:
    """Return the quaternion of a start object's turn about the vertical."""
    if start is None:
        return 1.0, 0.0, 0.0, 0.0
    w, x, y, z = start.matrix_world.to_quaternion()
    return w, x, y, z


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
