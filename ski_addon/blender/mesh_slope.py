"""Any mesh of the scene as a slope: its evaluated faces, in the world, as a grid of heights down the fall line."""

from __future__ import annotations

from collections.abc import Sequence

import bpy
import numpy as np

from ..errors import SpecError
from ..frames import Array
from ..terrain import MeshGround, mesh_ground, read_ground, write_ground

__all__ = ["MeshGround", "read_ground", "sample_mesh", "world_triangles", "write_ground"]


def sample_mesh(
    obj: bpy.types.Object,
    depsgraph: bpy.types.Depsgraph,
    start: Sequence[float] | None = None,
    resolution: float | None = None,
    *,
    heading: float | None = None,
) -> MeshGround:
    """Return the ground that the mesh of `obj` makes with its modifiers and its place in the world.

    `start` is the world point [m] over or under which a run starts (x and y count), by default a few metres in from the
    upper end, in the middle; `heading` [rad] is the way downhill from the world's x axis to the left, by default the
    mesh's fall line; `resolution` [m] is the distance between samples, by default what fits the mesh's faces and size.
    Raises `SpecError` with object, value and what to do for a mesh that makes no ground.
    """
    return mesh_ground(world_triangles(obj, depsgraph), shown_name(obj), start, heading, resolution)


def shown_name(obj: bpy.types.Object) -> str:
    """Return what errors call `obj`."""
    return f'object "{obj.name}"'


def world_triangles(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> Array:
    """Return the evaluated triangles (n, 3, 3) [m, world] of `obj`, counter-clockwise ones looking up.

    Raises `SpecError` unless it is a mesh that Blender evaluates, of a scale other than 0.
    """
    if obj.type != "MESH":
        hint = "choose a mesh, or convert it to one"
        raise SpecError(f"{shown_name(obj)} type", obj.type, "MESH", hint, problem="is not")
    evaluated = obj.evaluated_get(depsgraph)
    _check_state(obj, evaluated)
    matrix = np.array(evaluated.matrix_world, dtype=float)
    scale = np.linalg.norm(matrix[:3, :3], axis=0)
    size = float(np.linalg.det(matrix[:3, :3]))
    if not abs(size) > 1e-9 * float(np.max(scale)) ** 3:
        hint = "give it a scale other than 0 along every axis, and its parents too"
        raise SpecError(
            f"{shown_name(obj)} scale", tuple(float(f"{value:.4g}") for value in scale), "", hint, problem="is flat"
        )
    mesh = evaluated.to_mesh()
    try:
        triangles = _local_triangles(mesh)
    finally:
        evaluated.to_mesh_clear()
    out = triangles @ matrix[:3, :3].T + matrix[:3, 3]
    return out if size > 0.0 else out[:, ::-1]  # a mirrored mesh keeps what it looks at, its corners run the other way


def _check_state(obj: bpy.types.Object, evaluated: bpy.types.Object) -> None:
    """Raise `SpecError` if `obj` would be sampled without its modifiers and its place, or not as it is edited."""
    if not evaluated.is_evaluated:
        hint = "turn on its monitor symbol in the Outliner and its collection, so that its modifiers count"
        raise SpecError(shown_name(obj), None, "", hint, problem="is disabled, or not in this scene")
    if obj.mode == "EDIT":
        raise SpecError(shown_name(obj), None, "", "leave it first (Tab)", problem="is in Edit Mode")


def _local_triangles(mesh: bpy.types.Mesh) -> Array:
    vertices = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", vertices)
    mesh.calc_loop_triangles()
    corners = np.empty(3 * len(mesh.loop_triangles), dtype=np.int32)
    mesh.loop_triangles.foreach_get("vertices", corners)
    return vertices.reshape(-1, 3).astype(float)[corners].reshape(-1, 3, 3)
