"""The slope of a skier from a mesh of the scene: taken once into a file of heights, with the start put on it."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ..errors import MissingInputError, SpecError
from .cache import save_ground
from .gate_carrier import gates_stay
from .mesh_slope import read_ground, sample_mesh, write_ground
from .placing import place_start
from .properties import read_spec, write_spec

if TYPE_CHECKING:
    from ..course import Track


def take_slope(settings: Any, depsgraph: bpy.types.Depsgraph, *, use_start: bool = False) -> str:
    """Take the slope of a skier's settings from their mesh and return how finely, in words.

    The run starts where its start object stands if `use_start`, else at the upper end of the mesh. Raises `SpecError`
    for a mesh that is no slope, and `OutputError` if the heights cannot be written.
    """
    mesh = settings.slope_mesh
    if mesh is None:
        raise SpecError("the slope's mesh", problem="is not chosen", hint="choose a mesh under Or a Mesh")
    start, heading = None, None
    if use_start and settings.start is not None:
        world = np.array(settings.start.matrix_world)
        start, heading = world[:3, 3].tolist(), math.atan2(world[1, 0], world[0, 0])
    ground = sample_mesh(mesh, depsgraph, start, settings.slope_resolution or None, heading=heading)
    spec = read_spec(settings)
    kept = save_ground(settings.id_data.name, partial(write_ground, ground))
    write_spec(settings, spec.with_overrides(ground.slope_keys(bpy.path.abspath(kept.path))))
    settings.slope.grid_file = kept.path
    said = f"{ground.summary}; {kept.note}" if kept.note else ground.summary
    with gates_stay(settings):
        place_start(settings, ground.world_from_run)
    return said


def check_on_mesh(settings: Any, track: Track) -> None:
    """Raise `SpecError` where `track` leaves the mesh that the slope was taken from."""
    if settings.slope_mesh is None or settings.slope.kind != "grid":
        return
    try:
        ground = read_ground(bpy.path.abspath(settings.slope.grid_file))
    except (MissingInputError, SpecError):
        return  # another file of heights than one taken from a mesh
    ground.check_track(track.position)
