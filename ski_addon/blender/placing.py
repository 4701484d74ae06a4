"""Where a run lies in the scene: between the scene's world and the run's own frame, which its start object carries.

The run frame has its origin at the start of the run on the ground's mean plane, x down the fall line's horizontal
direction, y to the left and z up. The start object may stand anywhere and be turned about the vertical; tilt and size
of it do not count. In a run document places are told by the distance down the slope's surface, not by x.
"""

from __future__ import annotations

import functools
import math
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np
from mathutils import Matrix

from ..frames import Array
from ..spec import SlopeSpec, find_ground

if TYPE_CHECKING:
    from ..terrain import Terrain


def world_from_run(settings: Any) -> Array:
    """Return the matrix (4, 4) from the run frame of a skier's settings to the world of the scene."""
    start = settings.start
    matrix = np.eye(4)
    if start is None:
        return matrix
    world = np.array(start.matrix_world)
    facing = math.atan2(world[1, 0], world[0, 0])
    matrix[:2, :2] = (math.cos(facing), -math.sin(facing)), (math.sin(facing), math.cos(facing))
    matrix[:3, 3] = world[:3, 3]
    return matrix


def run_from_world(settings: Any) -> Array:
    """Return the matrix (4, 4) from the world of the scene to the run frame."""
    return np.linalg.inv(world_from_run(settings))


def moved(matrix: Array, places: Array) -> Array:
    """Return `places` (n, 3) moved by `matrix` (4, 4)."""
    return np.asarray(places @ matrix[:3, :3].T + matrix[:3, 3])


def terrain_of(slope: SlopeSpec) -> Terrain:
    """Return the terrain of `slope`, the same again as long as nothing of it was changed; raises `SkiAddonError`."""
    age = 0.0
    if slope.kind == "grid" and slope.grid_file:
        path = find_ground(slope.grid_file)
        age = path.stat().st_mtime if path.is_file() else 0.0
    return _terrain(slope, age)


@functools.lru_cache(maxsize=8)
def _terrain(slope: SlopeSpec, _age: float) -> Terrain:
    from ..terrain import build_terrain

    return build_terrain(slope)


def document_places(settings: Any, slope: SlopeSpec, world: Array) -> Array:
    """Return places (n, 2) [m down the slope's surface, to the left] of `world` (n, 3) [m], to the millimetre."""
    places = moved(run_from_world(settings), np.asarray(world, dtype=float).reshape(-1, 3))[:, :2]
    places[:, 0] /= math.cos(terrain_of(slope).mean_angle)
    return np.round(places, 3) + 0.0  # no minus zero


def on_ground(settings: Any, slope: SlopeSpec, places: Array) -> Array:
    """Return the points (n, 3) [m, world of the scene] on the ground at document `places` (n, 2)."""
    terrain = terrain_of(slope)
    places = np.asarray(places, dtype=float).reshape(-1, 2)
    x, y = places[:, 0] * math.cos(terrain.mean_angle), places[:, 1]
    return moved(world_from_run(settings), np.stack((x, y, terrain.height(x, y)), axis=1))


def place_start(settings: Any, matrix: Array) -> None:
    """Move the start object, and with it the run, so that the run frame is `matrix` (4, 4) in the world."""
    if settings.start is not None:
        settings.start.matrix_world = Matrix(matrix.tolist())  # plain lists would be taken as columns
        bpy.context.view_layer.update()
