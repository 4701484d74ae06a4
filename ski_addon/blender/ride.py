"""`Ride`: what scenes and pictures need of a run, whoever made it: a recording, or an instant motion of any figure."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Protocol

import numpy as np

from ..animation.bone_map import BoneEntry, BoneMap
from ..animation.gate_motion import STEP, GateSwing, gate_swings, pose_swings
from ..animation.poses import BodyPoses, body_poses_at
from ..body import Skeleton
from ..frames import Array, matrix_from_quaternion, normalized
from ..spec import RunSpec
from ..terrain import build_terrain
from ..turning.figures.poses import poses_at
from .bake import BONE_MAP
from .ski_tracks import SPACING, Trace, ski_traces
from .skier.figure import Figure, build_figure, figure_of
from .skier.wheels import TYRE_WIDTH

if TYPE_CHECKING:
    from ..course import Gates
    from ..simulation.recording import Recording
    from ..turning.figures import FigureModel
    from ..turning.motion import TurningMotion


class Timeline(Protocol):
    """Where a run is and when, at n moments. A recording is one."""

    @property
    def time(self) -> Array:
        """Moments (n,) [s]."""

    @property
    def track_position(self) -> Array:
        """Places (n, 3) on the ground [m, world]."""

    @property
    def arc_length(self) -> Array:
        """Way (n,) [m]."""

    @property
    def speed(self) -> Array:
        """Speed (n,) [m/s]."""

    @property
    def turn_phase(self) -> Array:
        """1 in the middle of a left turn, -1 in the middle of a right one (n,)."""


@dataclass(frozen=True)
class MotionTimeline:
    """The timeline of an instant motion; see `Timeline`."""

    time: Array
    track_position: Array
    arc_length: Array
    speed: Array
    turn_phase: Array


@dataclass(frozen=True)
class Ride:
    """A run of `figure`: its `timeline`, its poses at any times [s from the start], and what it does to the ground.

    `traces` are left on the ground; `swings` says how given gates swing. `bone_map` is the one its bake uses.
    """

    timeline: Timeline
    figure: Figure
    bone_map: BoneMap
    poses_at: Callable[[Array], BodyPoses]
    traces: list[Trace]
    swings: Callable[[Gates], list[GateSwing | None]]

    @property
    def on_snow(self) -> bool:
        """Whether the ground is snow; bicycles ride on a meadow."""
        return self.figure.kind != "bicycle"


def recorded_ride(recording: Recording, skeleton: Skeleton) -> Ride:
    """Return the ride that `recording` of the skier `skeleton` is."""
    return Ride(
        timeline=recording,
        figure=build_figure(skeleton),
        bone_map=BoneMap.load(BONE_MAP),
        poses_at=partial(body_poses_at, recording, skeleton),
        traces=ski_traces(recording, skeleton),
        swings=partial(gate_swings, recording, skeleton),
    )


def instant_ride(model: FigureModel, spec: RunSpec, motion: TurningMotion) -> Ride:
    """Return the ride of the figure `model` in the instant `motion`."""
    poses = partial(poses_at, model, spec, motion, terrain=build_terrain(spec.slope))
    dense = poses(np.arange(0.0, motion.duration, STEP))
    return Ride(
        timeline=motion_timeline(motion),
        figure=figure_of(model),
        bone_map=figure_bone_map(model),
        poses_at=poses,
        traces=pose_traces(dense, model, spec),
        swings=partial(pose_swings, dense),
    )


def motion_timeline(motion: TurningMotion) -> MotionTimeline:
    """Return when and where `motion` is."""
    return MotionTimeline(motion.time, motion.position, motion.distance, motion.speed, np.sin(motion.phase))


def figure_bone_map(model: FigureModel) -> BoneMap:
    """Return the table of a figure's own armature: every bone follows the body of its name."""
    entries = tuple(BoneEntry(name, name, name in model.free) for name in model.body_names)
    return BoneMap(f"Ski Addon {model.kind}", entries)


def pose_traces(poses: BodyPoses, model: FigureModel, spec: RunSpec) -> list[Trace]:
    """Return what skis, board or wheels leave on the ground in `poses`, which lie close to each other in time."""
    names = [name for name in model.gear if name.partition(".")[0] in ("ski", "board", "wheel_rear", "wheel_front")]
    terrain = build_terrain(spec.slope)
    traces = []
    for name in names:
        body = poses.body_names.index(name)
        place, turn = poses.position[:, body], matrix_from_quaternion(poses.quaternion[:, body])
        left = turn[..., 1]
        if name.startswith("wheel"):
            place = _touching(place, left, terrain.normal(place[:, 0], place[:, 1]), model.sizes["wheel_radius"])
        kept = _spaced(place)
        normal = terrain.normal(place[kept, 0], place[kept, 1])
        edge = np.arcsin(np.clip(-np.sum(left[kept] * normal, axis=1), -1.0, 1.0))
        traces.append(Trace(_trace_name(name), place[kept], left[kept], edge, *_half_sizes(name, model)))
    return traces


def _touching(hub: Array, axle: Array, normal: Array, radius: float) -> Array:
    """Return the lowest points (m, 3) of wheels: from `hub` (m, 3) down in the wheel's plane."""
    down = normalized(np.sum(normal * axle, axis=1, keepdims=True) * axle - normal)
    return hub + radius * down


def _spaced(place: Array) -> Array:
    """Return indices of `place` (m, 3) that lie about the tracks' spacing apart."""
    way = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(place, axis=0), axis=1))))
    return np.unique(np.searchsorted(way, np.arange(0.0, way[-1], SPACING)).clip(0, len(way) - 1))


def _trace_name(body: str) -> str:
    part, _, side = body.partition(".")
    return {"ski": f"Ski track {side}", "board": "Board track"}.get(part, f"Tyre line {part.partition('_')[2]}")


def _half_sizes(body: str, model: FigureModel) -> tuple[float, float]:
    """Return half the width and half the length [m] of what leaves a trace; wheels have no length."""
    if body == "board":
        return 0.5 * model.sizes["width"], 0.5 * model.sizes["length"]
    if body.startswith("wheel"):
        return 0.4 * TYRE_WIDTH, 0.0
    return 0.5 * model.skeleton.ski_width, 0.5 * model.skeleton.ski_length
