"""What carries gates along when a run's start object is moved: a hidden empty between the two.

Gates are not parented to the start object itself, for Blender draws a line from every object to a parent that is seen.
"""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import bpy
from mathutils import Matrix, Quaternion

MARK = "ski_gate_carrier"
"""Custom property of the empty."""


def carry(pole: bpy.types.Object, collection: bpy.types.Collection, start: bpy.types.Object | None) -> None:
    """Let `pole`, whose place is one of the run frame, go with `start` by the empty in `collection`."""
    if start is not None:
        there = _carriers(collection, start)
        pole.parent = there[0] if there else _new(collection, start)


def frame_of(obj: bpy.types.Object) -> Matrix:
    """Return the matrix (4, 4) from what an object's own location and rotation are measured in to the world.

    Blender does not work out the matrix of a hidden object of which nothing is seen, so a carrier's is made here.
    """
    parent = obj.parent
    if parent is None:
        return Matrix()
    world = frame_of(parent) @ parent.matrix_basis if parent.get(MARK) else parent.matrix_world
    return world @ obj.matrix_parent_inverse


def own_turn(obj: bpy.types.Object, turn: Any) -> tuple[float, float, float, float]:
    """Return the quaternion that an object needs of its own to be turned by the quaternion `turn` in the world."""
    w, x, y, z = frame_of(obj).to_quaternion().inverted() @ Quaternion(turn)
    return w, x, y, z


@contextlib.contextmanager
def gates_stay(settings: Any) -> Iterator[None]:
    """Keep a skier's gates where they are while the start object is moved within."""
    gates = settings.gates
    carriers = [] if gates is None or settings.start is None else _carriers(gates, settings.start)
    before = [frame_of(carrier) @ carrier.matrix_basis for carrier in carriers]
    yield
    for carrier, world in zip(carriers, before, strict=True):
        carrier.matrix_basis = frame_of(carrier).inverted_safe() @ world


def _carriers(collection: bpy.types.Collection, start: bpy.types.Object) -> list[bpy.types.Object]:
    return [obj for obj in collection.objects if obj.get(MARK) and obj.parent == start]


def _new(collection: bpy.types.Collection, start: bpy.types.Object) -> bpy.types.Object:
    carrier = bpy.data.objects.new(f"{start.name} gates", None)
    carrier[MARK] = True
    carrier.parent = start
    carrier.hide_viewport = carrier.hide_render = carrier.hide_select = True
    collection.objects.link(carrier)
    return carrier
