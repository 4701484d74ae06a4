"""World poses of bodies -> local channels of bones (`matrix_basis` taken apart), for all keys at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..frames import Array, affine_inverse, continuous_quaternions, quaternion_from_matrix
from .bone_map import BoneMap
from .poses import BodyPoses


@dataclass(frozen=True)
class RestPose:
    """An armature at rest, and the skier's bodies at the same moment.

    `bones` (n,) names with parents before children, `parent` (n,) index into them or -1, `bone_matrix` (n, 4, 4) rest
    matrix of each bone in armature space, `body_matrix` {body: (4, 4)} pose of each body in armature space at rest.
    """

    bones: tuple[str, ...]
    parent: Array
    bone_matrix: Array
    body_matrix: dict[str, Array]


@dataclass(frozen=True)
class BoneChannels:
    """Keys of one bone: `rotation` (m, 4) (w, x, y, z), and `location` (m, 3) or None for a bone that only turns."""

    bone: str
    rotation: Array
    location: Array | None


@dataclass(frozen=True)
class BoneKeyframes:
    """Keys of all mapped bones at `frame` (m,)."""

    frame: Array
    channels: tuple[BoneChannels, ...]


def bone_keyframes(
    poses: BodyPoses, bone_map: BoneMap, rest: RestPose, armature_from_world: Array | None = None
) -> BoneKeyframes:
    """Return the local channels that put every mapped bone where its body is.

    `armature_from_world` (4, 4) is the inverse of the armature object's world matrix (default: the armature stands at
    the world's origin). A bone keeps the offset to its body that both have in `rest`. Bones that are not mapped rest.
    """
    bone_map.check(rest.bones, poses.body_names)
    pose = _pose_matrices(poses, bone_map, rest, armature_from_world)
    wanted = {entry.bone: entry for entry in bone_map.entries}
    parents = {int(rest.parent[index]) for index, bone in enumerate(rest.bones) if bone in wanted}
    inverse = {parent: affine_inverse(pose[parent]) for parent in parents if parent >= 0}
    channels = []
    for index, bone in enumerate(rest.bones):
        if bone not in wanted:
            continue
        basis = _basis(index, pose, inverse, rest)
        rotation = continuous_quaternions(quaternion_from_matrix(_without_scale(basis[:, :3, :3])))
        location = basis[:, :3, 3].copy() if wanted[bone].location else None
        channels.append(BoneChannels(bone, rotation, location))
    return BoneKeyframes(poses.frame, tuple(channels))


def _pose_matrices(
    poses: BodyPoses, bone_map: BoneMap, rest: RestPose, armature_from_world: Array | None
) -> list[Array]:
    """Return the pose of every bone of `rest` in armature space, each (m, 4, 4); unmapped bones follow their parent."""
    world = poses.matrices()
    body_index = {name: i for i, name in enumerate(poses.body_names)}
    body_of = {entry.bone: entry.body for entry in bone_map.entries}
    pose: list[Array] = []
    for index, bone in enumerate(rest.bones):
        if bone in body_of:
            body = body_of[bone]
            offset = np.linalg.inv(rest.body_matrix[body]) @ rest.bone_matrix[index]
            matrix = _after(world[:, body_index[body]], offset)
            pose.append(matrix if armature_from_world is None else _before(armature_from_world, matrix))
        elif rest.parent[index] < 0:
            pose.append(np.broadcast_to(rest.bone_matrix[index], (len(poses.frame), 4, 4)))
        else:
            pose.append(_after(pose[rest.parent[index]], _parent_from_bone(index, rest)))
    return pose


def _parent_from_bone(index: int, rest: RestPose) -> Array:
    return np.linalg.inv(rest.bone_matrix[rest.parent[index]]) @ rest.bone_matrix[index]


def _basis(index: int, pose: list[Array], inverse: dict[int, Array], rest: RestPose) -> Array:
    if rest.parent[index] < 0:
        return _before(np.linalg.inv(rest.bone_matrix[index]), pose[index])
    local = inverse[int(rest.parent[index])] @ pose[index]
    return _before(np.linalg.inv(_parent_from_bone(index, rest)), local)


def _after(many: Array, one: Array) -> Array:
    """Return the products `many` (m, 4, 4) times `one` (4, 4), as one product of large matrices: it is quicker."""
    return (many.reshape(-1, 4) @ one).reshape(-1, 4, 4)


def _before(one: Array, many: Array) -> Array:
    """Return the products `one` (4, 4) times `many` (m, 4, 4)."""
    return (one @ many.transpose(1, 0, 2).reshape(4, -1)).reshape(4, -1, 4).transpose(1, 0, 2)


def _without_scale(rotation: Array) -> Array:
    return rotation / np.sqrt(np.einsum("mij,mij->mj", rotation, rotation))[:, None]
