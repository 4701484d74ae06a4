"""Wire shapes that stand for bones in the viewport: rings round limbs and wheels, outlines for root and gear."""

from __future__ import annotations

import math
from collections.abc import Mapping

import bpy

Points = list[tuple[float, float, float]]

_SIZE = {
    "head": 0.085,
    "chest": 0.135,
    "abdomen": 0.125,
    "pelvis": 0.140,
    "upper_arm": 0.055,
    "forearm": 0.048,
    "hand": 0.050,
    "thigh": 0.085,
    "shank": 0.070,
    "foot": 0.060,
}
"""Radius of a bone's ring by part, as a share of stature."""


def bone_shape(
    bone: str, length: float, height: float, sizes: Mapping[str, float]
) -> tuple[bpy.types.Object, tuple[float, float, float]]:
    """Return the shape object of `bone` and its scale, for a bone of `length` [m] of a person of `height` [m].

    `sizes` [m] are those of the figure's gear.
    """
    part = bone.partition(".")[0]
    if part == "root":
        return _shape("root", _arrow(), closed=True), (0.3 * height,) * 3
    if part == "ski":
        return _shape("ski", _ski_outline(), closed=True), (0.07, length, 0.07)
    if part == "board":
        return _shape("board", _board_outline(), closed=True), (0.6 * sizes["width"], length, 0.07)
    if part in ("pole", "frame", "fork"):
        return _shape("pole", [(0.0, 0.0, 0.0), (0.0, 1.0, 0.0)], closed=False), (length,) * 3
    if part in ("wheel_rear", "wheel_front"):
        return _shape("wheel", _wheel(), closed=True), (1.03 * sizes["wheel_radius"],) * 3
    if part == "crank":
        return _shape("wheel", _wheel(), closed=True), (sizes["crank_length"],) * 3
    if part == "pedal":
        return _shape("pedal", _square(), closed=True), (0.06,) * 3
    return _shape("ring", _ring(), closed=True), (_SIZE[part] * height,) * 3


def _shape(name: str, points: Points, closed: bool) -> bpy.types.Object:
    full_name = f"Ski bone {name}"
    existing = bpy.data.objects.get(full_name)
    if existing is not None and existing.type == "MESH":
        return existing
    count = len(points)
    edges = [(i, (i + 1) % count) for i in range(count if closed else count - 1)]
    mesh = bpy.data.meshes.new(full_name)
    mesh.from_pydata(points, edges, [])
    return bpy.data.objects.new(full_name, mesh)


def _ring() -> Points:
    return [(math.cos(a), 0.0, math.sin(a)) for a in (2.0 * math.pi * i / 24 for i in range(24))]


def _wheel() -> Points:
    """Return a ring with one spoke, so that its turning is seen."""
    return [(0.0, 0.0, 0.0), *_ring(), (1.0, 0.0, 0.0)]


def _square() -> Points:
    return [(-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0), (-1.0, 1.0, 0.0)]


def _arrow() -> Points:
    return [
        *((-0.5, -0.7, 0.0), (0.5, -0.7, 0.0), (0.5, 0.5, 0.0)),
        *((0.8, 0.5, 0.0), (0.0, 1.2, 0.0), (-0.8, 0.5, 0.0), (-0.5, 0.5, 0.0)),
    ]


def _ski_outline() -> Points:
    """Return a ski seen from above: x across, y along, in units of half width and bone length."""
    side = [(-1.35, -1.4), (-0.8, 0.0), (-1.0, 0.8), (-0.9, 1.2), (-0.4, 1.42)]
    return [(x, y, 0.0) for x, y in side] + [(-x, y, 0.0) for x, y in reversed(side)]


def _board_outline() -> Points:
    """Return a snowboard seen from above, like `_ski_outline`."""
    quarter = [(1.0, 0.0), (1.1, 1.0), (0.9, 1.28), (0.45, 1.43)]
    right = [(x, -y) for x, y in reversed(quarter[1:])] + quarter
    return [(x, y, 0.0) for x, y in right] + [(-x, y, 0.0) for x, y in reversed(right)]
