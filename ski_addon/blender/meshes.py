"""Mesh objects from plain parts: faces, materials, smooth shading, vertex groups."""

from __future__ import annotations

import math
from collections.abc import Callable

import bpy
import numpy as np

from .materials import paint_material
from .skier.shapes import Part

SHARP_ANGLE = math.radians(48.0)
"""Edges sharper than this keep their crease."""


def part_object(name: str, part: Part, collection: bpy.types.Collection) -> bpy.types.Object:
    """Return a new mesh object of `part` in `collection`, with one vertex group a body."""
    mesh = part_mesh(name, part)
    obj = bpy.data.objects.new(name, mesh)
    collection.objects.link(obj)
    for body, weights in part.weights.items():
        _vertex_group(obj, body, weights)
    return obj


def part_mesh(name: str, part: Part, paint: Callable[[str], bpy.types.Material] = paint_material) -> bpy.types.Mesh:
    """Return a new mesh of `part`, smooth but for its creases; `paint` gives the material of each name in it."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(part.vertices.tolist(), [], part.faces)
    names = list(dict.fromkeys(part.materials))
    for material in names:
        mesh.materials.append(paint(material))
    index = np.array([names.index(material) for material in part.materials], dtype=np.int32)
    mesh.polygons.foreach_set("material_index", index)
    mesh.polygons.foreach_set("use_smooth", np.ones(len(part.faces), dtype=bool))
    mesh.set_sharp_from_angle(angle=SHARP_ANGLE)
    mesh.update()
    return mesh


def _vertex_group(obj: bpy.types.Object, name: str, weights: np.ndarray) -> None:
    group = obj.vertex_groups.new(name=name)
    whole = np.flatnonzero(weights > 0.999)
    group.add(whole.tolist(), 1.0, "REPLACE")
    for index in np.flatnonzero((weights > 0.002) & (weights <= 0.999)):
        group.add([int(index)], float(weights[index]), "REPLACE")


def skin_to(obj: bpy.types.Object, armature: bpy.types.Object) -> None:
    """Parent `obj` to `armature` and let its bones move it."""
    obj.parent = armature
    modifier = obj.modifiers.new("Armature", "ARMATURE")
    modifier.object = armature
    modifier.use_deform_preserve_volume = True
