"""The slope as a mesh at the track's place, and snow to make it of."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ..frames import Array
from ..terrain import Terrain
from .ground_mesh import ground_mesh
from .materials import linear_colour, new_material

ROOT = 8.0
"""Size of the slope's faces near the track where the ground is flat [m]; they are cut where it is not."""
MARGIN = 40.0
FAR, FAR_UPHILL = (120.0, 500.0, 2500.0), (60.0, 160.0)
"""How far the slope reaches beyond the margin round the track [m]; uphill it ends in a crest."""


def build_slope(
    terrain: Terrain,
    track: Array,
    collection: bpy.types.Collection,
    *,
    far: tuple[float, ...] = FAR,
    snow: bool = True,
) -> bpy.types.Object:
    """Return a new mesh of `terrain` round `track` (n, 3) [m, world]: fine near it, coarse out to `far` [m].

    Bumps, moguls and waves are followed closely near the track (see `ground_mesh`). Without `far` the mesh ends where
    the terrain's known ground does; with it, the ground beyond is drawn too. Ground without `snow` is a meadow.
    """
    uphill = FAR_UPHILL if far else ()
    lines = (
        _lines(track[:, 0], terrain.extent[:2], uphill, far),
        _lines(track[:, 1], terrain.extent[2:], far, far),
    )
    obj = mesh_object("Slope", *ground_mesh(terrain.height, lines, track), collection)
    obj.data.materials.append(snow_material() if snow else meadow_material())
    return obj


def _lines(values: Array, known: tuple[float, float], before: tuple[float, ...], beyond: tuple[float, ...]) -> Array:
    """Return where roots of the mesh end [m] along one axis: evenly within the margin and the `known` ground."""
    low = max(float(values.min()) - MARGIN, known[0])
    high = min(float(values.max()) + MARGIN, known[1])
    near = np.linspace(low, high, int(np.ceil((high - low) / ROOT)) + 1)
    return np.concatenate((low - np.array(before)[::-1], near, high + np.array(beyond)))


def grid_faces(rows: int, columns: int) -> list[tuple[int, int, int, int]]:
    """Return the quads of a grid of vertices, row after row, that look up where x runs with rows and y with columns."""
    return [
        (r * columns + c, (r + 1) * columns + c, (r + 1) * columns + c + 1, r * columns + c + 1)
        for r in range(rows - 1)
        for c in range(columns - 1)
    ]


def mesh_object(name: str, vertices: Array, faces: list[Any], collection: bpy.types.Collection) -> bpy.types.Object:
    """Return a new smooth mesh object in `collection`."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(np.asarray(vertices).tolist(), [], faces)
    mesh.polygons.foreach_set("use_smooth", np.ones(len(faces), dtype=bool))
    mesh.update()
    obj = bpy.data.objects.new(name, mesh)
    collection.objects.link(obj)
    return obj


def meadow_material(name: str = "Ski meadow", colour: str = "8b955a") -> bpy.types.Material:
    """Return short dry grass (made on first use)."""
    existing = bpy.data.materials.get(name)
    if existing is not None:
        return existing
    material, shader = new_material(name)
    grass = linear_colour(colour)
    material.diffuse_color = grass
    shader.inputs["Base Color"].default_value = grass
    shader.inputs["Roughness"].default_value = 0.95
    shader.inputs["Specular IOR Level"].default_value = 0.1
    tree = material.node_tree
    place = tree.nodes.new("ShaderNodeNewGeometry")
    patches = _noise(tree, place, scale=0.9, detail=6.0)
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    for element, position, factor in zip(ramp.color_ramp.elements, (0.35, 0.65), (0.72, 1.18), strict=True):
        element.position = position
        element.color = (*(factor * c for c in grass[:3]), 1.0)
    tree.links.new(patches.outputs[0], ramp.inputs["Fac"])
    tree.links.new(ramp.outputs["Color"], shader.inputs["Base Color"])
    blades = _bump(tree, place, scale=14.0, detail=8.0, distance=0.05)
    tree.links.new(blades.outputs["Normal"], shader.inputs["Normal"])
    return material


def snow_material(name: str = "Ski snow", colour: str = "f4f7fb") -> bpy.types.Material:
    """Return groomed snow: nearly white, with fine grain and soft waves (made on first use)."""
    existing = bpy.data.materials.get(name)
    if existing is not None:
        return existing
    material, shader = new_material(name)
    white = linear_colour(colour)
    material.diffuse_color = white
    shader.inputs["Base Color"].default_value = white
    shader.inputs["Roughness"].default_value = 0.55
    shader.inputs["Specular IOR Level"].default_value = 0.25
    tree = material.node_tree
    place = tree.nodes.new("ShaderNodeNewGeometry")
    waves = _bump(tree, place, scale=0.35, detail=3.0, distance=0.10)
    grain = _bump(tree, place, scale=9.0, detail=6.0, distance=0.012)
    tree.links.new(waves.outputs["Normal"], grain.inputs["Normal"])
    tree.links.new(grain.outputs["Normal"], shader.inputs["Normal"])
    return material


def _bump(tree: Any, place: Any, scale: float, detail: float, distance: float) -> Any:
    noise = _noise(tree, place, scale, detail)
    bump = tree.nodes.new("ShaderNodeBump")
    bump.inputs["Distance"].default_value = distance
    bump.inputs["Strength"].default_value = 0.6
    tree.links.new(noise.outputs[0], bump.inputs["Height"])
    return bump


def _noise(tree: Any, place: Any, scale: float, detail: float) -> Any:
    noise = tree.nodes.new("ShaderNodeTexNoise")
    noise.inputs["Scale"].default_value = scale
    noise.inputs["Detail"].default_value = detail
    tree.links.new(place.outputs["Position"], noise.inputs["Vector"])
    return noise
