"""Bake: world poses become keyframes on a figure's armature; the poses of a recording on a skier's."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..animation.bone_map import BoneMap
from ..animation.keyframes import bone_keyframes
from ..animation.poses import BodyPoses, Channel, sample_body_poses, sample_channels
from ..body import Skeleton, build_skeleton
from ..errors import SpecError
from ..frames import Array
from ..spec import BakeSpec, RunSpec, SkierSpec
from .armature_keys import ArmatureKeys
from .channels import assign_action, bake_action
from .fewer_keys import FewerKeys, KeyOptions
from .frame_rate import scene_rate
from .rig import build_rig, rest_pose
from .skier.figure import Figure, build_figure
from .strips import add_strip, take_strip

if TYPE_CHECKING:
    from ..simulation.recording import Recording

BONE_MAP = Path(__file__).resolve().parents[2] / "presets" / "bone_maps" / "skier.toml"
CHANNEL_GROUP = "Ski run"
SKIER_PROPERTY = "ski_skier"
"""Custom property of an armature's data: the measures of the skier it was made for."""


@dataclass(frozen=True)
class BakeResult:
    """What a bake made: the `armature`, its `action`, its first and last frame (the last may be a part of one), and a
    `note` for the user, if there is one.
    """

    armature: bpy.types.Object
    action: bpy.types.Action
    frame_first: float
    frame_last: float
    note: str = ""


def recorded_run(recording: Recording) -> RunSpec:
    """Return the run document that `recording` was made from."""
    return RunSpec.from_text(recording.header["spec"], "the run document in the recording")


def recorded_skier(recording: Recording) -> SkierSpec:
    """Return the skier that `recording` was made with."""
    return recorded_run(recording).skier


def bake_recording(
    recording: Recording,
    scene: bpy.types.Scene,
    *,
    armature: bpy.types.Object | None = None,
    options: BakeSpec | None = None,
    bone_map: BoneMap | None = None,
    world_from_run: Array | None = None,
    keys: KeyOptions | None = None,
) -> BakeResult:
    """Bake `recording` in `scene`, at the scene's own frame rate, onto `armature` (default: a new skier).

    `options` gives keys per frame, first frame and the action's name; its frame rate is not used. The frame range of
    scene and action is set. Nothing else of the file is changed, the selection included. `world_from_run` (4, 4) says
    where in the world the run lies (default: its start is the world's origin); `keys` as in `bake_poses`.
    """
    options, keys = options or BakeSpec(), keys or KeyOptions()
    skier = recorded_skier(recording)
    skeleton = build_skeleton(skier)
    bone_map = bone_map or BoneMap.load(BONE_MAP)
    poses = sample_body_poses(recording, skeleton, scene_rate(scene), options.subframes, options.frame_start)
    poses = poses.within(keys.span)
    if armature is None:
        armature = new_skier(skier, skeleton, scene)
    channels = sample_channels(recording, poses.time)
    poses = poses.moved(world_from_run)
    return bake_poses(poses, channels, armature, build_figure(skeleton), bone_map, scene, options.action, keys)


def bake_poses(
    poses: BodyPoses,
    channels: tuple[Channel, ...],
    armature: bpy.types.Object,
    figure: Figure,
    bone_map: BoneMap,
    scene: bpy.types.Scene,
    name: str,
    keys: KeyOptions | None = None,
) -> BakeResult:
    """Bake `poses` and `channels` of `figure` onto `armature`; `name` is that of a new action.

    `keys` says which keys are left out and whether the action becomes a strip; `poses` are in its span already. The
    frame range of scene and action is set. Nothing else of the file is changed.
    """
    keys = keys or KeyOptions()
    check_armature(armature, bone_map, poses.body_names)
    rest = rest_pose(armature, bone_map, figure)
    keyframes = bone_keyframes(poses, bone_map, rest, np.array(armature.matrix_world.inverted()))
    action, slot, channelbag = bake_action(armature, name, take_strip(armature))
    for bone_keys in keyframes.channels:
        armature.pose.bones[bone_keys.bone].rotation_mode = "QUATERNION"
    ArmatureKeys(armature, channelbag, keys.tolerance_deg, 0.001 * keys.tolerance_mm, 1.0).write_bones(keyframes)
    write_channels(armature, channels, FewerKeys(channelbag, poses.frame, keys))
    set_range(scene, action, poses.frame)
    note = ""
    if keys.as_strip:
        note = add_strip(armature, action, slot)
    else:
        assign_action(armature, action, slot)
    return BakeResult(armature, action, float(poses.frame[0]), float(poses.frame[-1]), note)


def new_skier(skier: SkierSpec, skeleton: Skeleton, scene: bpy.types.Scene) -> bpy.types.Object:
    """Make a skier of the measures of `skier` in `scene` and return its armature."""
    armature = build_rig(skeleton, scene).armature
    mark_skier(armature, skier)
    return armature


def mark_skier(armature: bpy.types.Object, skier: SkierSpec) -> None:
    """Note in `armature` for whose measures it was made; see `fits`."""
    armature.data[SKIER_PROPERTY] = _measures(skier)


def fits(armature: bpy.types.Object, skier: SkierSpec) -> bool:
    """Return whether `armature` is a skier made with just the measures of `skier`."""
    if armature.type != "ARMATURE":
        return False
    measures = armature.data.get(SKIER_PROPERTY)
    return measures is not None and measures.to_dict() == _measures(skier)


def _measures(skier: SkierSpec) -> dict[str, float | str]:
    return dict(RunSpec(skier=skier).to_dict()["skier"])


def check_armature(armature: bpy.types.Object, bone_map: BoneMap, bodies: Iterable[str]) -> None:
    """Raise `SpecError` unless every bone of `bone_map` is there and those that move are free to.

    `bodies` are the names of all bodies that bones may follow.
    """
    if armature.type != "ARMATURE":
        raise SpecError(armature.name, armature.type, "ARMATURE", "choose a skier's armature", problem="is not an")
    bone_map.check(armature.data.bones.keys(), bodies)
    for entry in bone_map.entries:
        if entry.location and armature.data.bones[entry.bone].use_connect:
            hint = "turn its Connected off, or take location out of the bone map"
            raise SpecError(f"bones.{entry.bone}", None, "", hint, problem="is a connected bone and cannot move")


def write_channels(armature: bpy.types.Object, channels: tuple[Channel, ...], writer: FewerKeys) -> None:
    """Write numbers to drive with as animated custom properties of `armature`."""
    for channel in channels:
        armature[channel.name] = float(channel.values[0])
        unit = f" [{channel.unit}]" if channel.unit else ""
        armature.id_properties_ui(channel.name).update(description=channel.doc + unit)
        writer.numbers(f'["{channel.name}"]', channel.values, CHANNEL_GROUP)


def set_range(scene: bpy.types.Scene, action: bpy.types.Action, frame: np.ndarray) -> None:
    """Let `scene` and `action` run over the keys at `frame` (m,)."""
    action.use_frame_range = True
    action.frame_start, action.frame_end = float(frame[0]), float(frame[-1])
    scene.frame_start, scene.frame_end = int(np.ceil(frame[0])), int(np.floor(frame[-1]))
