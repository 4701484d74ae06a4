"""Keys of a foreign armature: in each bone's own rotation mode, fewer where asked for, poses by hand cleared."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import bpy
import numpy as np

from ..animation.bone_map import BoneMap
from ..animation.keyframes import BoneKeyframes
from ..animation.reduction import kept_places, kept_rotations
from ..animation.rotation_modes import rotation_path, to_mode
from ..frames import Array, continuous_quaternions, quaternion_from_matrix
from .channels import KeyWriter

OBJECT_GROUP = "Object Transforms"
RESTING = {
    "location": (0.0, 0.0, 0.0),
    "scale": (1.0, 1.0, 1.0),
    "rotation_quaternion": (1.0, 0.0, 0.0, 0.0),
    "rotation_euler": (0.0, 0.0, 0.0),
    "rotation_axis_angle": (0.0, 0.0, 1.0, 0.0),
}


class ArmatureKeys:
    """Writes into `channelbag`; keys are left out that deviate by less than `degrees`, and `metres` in the world.

    `scale` is the length in metres of the armature's unit.
    """

    def __init__(
        self, armature: bpy.types.Object, channelbag: Any, degrees: float, metres: float, scale: float
    ) -> None:
        self._armature = armature
        self._channelbag = channelbag
        self._degrees, self._metres, self._scale = degrees, metres, scale
        self._written: set[str] = set()

    def write_bones(self, keyframes: BoneKeyframes) -> None:
        """Write the keys of all mapped bones."""
        for channels in keyframes.channels:
            path = _bone_path(channels.bone)
            if channels.location is not None:
                self._place(f"{path}.location", keyframes.frame, channels.location, self._scale, channels.bone)
            mode = self._armature.pose.bones[channels.bone].rotation_mode
            self._rotation(path + ".", keyframes.frame, channels.rotation, mode, channels.bone)

    def write_object(self, frame: Array, world: Array) -> None:
        """Write the way `world` (m, 4, 4) of the armature object, without its scale."""
        rotation = world[:, :3, :3] / np.linalg.norm(world[:, :3, :1], axis=1, keepdims=True)
        quaternion = continuous_quaternions(quaternion_from_matrix(rotation))
        self._place("location", frame, world[:, :3, 3], 1.0, OBJECT_GROUP)
        self._rotation("", frame, quaternion, self._armature.rotation_mode, OBJECT_GROUP)

    def write_settings(self, bone_map: BoneMap, frame: Array) -> tuple[str, ...]:
        """Key the map's switches once, and return those whose property does not exist."""
        missing = []
        for setting in bone_map.settings:
            if setting.name not in self._armature.pose.bones[setting.bone]:
                missing.append(f"{setting.bone}.{setting.name}")
                continue
            path = f'{_bone_path(setting.bone)}["{bpy.utils.escape_identifier(setting.name)}"]'
            KeyWriter(self._channelbag, frame[:1]).write(path, np.array([setting.value]), setting.bone)
        return tuple(missing)

    def clear_poses(self, bones: Iterable[str], frame: Array) -> None:
        """Key once at rest what someone posed by hand on `bones` and those above them, where nothing is keyed yet."""
        touched = dict.fromkeys(bones)
        for name in list(touched):
            touched |= dict.fromkeys(bone.name for bone in self._armature.data.bones[name].parent_recursive)
        for name in touched:
            bone = self._armature.pose.bones[name]
            for prop in ("location", rotation_path(bone.rotation_mode), "scale"):
                path = f"{_bone_path(name)}.{prop}"
                if path not in self._written and not _rests(bone, prop):
                    KeyWriter(self._channelbag, frame[:1]).write(path, np.array([RESTING[prop]]), name)

    def _place(self, path: str, frame: Array, values: Array, unit: float, group: str) -> None:
        self._write(path, frame, values, kept_places(frame, values, self._metres / unit), group)

    def _rotation(self, prefix: str, frame: Array, quaternion: Array, mode: str, group: str) -> None:
        values = to_mode(quaternion, mode)
        kept = kept_rotations(frame, values, mode, self._degrees)
        self._write(prefix + rotation_path(mode), frame, values, kept, group)

    def _write(self, path: str, frame: Array, values: Array, kept: Array, group: str) -> None:
        KeyWriter(self._channelbag, frame[kept]).write(path, values[kept], group)
        self._written.add(path)


def _bone_path(bone: str) -> str:
    return f'pose.bones["{bpy.utils.escape_identifier(bone)}"]'


def _rests(bone: bpy.types.PoseBone, prop: str) -> bool:
    now = np.array(getattr(bone, prop), dtype=float)
    if prop == "rotation_axis_angle":
        return abs(float(now[0])) < 1e-6
    return bool(np.abs(now - RESTING[prop]).max() < 1e-6)
