"""What a followed path goes round: firs, poles, nets and rocks on snow; potholes, painted edges and walls on a meadow.

The rows' places are measured down the slope and to the left within its mean plane, as those of a drawn path are.
"""

from __future__ import annotations

import bpy
import numpy as np

from ..frames import Array
from ..spec import ObstacleSpec, RunSpec
from ..terrain import Terrain
from .materials import Paint, painted
from .meshes import part_mesh
from .scenery import build_firs
from .skier.shapes import Part, Ring, facing_out, join, stack
from .skier.tubes import tube

POLE_RADIUS = 0.10
"""A disc on snow up to this radius is a pole, a wider one a fir [m]."""
FIR_BRANCH = 1.5
"""How far a fir's lowest branches reach, at size 1 [m]; they stay where nobody comes."""
NET_HEIGHT, POST_SPACING = 0.9, 2.0
EDGE_WIDTH = 0.12
WALL_HEIGHT = 0.45
_LIFT = 0.008
_STEP = 0.5
_PAINTS = {
    "pole": Paint("d1202b", 0.40),
    "net": Paint("e2702e", 0.75),
    "post": Paint("2b2f37", 0.50),
    "rock": Paint("7d7a75", 0.85),
    "hole": Paint("2a2620", 0.95),
    "rim": Paint("6b5f48", 0.95),
    "edge": Paint("eeeeea", 0.80),
}


def build_obstacles(
    spec: RunSpec, terrain: Terrain, collection: bpy.types.Collection, *, snow: bool
) -> list[bpy.types.Object]:
    """Return a new object in `collection` for each obstacle of a run that follows a path; all firs are one."""
    if spec.course.kind != "follow":
        return []
    made, firs = [], []
    for number, row in enumerate(spec.obstacle, start=1):
        if snow and row.kind == "disc" and row.radius > POLE_RADIUS:
            x, y, _ = _places(row, terrain)[0]
            size = (row.radius + row.tolerance) / FIR_BRANCH
            firs.append((float(x), float(y), float(np.clip(size, 0.25, 1.5)), 2.4 * number))
        else:
            name = row.name or f"Obstacle {number}"
            mesh = part_mesh(
                name, _part(row, terrain, snow), lambda paint: painted(f"Ski obstacle {paint}", _PAINTS[paint])
            )
            obj = bpy.data.objects.new(name, mesh)
            collection.objects.link(obj)
            made.append(obj)
    return [*made, build_firs("Obstacle firs", firs, terrain, collection, snow=snow)] if firs else made


def _places(row: ObstacleSpec, terrain: Terrain) -> Array:
    """Return the row's places (n, 3) on the ground [m, world]."""
    plan = np.array(row.points, dtype=float).reshape(-1, 2)
    return _on_ground(plan * (np.cos(terrain.mean_angle), 1.0), terrain)


def _on_ground(plan: Array, terrain: Terrain) -> Array:
    return np.column_stack((plan, terrain.height(plan[:, 0], plan[:, 1])))


def _part(row: ObstacleSpec, terrain: Terrain, snow: bool) -> Part:
    places = _places(row, terrain)
    if row.kind == "disc":
        return _pole(places[0]) if snow else _hole(places[0], row.radius, terrain)
    if row.kind == "line":
        return _net(places, terrain) if snow else _edge(places, terrain)
    return _wall(places)


def _pole(foot: Array) -> Part:
    rings = [Ring(z, 0.017, 0.017, 0.017) for z in (-0.3, 1.8)]
    return stack(rings, 12, "pole").moved(foot)


def _hole(middle: Array, radius: float, terrain: Terrain) -> Part:
    """Return a dark pit of `radius` with a broken rim, drawn on the ground."""
    angle = 2.0 * np.pi * np.arange(28) / 28
    uneven = 1.0 + 0.05 * np.sin(3.0 * angle + middle[0]) + 0.03 * np.sin(7.0 * angle)
    rings = []
    for share, lift in ((1.12, 0.5), (1.0, 2.0), (0.92, 1.0), (0.05, 1.0)):
        plan = middle[:2] + (share * radius * uneven)[:, None] * np.column_stack((np.cos(angle), np.sin(angle)))
        rings.append(_on_ground(plan, terrain) + [0.0, 0.0, lift * _LIFT])
    rows, count = len(rings), len(angle)
    faces = [
        (r * count + c, r * count + (c + 1) % count, (r + 1) * count + (c + 1) % count, (r + 1) * count + c)
        for r in range(rows - 1)
        for c in range(count)
    ]
    materials = ["rim" if index < 2 * count else "hole" for index in range(len(faces))]
    part = Part(np.concatenate(rings), [*faces, tuple(range((rows - 1) * count, rows * count))], [*materials, "hole"])
    return _facing_up(part)


def _line(places: Array, terrain: Terrain) -> Array:
    """Return points (m, 3) on the ground along a line of corners, half a metre apart at most."""
    parts = []
    for start, end in zip(places, places[1:], strict=False):
        count = max(int(np.ceil(np.linalg.norm(end - start) / _STEP)), 1)
        parts.append(start[:2] + np.linspace(0.0, 1.0, count, endpoint=False)[:, None] * (end - start)[:2])
    return _on_ground(np.concatenate([*parts, places[-1:, :2]]), terrain)


def _edge(places: Array, terrain: Terrain) -> Part:
    """Return a painted line on the ground."""
    line = _line(places, terrain)
    ahead = np.gradient(line[:, :2], axis=0)
    left = np.column_stack((-ahead[:, 1], ahead[:, 0])) / np.linalg.norm(ahead, axis=1)[:, None]
    sides = [_on_ground(line[:, :2] + side * EDGE_WIDTH * left, terrain) + [0, 0, _LIFT] for side in (-0.5, 0.5)]
    count = len(line)
    faces = [(i, i + 1, count + i + 1, count + i) for i in range(count - 1)]
    return _facing_up(Part(np.concatenate(sides), faces, ["edge"] * len(faces)))


def _net(places: Array, terrain: Terrain) -> Part:
    """Return a safety net on posts."""
    line = _line(places, terrain)
    up = np.array([0.0, 0.0, NET_HEIGHT])
    count = len(line)
    vertices = np.concatenate((line + 0.15 * up, line + up))
    faces = [(i, i + 1, count + i + 1, count + i) for i in range(count - 1)]
    net = Part(vertices, faces, ["net"] * len(faces))
    every = max(round(POST_SPACING / _STEP), 1)
    feet = [*line[:-1:every], line[-1]]
    return join([net, *(tube([foot - 0.2 * up, foot + 1.08 * up], 0.02, "post", 8) for foot in feet)])


def _wall(places: Array) -> Part:
    """Return a low block over a polygon's corners."""
    count = len(places)
    up = np.array([0.0, 0.0, WALL_HEIGHT])
    vertices = np.concatenate((places - 0.5 * up, places + up))
    sides = [(i, (i + 1) % count, count + (i + 1) % count, count + i) for i in range(count)]
    faces = [*sides, tuple(range(count, 2 * count)), tuple(reversed(range(count)))]
    return facing_out(Part(vertices, faces, ["rock"] * len(faces)))


def _facing_up(part: Part) -> Part:
    """Return a flat `part` with its faces turned to look up."""
    faces = []
    for face in part.faces:
        a, b, c = (part.vertices[i] for i in face[:3])
        faces.append(face if np.cross(b - a, c - a)[2] > 0.0 else tuple(reversed(face)))
    return Part(part.vertices, faces, part.materials, part.weights)
