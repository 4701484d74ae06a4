"""Slope, ski tracks and gates of a run in the user's own scene; made once, renewed by every bake."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..body import build_skeleton
from ..terrain import build_terrain
from .gates import build_gates
from .ski_tracks import build_ski_tracks
from .slope import build_slope

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..spec import RunSpec

MARK = "ski_addon_ground"


def update_ground(
    recording: Recording, spec: RunSpec, scene: bpy.types.Scene, collection: bpy.types.Collection | None
) -> bpy.types.Collection:
    """Put slope and tracks of `recording` into `collection` (default: a new one in `scene`) and return it.

    Gates go into the collection "Gates" within it. What an earlier bake put there is replaced; what the user put there
    stays.
    """
    if collection is None:
        collection = bpy.data.collections.new("Ski slope")
        scene.collection.children.link(collection)
    for obj in [obj for obj in collection.all_objects if obj.get(MARK)]:
        mesh = obj.data
        bpy.data.objects.remove(obj)
        if mesh.users == 0:
            bpy.data.meshes.remove(mesh)
    terrain = build_terrain(spec.slope)
    made = [build_slope(terrain, np.asarray(recording.track_position), collection, far=())]
    made += build_ski_tracks(recording, build_skeleton(spec.skier), terrain, collection)
    if spec.course.kind == "gates":
        made += build_gates(spec, terrain, _gates_within(collection))
    for obj in made:
        obj[MARK] = True
    return collection


def _gates_within(collection: bpy.types.Collection) -> bpy.types.Collection:
    """Return the collection for gates within `collection`, made on first use."""
    for child in collection.children:
        if child.get(MARK):
            return child
    gates = bpy.data.collections.new("Gates")
    gates[MARK] = True
    collection.children.link(gates)
    return gates
