"""Foreign armatures at rest by plain numbers: bones of a T-pose or A-pose, with any roll, and their evaluation."""

from __future__ import annotations

from typing import Any

import numpy as np

from ski_addon.animation.target import TargetRest
from ski_addon.frames import matrix_from_quaternion

JOINTS = {  # (parent, head, tail) [m] of a person of 1.80 m in a T-pose that faces -y; the left side is at +x
    "root": ("", (0, 0, 0), (0, 0.3, 0)),
    "pelvis": ("root", (0, 0.01, 1.0), (0, 0.01, 1.1)),
    "spine_01": ("pelvis", (0, 0.02, 1.1), (0, 0.01, 1.2)),
    "spine_02": ("spine_01", (0, 0.01, 1.2), (0, 0, 1.32)),
    "spine_03": ("spine_02", (0, 0, 1.32), (0, 0.02, 1.52)),
    "neck_01": ("spine_03", (0, 0.02, 1.52), (0, 0, 1.62)),
    "head": ("neck_01", (0, 0, 1.62), (0, 0, 1.8)),
    "clavicle_l": ("spine_03", (0.02, 0.01, 1.48), (0.17, 0.03, 1.46)),
    "upperarm_l": ("clavicle_l", (0.17, 0.03, 1.46), (0.45, 0.04, 1.46)),
    "lowerarm_l": ("upperarm_l", (0.45, 0.04, 1.46), (0.71, 0.02, 1.46)),
    "hand_l": ("lowerarm_l", (0.71, 0.02, 1.46), (0.89, 0.01, 1.45)),
    "thigh_l": ("pelvis", (0.1, 0.01, 0.95), (0.11, 0.0, 0.51)),
    "calf_l": ("thigh_l", (0.11, 0.0, 0.51), (0.12, 0.03, 0.09)),
    "foot_l": ("calf_l", (0.12, 0.03, 0.09), (0.13, -0.1, 0.02)),
    "ball_l": ("foot_l", (0.13, -0.1, 0.02), (0.13, -0.18, 0.02)),
}


def with_right_side(joints: dict[str, Any] = JOINTS) -> dict[str, Any]:
    """The joints with the right side added, mirrored in x = 0."""
    out = dict(joints)
    for name, (parent, head, tail) in joints.items():
        if name.endswith("_l"):
            over = parent[:-2] + "_r" if parent.endswith("_l") else parent
            out[name[:-2] + "_r"] = (over, (-head[0], *head[1:]), (-tail[0], *tail[1:]))
    return out


def rest_of(joints: dict[str, Any], seed: int = 5) -> TargetRest:
    """The armature at rest in Blender's way: y along each bone, and a roll by chance."""
    names = tuple(joints)
    matrix = np.tile(np.eye(4), (len(names), 1, 1))
    random = np.random.default_rng(seed)
    for i, (_, head, tail) in enumerate(joints.values()):
        y = np.subtract(tail, head) / np.linalg.norm(np.subtract(tail, head))
        x = np.cross(y, random.normal(size=3))
        x /= np.linalg.norm(x)
        matrix[i, :3, :3] = np.stack((x, y, np.cross(x, y)), axis=1)
        matrix[i, :3, 3] = head
    parent = np.array([names.index(p) if p else -1 for p, _, _ in joints.values()])
    tail = np.array([t for _, _, t in joints.values()], dtype=float)
    return TargetRest(names, parent, matrix, tail, np.ones(len(names), dtype=bool))


def turned(rest: TargetRest, by: np.ndarray) -> TargetRest:
    """The same armature at rest with all its bones turned by `by` (3, 3) about its origin."""
    whole = np.eye(4)
    whole[:3, :3] = by
    return TargetRest(rest.bones, rest.parent, whole @ rest.matrix, rest.tail @ by.T, rest.turns)


def in_a_pose(joints: dict[str, Any], degrees: float = 45.0) -> dict[str, Any]:
    """The T-pose of `joints` with its arms let down."""
    out = dict(joints)
    for side, sign in (("_l", 1.0), ("_r", -1.0)):
        pivot = np.array(joints["upperarm" + side][1])
        angle = np.radians(degrees) * sign
        turn = np.array([[np.cos(angle), 0, np.sin(angle)], [0, 1, 0], [-np.sin(angle), 0, np.cos(angle)]])
        for name in ("upperarm", "lowerarm", "hand"):
            parent, head, tail = joints[name + side]
            out[name + side] = (parent, *(tuple(pivot + turn @ (np.array(p) - pivot)) for p in (head, tail)))
    return out


def evaluate(keyframes: Any, rest: TargetRest) -> dict[str, np.ndarray]:
    """Pose matrices (m, 4, 4) in armature space, as Blender makes them from local channels."""
    channels = {channel.bone: channel for channel in keyframes.channels}
    pose: list[np.ndarray] = []
    for index, bone in enumerate(rest.bones):
        basis = np.tile(np.eye(4), (len(keyframes.frame), 1, 1))
        if bone in channels:
            basis[:, :3, :3] = matrix_from_quaternion(channels[bone].rotation)
            if channels[bone].location is not None:
                basis[:, :3, 3] = channels[bone].location
        over = rest.parent[index]
        local = rest.matrix[index] if over < 0 else np.linalg.inv(rest.matrix[over]) @ rest.matrix[index]
        pose.append((local if over < 0 else pose[over] @ local) @ basis)
    return dict(zip(rest.bones, pose, strict=True))


def angle_between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """The angle [degrees] between vectors (..., 3)."""
    a, b = (v / np.linalg.norm(v, axis=-1, keepdims=True) for v in (a, b))
    return np.degrees(2.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(a - b, axis=-1), 0.0, 1.0)))
