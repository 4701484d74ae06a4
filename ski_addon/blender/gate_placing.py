"""Gates as objects of the scene: set by hand or by the course setter, numbered, coloured and put on the snow."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ..frames import Array, quaternion_from_matrix
from ..spec import RunSpec
from . import changes
from .course_objects import gate_fields, standing_gates
from .fields import write_field
from .gate_carrier import carry, frame_of, own_turn
from .placing import document_places, moved, on_ground, run_from_world, terrain_of, world_from_run
from .properties import read_spec

GROUND_MARK = "ski_addon_ground"
"""Custom property of what a bake put under a run."""
RAY_REACH = 5000.0
"""How far a mouse ray is followed [m]."""


def add_gate(settings: Any, place: Array) -> bpy.types.Object:
    """Stand a new gate at `place` (3,) [m, world] for a skier; returns its turning pole."""
    pole = _new_pole(settings, place)
    drop_baked_gates(settings)
    use_standing(settings)
    turn_round_the_outside(settings)
    refresh_gates(settings)
    return pole


def use_standing(settings: Any) -> None:
    """Let the skier's course be the gates that stand in the scene."""
    with changes.held():
        settings.course.kind, settings.course.gate_setting = "gates", "list"
    changes.changed(settings)


def set_gates(settings: Any, spec: RunSpec) -> list[bpy.types.Object]:
    """Stand the gates that `spec` asks for in place of those that stand there; raises `SpecError`."""
    from ..course import course_gates

    gates = course_gates(spec, terrain_of(spec.slope))
    clear_gates(settings)
    if gates is None:
        return []
    rows = spec.gate if spec.course.gate_setting == "list" else ()
    world = moved(world_from_run(settings), np.array(gates.position))
    poles = [_new_pole(settings, place) for place in world]
    for pole, row in zip(poles, rows, strict=False):
        for info in gate_fields():
            write_field(pole.ski_gate, info, getattr(row, info.name))
    drop_baked_gates(settings)
    use_standing(settings)
    refresh_gates(settings)
    return poles


def clear_gates(settings: Any) -> None:
    """Remove the gates that stand in the scene for a skier."""
    if settings.gates is None:
        return
    poles = [obj for obj in settings.gates.all_objects if obj.ski_gate.is_gate]
    for obj in [part for pole in poles for part in pole.children] + poles:
        bpy.data.objects.remove(obj)


def turn_round_the_outside(settings: Any) -> None:
    """Let the first turn be the one that goes round the outside of the first gate, seen from the second.

    Turns alternate from there, so whoever sets gates from side to side need not know which turn comes first.
    """
    bpy.context.view_layer.update()
    gates = read_spec(settings).gate
    if len(gates) > 1:
        settings.course.first_turn = "right" if gates[0].y > gates[1].y else "left"


def drop_baked_gates(settings: Any) -> None:
    """Remove the gates that a bake, or Make Slope, built by the settings: those that are set now take their place."""
    if settings.ground is None:
        return
    for child in settings.ground.children:
        for obj in [obj for obj in child.objects if obj.get(GROUND_MARK)]:
            bpy.data.objects.remove(obj)


def refresh_gates(settings: Any) -> None:
    """Number and colour the standing gates from the top of the slope down, and put them on the snow.

    Nothing is done where the settings ask for no course that can be read.
    """
    from ..course import course_gates
    from .gates import dress_gate, has_panels

    bpy.context.view_layer.update()
    spec = read_spec(settings)
    poles = standing_gates(settings, spec)
    if not poles:
        return
    places = np.array([pole.matrix_world.translation for pole in poles])
    feet = on_ground(settings, spec.slope, document_places(settings, spec.slope, places))
    gates = course_gates(spec, terrain_of(spec.slope))
    wide = gates is not None and has_panels(gates)
    sides = [1.0] * len(poles) if gates is None else gates.side.tolist()
    for pole in poles:
        pole.name = "Gate to be numbered"
    upright = quaternion_from_matrix(world_from_run(settings)[:3, :3])
    for index, (pole, foot, side) in enumerate(zip(poles, feet, sides, strict=True)):
        put_object(pole, foot)
        pole.rotation_quaternion = own_turn(pole, upright.tolist())
        dress_gate(pole, index, side if wide else 0.0)
    bpy.context.view_layer.update()


def ground_under_ray(settings: Any, spec: RunSpec, origin: Array, direction: Array) -> Array | None:
    """Return the point (3,) [m, world] where a ray from `origin` (3,) along `direction` (3,) meets the ground."""
    inverse = run_from_world(settings)
    begin = moved(inverse, np.asarray(origin, dtype=float)[None])[0]
    along = inverse[:3, :3] @ np.asarray(direction, dtype=float)
    terrain = terrain_of(spec.slope)

    def over(way: Array) -> Array:
        place = begin + way[:, None] * along
        return np.asarray(place[:, 2] - terrain.height(place[:, 0], place[:, 1]))

    ways = np.concatenate(([0.0], np.geomspace(0.05, RAY_REACH, 600)))
    height = over(ways)
    below = np.flatnonzero((height[:-1] > 0.0) & (height[1:] <= 0.0))
    if not len(below):
        return None
    low, high = ways[below[0]], ways[below[0] + 1]
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if over(np.array([middle]))[0] > 0.0 else (low, middle)
    return moved(world_from_run(settings), (begin + high * along)[None])[0]


def _new_pole(settings: Any, place: Array) -> bpy.types.Object:
    from .gates import stand_pole

    pole = stand_pole(_collection(settings), 0)
    pole.ski_gate.is_gate = True
    carry(pole, _collection(settings), settings.start)
    put_object(pole, place)
    return pole


def put_object(obj: bpy.types.Object, place: Array) -> None:
    """Move an object to `place` (3,) [m, world], whatever it is parented to."""
    obj.location = moved(np.linalg.inv(np.array(frame_of(obj))), np.asarray(place, dtype=float)[None])[0].tolist()


def _collection(settings: Any) -> bpy.types.Collection:
    """Return the collection of a skier's gates, made beside the skier on first use."""
    if settings.gates is None:
        skier = settings.id_data
        settings.gates = bpy.data.collections.new(f"{skier.name} gates")
        parents = skier.users_collection or (bpy.context.scene.collection,)
        parents[0].children.link(settings.gates)
    return settings.gates
