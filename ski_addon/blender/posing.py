"""A figure held still at moments of a run, without keyframes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..animation.bone_map import BoneMap
from ..animation.keyframes import bone_keyframes
from ..animation.poses import BodyPoses, body_poses_at
from ..frames import Array
from .bake import BONE_MAP
from .rig import Rig, rest_pose
from .skier.figure import Figure, build_figure

if TYPE_CHECKING:
    from ..body import Skeleton
    from ..simulation.recording import Recording


def posed(rig: Rig, recording: Recording, skeleton: Skeleton, time: Array) -> Iterator[int]:
    """Pose the skier `rig` at each of `time` [s] of `recording` in turn, yielding its index."""
    poses = body_poses_at(recording, skeleton, time)
    return posed_as(rig, build_figure(skeleton), BoneMap.load(BONE_MAP), poses)


def posed_as(rig: Rig, figure: Figure, bone_map: BoneMap, poses: BodyPoses) -> Iterator[int]:
    """Pose `rig` of `figure` in each of `poses` in turn, yielding its index."""
    keyframes = bone_keyframes(poses, bone_map, rest_pose(rig.armature, bone_map, figure))
    for index in range(len(poses.time)):
        for channels in keyframes.channels:
            bone = rig.armature.pose.bones[channels.bone]
            bone.rotation_quaternion = channels.rotation[index]
            if channels.location is not None:
                bone.location = channels.location[index]
        bpy.context.view_layer.update()
        yield index


def world_vertices(obj: bpy.types.Object) -> Array:
    """Return the world places (n, 3) of the evaluated vertices of `obj`."""
    evaluated = obj.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = evaluated.data
    vertices = np.empty(3 * len(mesh.vertices), dtype=np.float32)
    mesh.vertices.foreach_get("co", vertices)
    matrix = np.array(evaluated.matrix_world)
    return vertices.reshape(-1, 3) @ matrix[:3, :3].T + matrix[:3, 3]


def leave_copies(rig: Rig, collection: bpy.types.Collection) -> Array:
    """Leave copies of the posed meshes in `collection` and return their world vertices (n, 3)."""
    graph = bpy.context.evaluated_depsgraph_get()
    points = []
    for obj in rig.meshes:
        evaluated = obj.evaluated_get(graph)
        mesh = bpy.data.meshes.new_from_object(evaluated, depsgraph=graph)
        copy = bpy.data.objects.new(f"{obj.name} instant", mesh)
        copy.matrix_world = evaluated.matrix_world
        collection.objects.link(copy)
        points.append(world_vertices(obj))
    return np.concatenate(points)


def remove_rig(rig: Rig) -> None:
    """Remove a figure's objects from the file."""
    for obj in (*rig.meshes, rig.armature):
        bpy.data.objects.remove(obj)
