"""What stands round a slope to give it scale: fir trees and far mountains."""

from __future__ import annotations

import bpy
import numpy as np

from ..frames import Array
from ..terrain import Terrain
from .materials import linear_colour, new_material
from .skier.shapes import Part, Ring, join, stack
from .slope import grid_faces, mesh_object

TREE_CORRIDOR = (16.0, 70.0)
"""Least and most distance of a tree from the track [m]."""
TREE_SPACING = 7.0
BRANCH = 2.5
"""How far branches reach [m]."""
MOUNTAIN_DISTANCE = 1900.0
_TREE_PAINTS = {
    "trunk": ("3d2c20", 0.9),
    "fir": ("203a2e", 0.8),
    "snow": ("dfe8ef", 0.6),
    "light": ("2f5a3a", 0.8),
}
"""sRGB colour and roughness of what firs are made of."""


def build_trees(
    terrain: Terrain,
    track: Array,
    collection: bpy.types.Collection,
    seed: int = 3,
    clear: Array | None = None,
    *,
    snow: bool = True,
) -> bpy.types.Object:
    """Return one object with all fir trees on both sides of `track` (n, 3) [m, world], easy to hide or delete.

    `clear` (k, 2) [m, world] is a convex outline, counter-clockwise seen from above, in which none may stand.
    Without `snow` the branches are green.
    """
    return build_firs("Firs", _tree_places(track, seed, clear), terrain, collection, snow=snow)


def build_firs(
    name: str,
    places: list[tuple[float, float, float, float]],
    terrain: Terrain,
    collection: bpy.types.Collection,
    *,
    snow: bool = True,
) -> bpy.types.Object:
    """Return one object with a fir at each of `places` (x, y [m, world], size, turn [rad]) on `terrain`."""
    fir = _fir()
    vertices: list[Array] = []
    faces: list[tuple[int, ...]] = []
    materials: list[str] = []
    for x, y, size, turn in places:
        c, s = size * np.cos(turn), size * np.sin(turn)
        foot = (x, y, float(terrain.height(x, y)) - 0.2)
        first = len(vertices) * len(fir.vertices)
        vertices.append(fir.vertices @ np.array(((c, s, 0.0), (-s, c, 0.0), (0.0, 0.0, size))) + foot)
        faces += [tuple(first + corner for corner in face) for face in fir.faces]
        materials += fir.materials
    trees = mesh_object(name, np.concatenate(vertices or [np.zeros((0, 3))]), faces, collection)
    names = ("trunk", "fir", "snow")
    for paint in names:
        trees.data.materials.append(_tree_material(paint if snow or paint != "snow" else "light"))
    trees.data.polygons.foreach_set("material_index", np.array([names.index(m) for m in materials], dtype=np.int32))
    trees.data.polygons.foreach_set("use_smooth", np.zeros(len(faces), dtype=bool))
    return trees


def _tree_places(track: Array, seed: int, clear: Array | None) -> list[tuple[float, float, float, float]]:
    """Return (x, y, size, turn) of trees scattered near `track`, denser away from it."""
    random = np.random.default_rng(seed)
    low, high = track[:, :2].min(axis=0) - 70.0, track[:, :2].max(axis=0) + 70.0
    count = int(np.prod(high - low) / TREE_SPACING**2)
    places = random.uniform(low, high, (count, 2))
    path = track[:: max(1, len(track) // 400), :2]
    distance = np.sqrt(((places[:, None] - path[None]) ** 2).sum(axis=2)).min(axis=1)
    nearest, furthest = TREE_CORRIDOR
    share = np.clip((distance - nearest) / (furthest - nearest), 0.0, 1.0)
    kept = (distance > nearest) & (random.uniform(size=count) < 0.12 + 0.55 * share)
    if clear is not None:
        kept &= ~_within_outline(places, clear)
    sizes = random.uniform(0.7, 1.5, count)
    turns = random.uniform(0.0, 2.0 * np.pi, count)
    return [
        (float(x), float(y), float(s), float(t))
        for (x, y), s, t in zip(places[kept], sizes[kept], turns[kept], strict=True)
    ]


def _within_outline(places: Array, outline: Array) -> Array:
    """Return whether `places` (n, 2) lie within a convex, counter-clockwise `outline` (k, 2), or a branch outside."""
    side = np.roll(outline, -1, axis=0) - outline
    outward = np.stack((side[:, 1], -side[:, 0]), axis=1) / np.linalg.norm(side, axis=1, keepdims=True)
    beyond = np.einsum("nkc,kc->nk", places[:, None] - outline[None], outward)
    return np.asarray((beyond < BRANCH).all(axis=1))


def _fir() -> Part:
    """Return a fir 6 m high under snow: a trunk and four skirts of branches."""
    parts = [stack([Ring(-0.5, 0.16, 0.16, 0.16), Ring(1.4, 0.13, 0.13, 0.13)], 6, "trunk", (False, False))]
    for low, high, wide in ((0.8, 2.9, 1.5), (2.0, 4.0, 1.2), (3.1, 5.0, 0.9), (4.2, 6.2, 0.55)):
        rings = [
            Ring(low + 0.18, 0.30 * wide, 0.30 * wide, 0.30 * wide),
            Ring(low, wide, wide, wide),
            Ring(low + 0.45 * (high - low), 0.52 * wide, 0.52 * wide, 0.52 * wide),
            Ring(high, 0.02, 0.02, 0.02),
        ]
        parts.append(stack(rings, 9, lambda row, column: "snow" if row > 0 and column % 3 else "fir"))
    return join(parts)


def _tree_material(name: str) -> bpy.types.Material:
    colour, roughness = _TREE_PAINTS[name]
    return _plain_material(f"Ski tree {name}", colour, roughness)


def _plain_material(name: str, colour: str, roughness: float) -> bpy.types.Material:
    existing = bpy.data.materials.get(name)
    if existing is not None:
        return existing
    material, shader = new_material(name)
    shader.inputs["Base Color"].default_value = material.diffuse_color = linear_colour(colour)
    shader.inputs["Roughness"].default_value = roughness
    return material


def _hazy_material(name: str, colour: str) -> bpy.types.Material:
    """Return a material that glows a little, as what is far away does in the air's light."""
    material = _plain_material(name, colour, 0.95)
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    shader.inputs["Emission Color"].default_value = linear_colour("a9c4e4")
    shader.inputs["Emission Strength"].default_value = 0.30
    return material


def build_mountains(centre: Array, collection: bpy.types.Collection, seed: int = 5) -> bpy.types.Object:
    """Return a far ring of mountains round `centre` (3,) [m, world], which leaves the slope in the sun however low."""
    random = np.random.default_rng(seed)
    count, rows = 180, 8
    angle = 2.0 * np.pi * np.arange(count + 1) / count
    ridge = np.zeros(count)
    for waves, strength in ((3, 0.35), (7, 0.5), (13, 0.4), (29, 0.25)):
        ridge += strength * np.sin(waves * angle[:-1] + random.uniform(0, 2 * np.pi))
    ridge = 620.0 * (0.95 + 0.42 * ridge)
    share = np.linspace(0.0, 1.0, rows)
    height = share[:, None] ** 1.3 * ridge[None] + random.normal(0.0, 16.0, (rows, count)) * (share[:, None] > 0)
    radius = MOUNTAIN_DISTANCE + 900.0 * share[:, None] + random.normal(0.0, 30.0, (rows, count))
    height, radius = (np.concatenate((values, values[:, :1]), axis=1) for values in (height, radius))
    vertices = np.stack((radius * np.cos(angle), radius * np.sin(angle), height - 150.0), axis=-1) + centre
    obj = mesh_object("Mountains", vertices.reshape(-1, 3), grid_faces(rows, count + 1), collection)
    obj.data.polygons.foreach_set("use_smooth", np.zeros(len(obj.data.polygons), dtype=bool))
    obj.data.materials.append(_hazy_material("Ski mountain", "c3d0de"))
    obj.visible_shadow = False
    return obj
