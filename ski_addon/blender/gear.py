"""Skis and poles for a foreign armature: objects on its feet and in its hands, made anew by every bake."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils import Matrix

from ..animation.poses import BodyPoses
from ..animation.retarget import Retargeted
from ..animation.target import TargetBody, TargetRest
from ..frames import Array, continuous_quaternions, matrix_from_quaternion, quaternion_from_matrix
from .channels import MARK, assign_action, bake_action
from .fewer_keys import FewerKeys, KeyOptions
from .meshes import part_mesh
from .skier.build import equipment_part
from .skier.figure import ALPINE_GEAR, build_figure

if TYPE_CHECKING:
    from ..body.skeleton import Skeleton

GEAR = "ski_addon_gear"
"""Custom property of gear objects, and of the meshes made for them: the body that they are."""
CARRIED_BY = {"ski": "foot", "pole": "hand"}


@dataclass(frozen=True)
class GearPlace:
    """How a piece of gear lies in the bone that carries it, from its head and in its axes.

    `bone`; `location` (3,) in the armature's units, `rotation` (m, 4) at every key, or (1, 4) for one that never turns.
    """

    bone: str
    location: Array
    rotation: Array


def gear_places(
    made: Retargeted,
    poses: BodyPoses,
    skeleton: Skeleton,
    target: TargetBody,
    rest: TargetRest,
    scale: float,
    on_ski: Array,
) -> dict[str, GearPlace]:
    """Return where each ski and pole lies, for those without a bone whose foot or hand has one.

    `poses` are those that `made` was made from, `scale` is the length in metres of the armature's unit, and `on_ski`
    (3,) [m] is where a ski is from the ankle, in the axes of the foot.
    """
    places = {}
    for body in ALPINE_GEAR:
        part, _, side = body.partition(".")
        carrier = f"{CARRIED_BY[part]}.{side}"
        if carrier not in target.main or body in target.main:
            continue
        bone = target.main[carrier]
        axes = rest.matrix[rest.bones.index(bone), :3, :3].T @ target.frame[carrier]  # bone from body
        if part == "ski":
            offset, turn = on_ski, axes[None]
        else:
            offset = made.size * np.asarray(skeleton.offset[skeleton.body(body)])
            pole = matrix_from_quaternion(poses.quaternion[:, poses.body_names.index(body)])
            turn = axes @ np.swapaxes(made.turn[carrier], -1, -2) @ pole
        rotation = continuous_quaternions(quaternion_from_matrix(turn))
        places[body] = GearPlace(bone, axes @ offset / scale, rotation)
    return places


def put_gear(
    armature: bpy.types.Object,
    places: dict[str, GearPlace],
    skeleton: Skeleton,
    frame: Array,
    scale: float,
    scene: bpy.types.Scene,
    name: str,
    keys: KeyOptions,
) -> tuple[bpy.types.Object, ...]:
    """Put every piece of `places` on `armature`, whose unit is `scale` metres; `name` is that of the poles' actions.

    `keys` says which keys are left out.

    Gear of an earlier bake is used again, also with a mesh that the user gave it. Gear without a place is removed.
    """
    earlier = {obj[GEAR]: obj for obj in armature.children if GEAR in obj}
    for body in earlier.keys() - places.keys():
        _remove(earlier[body])
    made = []
    for body, place in places.items():
        obj = earlier.get(body) or bpy.data.objects.new(f"{armature.name} {body}", _mesh(skeleton, body))
        if body in earlier and obj.data is not None and GEAR in obj.data:
            _replace_mesh(obj, _mesh(skeleton, body))
        _attach(obj, armature, place, scale)
        obj[GEAR] = body
        if not obj.users_collection:
            _collection_of(armature, scene).objects.link(obj)
        if len(place.rotation) > 1:
            action, slot, channelbag = bake_action(obj, f"{name} {body}")
            FewerKeys(channelbag, frame, keys).rotations("rotation_quaternion", place.rotation, "Object Transforms")
            assign_action(obj, action, slot)
        made.append(obj)
    return tuple(made)


def _attach(obj: bpy.types.Object, armature: bpy.types.Object, place: GearPlace, scale: float) -> None:
    """Hang `obj` on its bone so that its own transform counts from the bone's head."""
    bone = armature.data.bones[place.bone]
    obj.parent, obj.parent_type, obj.parent_bone = armature, "BONE", place.bone
    if bone.use_relative_parent:
        obj.matrix_parent_inverse = bone.matrix_local
    else:  # Blender hangs children on a bone's tail
        obj.matrix_parent_inverse = Matrix.Translation((0.0, -bone.length, 0.0))
    obj.rotation_mode = "QUATERNION"
    obj.location = place.location.tolist()
    obj.rotation_quaternion = place.rotation[0].tolist()
    obj.scale = (1.0 / scale,) * 3


def _mesh(skeleton: Skeleton, body: str) -> bpy.types.Mesh:
    figure = build_figure(skeleton)
    part = equipment_part(figure, body).moved(-figure.place[body]).turned(figure.turn[body].T)
    mesh = part_mesh(body, part)
    mesh[GEAR] = body
    return mesh


def _replace_mesh(obj: bpy.types.Object, mesh: bpy.types.Mesh) -> None:
    before, obj.data = obj.data, mesh
    if before.users == 0:
        bpy.data.meshes.remove(before)


def _remove(obj: bpy.types.Object) -> None:
    action = obj.animation_data.action if obj.animation_data else None
    mesh = obj.data
    bpy.data.objects.remove(obj)
    if action is not None and action.users == 0 and action.get(MARK):
        bpy.data.actions.remove(action)
    if mesh is not None and mesh.users == 0 and GEAR in mesh:
        bpy.data.meshes.remove(mesh)


def _collection_of(armature: bpy.types.Object, scene: bpy.types.Scene) -> bpy.types.Collection:
    editable = [collection for collection in armature.users_collection if collection.is_editable]
    return editable[0] if editable else scene.collection
