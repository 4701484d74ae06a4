"""A crowd's recordings as skiers of a scene: each baked at its own start, there only while it skis, on one slope."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import bpy
import numpy as np

from ..body import build_skeleton
from ..crowd.skied import SkiedCrowd, SkiedMember
from ..crowd.skiing import check_whole
from ..frames import Array
from ..simulation.recording import Recording
from ..spec import BakeSpec, RunSpec
from .bake import BakeResult, KeyOptions, bake_recording, new_skier, recorded_run
from .channels import MARK as BAKED
from .channels import ensure_channelbag
from .frame_rate import scene_rate
from .ride import MotionTimeline, Ride, recorded_ride
from .rig import find_rig

if TYPE_CHECKING:
    from .ski_tracks import Trace

AWAY = "ski_away"
"""Custom property of a crowd's armatures, keyed: 1 before the start and after the end, when the skier is not shown."""
MARK = "ski_crowd"
"""Custom property of what a crowd's bake made."""
THINNED = 50
"""Every so manieth step of a recording tells where its track lies."""


@dataclass
class CrowdBake:
    """What a bake of a crowd made: the `armatures`, the frames it goes over, and the `ride` of them all together.

    `courses` are what each one skied, and how far to the left [m].
    """

    armatures: list[bpy.types.Object] = field(default_factory=list)
    frame_first: float = np.inf
    frame_last: float = -np.inf
    courses: list[tuple[RunSpec, float]] = field(default_factory=list)
    ride: Ride | None = None


def bake_crowd(
    crowd: SkiedCrowd,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection,
    options: BakeSpec,
    world_from_run: Array | None = None,
    keys: KeyOptions | None = None,
    progress: Callable[[float, str], Any] = lambda _fraction, _text: None,
) -> CrowdBake:
    """Make and bake every member of `crowd` into `collection`; what an earlier crowd left there goes first.

    One recording is held in memory at a time. `world_from_run` (4, 4) is where the run lies; the frame range of the
    scene is set. Raises `SkiAddonError`.
    """
    for member in crowd.members:  # before anything is taken away
        check_whole(member.path)
    clear_crowd(collection)
    made, matrix = CrowdBake(), np.eye(4) if world_from_run is None else world_from_run
    whole: list[tuple[Array, Ride]] = []
    for done, member in enumerate(crowd.members):
        progress(done / len(crowd.members), f"baking: {done} of {len(crowd.members)}")
        recording = Recording.load(member.path)
        result = _bake_member(member, recording, scene, collection, options, matrix, keys)
        _key_presence(result, crowd.linger * scene_rate(scene))
        made.armatures.append(result.armature)
        made.frame_first = min(made.frame_first, result.frame_first)
        made.frame_last = max(made.frame_last, result.frame_last + crowd.linger * scene_rate(scene))
        made.courses.append((recorded_run(recording), member.offset))
        whole.append(_moved_ride(recording, member.offset))
    made.ride = _one_ride(whole)
    scene.frame_start, scene.frame_end = int(np.ceil(made.frame_first)), int(np.floor(made.frame_last))
    return made


def clear_crowd(collection: bpy.types.Collection) -> None:
    """Remove the skiers that an earlier bake put into `collection`; what the user put there stays."""
    for child in [child for child in collection.children if child.get(MARK)]:
        for obj in [obj for obj in child.objects if obj.get(MARK)]:
            data, action = obj.data, obj.animation_data.action if obj.animation_data else None
            bpy.data.objects.remove(obj)
            if data is not None and data.users == 0:
                bpy.data.batch_remove([data])
            if action is not None and action.users == 0 and action.get(BAKED):
                bpy.data.actions.remove(action)
        if not child.objects and not child.children:
            bpy.data.collections.remove(child)


def _bake_member(
    member: SkiedMember,
    recording: Recording,
    scene: bpy.types.Scene,
    collection: bpy.types.Collection,
    options: BakeSpec,
    world_from_run: Array,
    keys: KeyOptions | None,
) -> BakeResult:
    skier = recorded_run(recording).skier
    armature = new_skier(skier, build_skeleton(skier), scene)
    home = armature.users_collection[0]
    scene.collection.children.unlink(home)
    collection.children.link(home)
    home.name = armature.name = f"Skier {member.number:03d}"
    home[MARK] = True
    for obj in home.objects:
        obj[MARK] = member.number
    matrix = world_from_run.copy()
    matrix[:3, 3] += world_from_run[:3, 1] * member.offset
    first = options.frame_start + round(member.start * scene_rate(scene))
    own = dataclasses.replace(options, frame_start=first, action=f"{options.action} {member.number:03d}"[:60])
    keys = dataclasses.replace(keys, as_strip=False) if keys else None
    return bake_recording(recording, scene, armature=armature, options=own, world_from_run=matrix, keys=keys)


def _key_presence(result: BakeResult, linger: float) -> None:
    """Show the skier from its start until `linger` frames after its end only.

    One keyed number on the armature drives the visibility of its meshes, without an expression: files that may not run
    scripts show the same.
    """
    armature, action = result.armature, result.action
    armature[AWAY] = 1.0
    armature.id_properties_ui(AWAY).update(description="1 while the skier is not on the slope", min=0.0, max=1.0)
    bag = ensure_channelbag(action, armature.animation_data.action_slot)
    curve = bag.fcurves.new(f'["{AWAY}"]')
    first, gone = np.floor(result.frame_first), np.floor(result.frame_last + linger) + 1.0
    for frame, value in ((first - 1.0, 1.0), (first, 0.0), (gone, 1.0)):
        curve.keyframe_points.insert(frame, value).interpolation = "CONSTANT"
    for mesh in find_rig(armature).meshes:
        for path in ("hide_viewport", "hide_render"):
            driver = mesh.driver_add(path).driver
            driver.type = "SUM"
            variable = driver.variables.new()
            variable.targets[0].id, variable.targets[0].data_path = armature, f'["{AWAY}"]'


def _moved_ride(recording: Recording, offset: float) -> tuple[Array, Ride]:
    """Return where the track of a recording lies, thinned (n, 3), and its ride, moved to the left by `offset` [m]."""
    shift = np.array((0.0, offset, 0.0))
    ride = recorded_ride(recording, build_skeleton(recorded_run(recording).skier))
    track = np.asarray(recording.track_position)[::THINNED] + shift
    traces = [dataclasses.replace(trace, place=trace.place + shift) for trace in ride.traces]
    small = MotionTimeline(track[:0, 0], track, track[:0, 0], track[:0, 0], track[:0, 0])
    return track, Ride(small, ride.figure, ride.bone_map, _nowhere, traces, lambda gates: [None] * len(gates.side))


def _nowhere(_times: Array) -> Any:
    raise NotImplementedError("a crowd has no poses as one")


def _one_ride(whole: list[tuple[Array, Ride]]) -> Ride:
    """Return a ride with the tracks of all: for the slope and what is on it."""
    track = np.concatenate([place for place, _ in whole])
    traces: list[Trace] = []
    for number, (_, ride) in enumerate(whole, start=1):
        traces += [dataclasses.replace(trace, name=f"{trace.name} {number:03d}") for trace in ride.traces]
    none = np.zeros(len(track))
    return dataclasses.replace(whole[0][1], timeline=MotionTimeline(none, track, none, none, none), traces=traces)


def bake_on_slope(
    scene: bpy.types.Scene, skier: bpy.types.Object, crowd: SkiedCrowd, progress: Callable[[float, str], Any]
) -> CrowdBake:
    """Bake the crowd of `skier` into its collection in `scene`, and lay slope, tracks and gates under all of it.

    Raises `SkiAddonError`.
    """
    from .baking import whole_keys
    from .course_objects import gate_objects
    from .ground import Place, renew_ground
    from .placing import world_from_run
    from .properties import read_spec

    settings = skier.ski
    options = read_spec(settings).bake
    if settings.crowd_collection is None:
        settings.crowd_collection = bpy.data.collections.new("Crowd")
        scene.collection.children.link(settings.crowd_collection)
    matrix, keys = world_from_run(settings), whole_keys(settings)
    made = bake_crowd(crowd, scene, settings.crowd_collection, options, matrix, keys, progress)
    if made.ride is not None:
        own_mesh, run = settings.slope_mesh is not None, made.courses[0][0]
        place = Place(settings.start, own_mesh, gate_objects(settings, run), settings.tracks)
        ground = settings.crowd_ground or settings.ground
        settings.crowd_ground = renew_ground(made.ride, run, scene, ground, options, place)
    return made
