"""The tracks that skis and boards leave: a groove between two small ridges of pushed snow, laid on the slope.

A ski that skids sweeps a band as wide as it lies across its way. Wheels leave a narrow dark line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import bpy
import numpy as np

from ..body import Skeleton, forward_kinematics
from ..frames import Array, normalized
from ..terrain import Terrain
from .slope import grid_faces, meadow_material, mesh_object, snow_material

if TYPE_CHECKING:
    from ..simulation.recording import Recording

SPACING = 0.10
"""Distance between cross sections [m]."""
CARVES = np.deg2rad(4.0)
"""A ski that points this little beside its way still carves [rad]."""
EDGED_NARROWS = 0.35
"""Share of its width that a groove loses under a ski that is edged well."""
TYRE_LINE_RISE = 0.004
"""How far a wheel's line lies over the ground [m]."""
# across the track, in half widths of the ski; height [m]; how much of the height grows with edging
_PROFILE = (
    (-3.2, -0.010, 0.0),
    (-2.0, 0.020, 1.0),
    (-1.1, 0.004, 0.0),
    (1.1, 0.004, 0.0),
    (2.0, 0.020, 1.0),
    (3.2, -0.010, 0.0),
)


@dataclass(frozen=True)
class Trace:
    """Where something slid or rolled: `place` (m, 3), directions to its left (m, 3), edge angles (m,) [rad].

    `half_width` and `half_length` [m] are those of a ski or board; a wheel has no length.
    """

    name: str
    place: Array
    left: Array
    edge: Array
    half_width: float
    half_length: float


def ski_traces(recording: Recording, skeleton: Skeleton) -> list[Trace]:
    """Return the traces of both skis of `recording`."""
    size = 0.5 * skeleton.ski_width, 0.5 * skeleton.ski_length
    paths = zip("LR", ski_paths(recording, skeleton), strict=True)
    return [Trace(f"Ski track {side}", *path, *size) for side, path in paths]


def ski_paths(recording: Recording, skeleton: Skeleton) -> list[tuple[Array, Array, Array]]:
    """Return for each ski, evenly spaced: places (m, 3), directions to the left (m, 3) and edge angles (m,)."""
    travelled = np.asarray(recording.arc_length) - recording.arc_length[0]
    wanted = np.arange(0.0, float(travelled[-1]), SPACING)
    index = np.unique(np.searchsorted(travelled, wanted).clip(0, len(travelled) - 1))
    position, rotation = forward_kinematics(skeleton, recording.qpos[index])
    paths = []
    for side, name in enumerate(("ski.L", "ski.R")):
        body = skeleton.body(name)
        place = position[:, body]
        step = np.linalg.norm(np.diff(place, axis=0, prepend=place[:1] - SPACING), axis=1)
        moves = step > 0.5 * SPACING  # a ski that comes to rest leaves no more track
        paths.append((place[moves], rotation[moves, body, :, 1], recording.edge_angle[index[moves], side]))
    return paths


def groove_vertices(
    place: Array, left: Array, edge: Array, terrain: Terrain, half_width: float, half_length: float = 0.0, seed: int = 0
) -> Array:
    """Return vertices (m, k, 3) of the track of a ski of `half_width` and `half_length` [m] at `place` (m, 3) [m].

    `left` (m, 3) points across the ski and `edge` (m,) [rad] is its edge angle: an edged ski cuts a narrower groove on
    the edge's side and pushes up more snow. A ski that points elsewhere than it goes leaves a band.
    """
    normal, across, lean, skid = _lie(place, left, edge, terrain)
    shift = np.sign(edge) * lean * 0.5 * half_width
    rough = _roughness(len(place), seed)
    width = half_width * (1.0 - EDGED_NARROWS * lean)
    rows = []
    for column, (share, height, grows) in enumerate(_PROFILE):
        side = shift + share * width + np.sign(share) * skid * half_length
        point = place + side[:, None] * across
        point[:, 2] = terrain.height(point[:, 0], point[:, 1])
        rise = height * (1.0 + grows * (lean - 0.4)) * np.where(grows > 0, rough[:, column], 1.0)
        rows.append(point + rise[:, None] * normal)
    return np.stack(rows, axis=1)


def _lie(place: Array, left: Array, edge: Array, terrain: Terrain) -> tuple[Array, Array, Array, Array]:
    """Return normals (m, 3), unit vectors across the way (m, 3), leans 0..1 (m,) and sines of the skid angles (m,)."""
    normal = terrain.normal(place[:, 0], place[:, 1])
    ski_left = normalized(left - np.sum(left * normal, axis=1, keepdims=True) * normal)
    across = _across_the_way(place, normal, ski_left)
    turned = np.arccos(np.clip(np.sum(across * ski_left, axis=1), 0.0, 1.0))
    skid = _smooth(np.sin(np.maximum(turned - CARVES, 0.0)))
    return normal, across, np.clip(np.abs(edge) / np.deg2rad(30.0), 0.0, 1.0), skid


def _across_the_way(place: Array, normal: Array, ski_left: Array) -> Array:
    """Return unit vectors (m, 3) in the surface, square to the way along `place`; the ski's own for a single place."""
    if len(place) < 2:
        return ski_left
    at = np.arange(len(place))
    ahead = place[np.minimum(at + 2, at[-1])] - place[np.maximum(at - 2, 0)]
    return normalized(np.cross(normal, ahead))


def _roughness(count: int, seed: int) -> Array:
    """Return factors (count, k) on the ridges' heights that vary along the track within about half a metre."""
    noise = np.random.default_rng(seed).normal(0.0, 1.0, (count, len(_PROFILE)))
    return 1.0 + 0.45 * np.clip(np.stack([_smooth(column, "constant") for column in noise.T], axis=1), -1.5, 1.5)


def _smooth(values: Array, beyond: Literal["edge", "constant"] = "edge") -> Array:
    """Return `values` (m,) averaged over about half a metre along the track; `beyond` as in `numpy.pad`."""
    window = np.hanning(9)
    return np.convolve(np.pad(values, 4, mode=beyond), window / window.sum(), mode="valid")


def build_ski_tracks(
    recording: Recording, skeleton: Skeleton, terrain: Terrain, collection: bpy.types.Collection
) -> list[bpy.types.Object]:
    """Return the two new track meshes of `recording`."""
    return build_traces(ski_traces(recording, skeleton), terrain, collection)


def build_traces(traces: list[Trace], terrain: Terrain, collection: bpy.types.Collection) -> list[bpy.types.Object]:
    """Return a new mesh for each of `traces` on `terrain`."""
    return [(_groove if trace.half_length else _line)(trace, terrain, collection) for trace in traces]


def build_track_curves(
    traces: list[Trace], terrain: Terrain, collection: bpy.types.Collection
) -> list[bpy.types.Object]:
    """Return a new curve for each of `traces` that lies on `terrain`, for geometry nodes and other uses of one's own.

    It has a point each `SPACING` along the way, whose radius [m] is half the width of the track there, a skid's band
    included: a bevel depth of 1 m gives a tube as wide as the track. The curve's normals look up.
    """
    return [_curve(trace, terrain, collection) for trace in traces]


def _curve(trace: Trace, terrain: Terrain, collection: bpy.types.Collection) -> bpy.types.Object:
    data = bpy.data.curves.new(f"{trace.name} curve", "CURVE")
    data.dimensions, data.twist_mode = "3D", "Z_UP"
    count = len(trace.place)
    if count > 0:
        _, _, lean, skid = _lie(trace.place, trace.left, trace.edge, terrain)
        points = np.ones((count, 4), dtype=np.float32)
        points[:, :2] = trace.place[:, :2]
        points[:, 2] = terrain.height(trace.place[:, 0], trace.place[:, 1])
        radius = trace.half_width * (1.0 - EDGED_NARROWS * lean) + skid * trace.half_length
        spline = data.splines.new("POLY")
        spline.points.add(count - 1)  # a new spline has one
        spline.points.foreach_set("co", points.ravel())
        spline.points.foreach_set("radius", radius.astype(np.float32))
    obj = bpy.data.objects.new(data.name, data)
    collection.objects.link(obj)
    return obj


def _groove(trace: Trace, terrain: Terrain, collection: bpy.types.Collection) -> bpy.types.Object:
    size = trace.half_width, trace.half_length
    vertices = groove_vertices(trace.place, trace.left, trace.edge, terrain, *size, seed=ord(trace.name[-1]))
    rows, columns = vertices.shape[:2]
    obj = mesh_object(trace.name, vertices.reshape(-1, 3), grid_faces(rows, columns), collection)
    obj.data.materials.append(snow_material())
    obj.data.materials.append(snow_material("Ski snow groove", "d5e0ee"))
    floor = np.tile(np.arange(columns - 1) == columns // 2 - 1, rows - 1).astype(np.int32)
    obj.data.polygons.foreach_set("material_index", floor)
    return obj


def _line(trace: Trace, terrain: Terrain, collection: bpy.types.Collection) -> bpy.types.Object:
    normal = terrain.normal(trace.place[:, 0], trace.place[:, 1])
    across = _across_the_way(trace.place, normal, trace.left)
    rows = []
    for side in (-1.0, 0.0, 1.0):
        point = trace.place + side * trace.half_width * across
        point[:, 2] = terrain.height(point[:, 0], point[:, 1])
        rows.append(point + TYRE_LINE_RISE * normal)
    vertices = np.stack(rows, axis=1)
    obj = mesh_object(trace.name, vertices.reshape(-1, 3), grid_faces(*vertices.shape[:2]), collection)
    obj.data.materials.append(meadow_material("Ski tyre line", "5f5138"))
    return obj
