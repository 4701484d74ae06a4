"""Bake on a user's armature: find the bone map that fits it, check it, and lay a recording on it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import bpy
import numpy as np
from mathutils import Matrix

from ..animation.bone_map import BoneMap
from ..animation.poses import BodyPoses, Channel, sample_body_poses, sample_channels
from ..animation.retarget import Retargeted, RetargetOptions, retarget, ski_in_foot
from ..animation.span import ALL_FRAMES, FrameSpan
from ..animation.target import measure_target
from ..body import build_skeleton
from ..errors import SpecError
from ..frames import Array
from ..spec import BakeSpec
from .armature_checks import check_free, check_object, check_scale, check_size, check_upright, target_rest
from .armature_keys import ArmatureKeys
from .armature_maps import FoundMap, detect_bone_map, user_map_folder
from .bake import recorded_skier, scene_rate, set_range, write_channels
from .channels import MARK, assign_action, bake_action
from .fewer_keys import FewerKeys, KeyOptions
from .gear import gear_places, put_gear
from .skier.figure import SOLE_ABOVE_SKI_BASE
from .strips import add_strip, take_strip

if TYPE_CHECKING:
    from ..body import Skeleton
    from ..simulation.recording import Recording

__all__ = ["ArmatureBake", "ArmatureOptions", "FoundMap", "bake_on_armature", "detect_bone_map", "user_map_folder"]
EQUIPMENT = ("objects", "none")
LIMITS = (("tolerance_deg", 10.0, "degrees"), ("tolerance_mm", 100.0, "mm"), ("tolerance_percent", 20.0, "percent"))
"""The largest tolerances with which keys are left out."""
PLACE = "ski_addon_place"
"""Custom property of an armature object that a bake moves: its world matrix before the first such bake."""
VISIBLE_MISS = 0.005
"""Distance [m] between feet and skis that is worth a note."""


@dataclass(frozen=True)
class ArmatureOptions:
    """How a recording is baked on a user's armature.

    `root` and `legs` as in `RetargetOptions`; `equipment`: "objects" makes skis and poles, "none" leaves (and takes)
    them away; `sole_height` [m] of the soles above the skis' bases, None for that of the skis made here, or 0 without;
    `as_strip` makes a strip of the nonlinear animation instead of the active action; keys that deviate by less than
    `tolerance_deg` [degrees], `tolerance_mm` [mm] or `tolerance_percent` of a number's range are left out, 0 keeps all;
    of the frames only those in `span` are baked.
    """

    root: str = "pelvis"
    legs: str = "reach"
    equipment: str = "objects"
    sole_height: float | None = None
    as_strip: bool = False
    tolerance_deg: float = 0.0
    tolerance_mm: float = 0.0
    tolerance_percent: float = 0.0
    span: FrameSpan = ALL_FRAMES

    def __post_init__(self) -> None:
        if self.equipment not in EQUIPMENT:
            allowed = ", ".join(EQUIPMENT)
            raise SpecError("retarget.equipment", self.equipment, allowed, problem="is not one of")
        for name, most, unit in LIMITS:
            if not 0.0 <= getattr(self, name) <= most:
                raise SpecError(f"retarget.{name}", getattr(self, name), f"0..{most:g} {unit}", "0 keeps every key")
        self.retargeting()

    @property
    def keys(self) -> KeyOptions:
        """Which keys are written."""
        tolerances = self.tolerance_deg, self.tolerance_mm, self.tolerance_percent
        return KeyOptions(self.as_strip, *tolerances, self.span)

    def retargeting(self, on_own_skis: bool = False) -> RetargetOptions:
        """Return the part of the options that the library without Blender needs.

        `on_own_skis`: the armature has skis of its own, on which it stands at rest.
        """
        usual = SOLE_ABOVE_SKI_BASE if self.equipment == "objects" and not on_own_skis else 0.0
        return RetargetOptions(self.root, self.legs, usual if self.sole_height is None else self.sole_height)


@dataclass(frozen=True)
class ArmatureBake:
    """What a bake on a user's armature made: its `action`, first and last frame, the `gear` objects, and `notes`, one
    line each, on what the user should know; `foot_error` [m] is the largest distance of a foot from its ski.
    """

    armature: bpy.types.Object
    action: bpy.types.Action
    frame_first: float
    frame_last: float
    gear: tuple[bpy.types.Object, ...]
    notes: tuple[str, ...] = field(default=())
    foot_error: float = 0.0


def bake_on_armature(
    recording: Recording,
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    bone_map: BoneMap | None = None,
    options: ArmatureOptions | None = None,
    bake: BakeSpec | None = None,
    world_from_run: Array | None = None,
) -> ArmatureBake:
    """Bake `recording` on the user's `armature`, at the scene's frame rate, with the map that fits it best by default.

    `bake` gives keys per frame, first frame and the action's name, `world_from_run` (4, 4) where the run lies.
    An earlier bake of this armature is replaced; every other action is kept. Raises `SpecError` with one line, before
    anything is changed, if the armature cannot be used.
    """
    options, bake = options or ArmatureOptions(), bake or BakeSpec()
    check_object(armature)
    skeleton = build_skeleton(recorded_skier(recording))
    poses = sample_body_poses(recording, skeleton, scene_rate(scene), bake.subframes, bake.frame_start)
    poses = poses.within(options.span)
    run = BakedRun(poses.moved(world_from_run), sample_channels(recording, poses.time), skeleton)
    return lay_on_armature(run, scene, armature, bone_map, options, bake.action)


@dataclass(frozen=True)
class BakedRun:
    """The motion that is laid on an armature: world `poses` of the skier `skeleton` and numbers to drive with."""

    poses: BodyPoses
    channels: tuple[Channel, ...]
    skeleton: Skeleton


def lay_on_armature(
    run: BakedRun,
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    bone_map: BoneMap | None,
    options: ArmatureOptions,
    name: str,
) -> ArmatureBake:
    """Bake `run`, whoever made it, on the user's `armature`; see `bake_on_armature`. `name` is that of the action."""
    check_object(armature)
    if bone_map is None:
        found = detect_bone_map(armature)
        bone_map, missing = found.bone_map, found.missing
    else:
        bone_map, missing = bone_map.resolved(armature.data.bones.keys())
    poses, skeleton = run.poses, run.skeleton
    rest, place = target_rest(armature), _place(armature)
    target = measure_target(bone_map, rest, armature.name)
    scale = check_scale(armature, place)
    check_size(armature.name, scale, target)
    if options.root != "object":
        check_upright(armature.name, place, target)
    retargeting = options.retargeting(on_own_skis="ski.L" in target.main)
    made = retarget(poses, skeleton, bone_map, rest, place, retargeting, armature.name)
    check_free(armature, bone_map, options.root)
    action, notes = _write(armature, made, run, bone_map, scene, scale, options, name)
    places = {}
    if options.equipment == "objects":
        on_ski = ski_in_foot(skeleton, target, scale, made.size, retargeting.sole_height)
        places = gear_places(made, poses, skeleton, target, rest, scale, on_ski)
    gear = put_gear(armature, places, skeleton, poses.frame, scale, scene, name, options.keys)
    notes = (*_notes(armature, bone_map, missing, made), *notes)
    first, last = float(poses.frame[0]), float(poses.frame[-1])
    return ArmatureBake(armature, action, first, last, gear, notes, float(made.foot_error.max()))


def _place(armature: bpy.types.Object) -> Array:
    """Return the world matrix of `armature`: where it stood before an earlier bake moved it, if one still does."""
    if PLACE in armature and any(action.get(MARK) for action in _actions(armature)):
        return np.array(armature[PLACE]).reshape(4, 4)
    return np.array(armature.matrix_world)


def _actions(armature: bpy.types.Object) -> list[bpy.types.Action]:
    data = armature.animation_data
    if data is None:
        return []
    strips = [strip.action for track in data.nla_tracks for strip in track.strips]
    return [action for action in (data.action, *strips) if action is not None]


def _write(
    armature: bpy.types.Object,
    made: Retargeted,
    run: BakedRun,
    bone_map: BoneMap,
    scene: bpy.types.Scene,
    scale: float,
    options: ArmatureOptions,
    name: str,
) -> tuple[bpy.types.Action, tuple[str, ...]]:
    """Write the keys and make them active or a strip; return the action and notes."""
    place, frame = _place(armature), run.poses.frame
    again = take_strip(armature)
    action, slot, channelbag = bake_action(armature, name, again)
    keys = ArmatureKeys(armature, channelbag, options.tolerance_deg, 0.001 * options.tolerance_mm, scale)
    keys.write_bones(made.keyframes)
    absent = keys.write_settings(bone_map, frame)
    keys.clear_poses([*bone_map.bones, *([bone_map.root] if bone_map.root else [])], frame)
    if made.ground_motion is not None:
        keys.write_object(frame, made.ground_motion)
        armature[PLACE] = [float(value) for value in place.ravel()]
    elif PLACE in armature:
        armature.matrix_world = Matrix(place.tolist())
        del armature[PLACE]
    write_channels(armature, run.channels, FewerKeys(channelbag, frame, options.keys))
    set_range(scene, action, frame)
    notes = [f"switches that the armature does not have: {', '.join(absent)}"] if absent else []
    if options.as_strip:
        notes += [note for note in [add_strip(armature, action, slot)] if note]
    else:
        assign_action(armature, action, slot)
    return action, tuple(notes)


def _notes(
    armature: bpy.types.Object, bone_map: BoneMap, missing: tuple[str, ...], made: Retargeted
) -> tuple[str, ...]:
    notes = []
    if missing:
        notes.append(f"bones that the armature does not have: {', '.join(missing)}")
    bound = [
        name
        for name in bone_map.bones
        if any(not item.mute and item.influence > 0.0 for item in armature.pose.bones[name].constraints)
    ]
    if bound:
        notes.append(f"constraints move these bones away from their keys: {', '.join(bound)}")
    if armature.data.pose_position == "REST":
        notes.append("the armature shows its rest position: set it to Pose Position to see the run")
    error = float(made.foot_error.max())
    if error > VISIBLE_MISS:
        notes.append(f"the feet miss the skis' recorded places by up to {1000.0 * error:.0f} mm")
    return tuple(notes)
