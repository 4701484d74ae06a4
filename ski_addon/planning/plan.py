"""The motion plan: how a skier skis a track [SG19 sec. 4], all by arc length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..course import Track
from ..gravity import STANDARD_GRAVITY
from ..spec import RunSpec
from .absorption import Sink, missing_length
from .checks import check_ground, check_lean, check_load, check_ranges, check_reach
from .comparison import RIGID_LEAN
from .gaze import gaze_directions
from .line import Line, turned_frames
from .pose import plan_poses
from .speed_and_lean import SpeedAndLean
from .stance import build_stance

if TYPE_CHECKING:
    from ..body import SkierModel


@dataclass(frozen=True)
class MotionPlan:
    """A skier's motion by arc length; read-only arrays over n places.

    `arc_length` [m], `time` [s] when planned to be there, `speed` of the skis [m/s], `acceleration` along the track
    [m/s^2]; track frame `position` (n, 3) [m, world], `tangent`, `surface_normal` (n, 3), `curvature` [1/m] positive
    to the left; `phase` and `turn` as in `Track`; `turn_phase` -1..1 (curvature over the tightest, positive left);
    `inclination` (n,) and `edge_angle` (n, 2) [rad] positive to the left; `com` (n, 3) [m, world]; `pose` (n, nq);
    `ski_position` (n, 2, 3) [m, world], `ski_rotation` (n, 2, 3, 3); `load` (n,) normal snow force in units of the
    skier's weight. `ski_frame` (n, 3, 3) has columns along the skis, across them to the left, and up from the snow;
    `steering` (n,) [rad] is the angle from track to skis, positive to the left.
    """

    arc_length: np.ndarray
    time: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    position: np.ndarray
    tangent: np.ndarray
    surface_normal: np.ndarray
    curvature: np.ndarray
    phase: np.ndarray
    turn: np.ndarray
    turn_phase: np.ndarray
    inclination: np.ndarray
    edge_angle: np.ndarray
    com: np.ndarray
    pose: np.ndarray
    ski_position: np.ndarray
    ski_rotation: np.ndarray
    load: np.ndarray
    ski_frame: np.ndarray
    steering: np.ndarray

    def __post_init__(self) -> None:
        for value in vars(self).values():
            value.setflags(write=False)

    @property
    def length(self) -> float:
        """Length of the track [m]."""
        return float(self.arc_length[-1])

    @property
    def duration(self) -> float:
        """Planned duration of the run [s]."""
        return float(self.time[-1])


MOST_ANGULATION = np.deg2rad(38.0)
"""Angle between the upper body's lean and the legs' that hips approach in deep leans."""
MOST_SINKS = 8
"""How often a plan is made anew with a lower body where legs were too short."""


def plan_motion(spec: RunSpec, track: Track, model: SkierModel) -> MotionPlan:
    """Plan how the skier of `model` skis `track`, which carries the ground's frames.

    Raises `PlanInfeasible`, with the place and the speed that would work there, when the track needs more lean than
    `technique.inclination_max_deg`, when friction stops the skier, or when the legs cannot reach;
    `SpecError` for bumps that nobody can stand over.
    """
    stance = build_stance(model.skeleton, np.deg2rad(spec.technique.knee_bend_deg), spec.technique.tuck)
    check_ground(spec, stance)
    sink, speed_and_lean = Sink(track), SpeedAndLean(spec, track, stance)
    for _ in range(MOST_SINKS):
        line, pendulum = speed_and_lean.found(sink)
        if spec.technique.inclination:
            check_lean(spec, line, pendulum, stance.height)
            if spec.technique.equations not in RIGID_LEAN:  # the paper's lean asks for less than none
                check_load(spec, line, pendulum)
        skis, body = turned_frames(line.tangent, line.surface_normal, line.steering), line.body_frame
        com = line.position + pendulum.y[:, None] * body[..., 1] + pendulum.h[:, None] * body[..., 2]
        angulation = _angulation(spec, line, pendulum.inclination)
        gaze = gaze_directions(line, com, model.skeleton.height, spec.technique.look_ahead)
        poses = plan_poses(
            model.skeleton, stance, skis, body, line.position, com, pendulum, angulation, line.steering, gaze
        )
        if not sink.deepen(line.arc_length, missing_length(model.skeleton, poses)):
            break
    check_reach(line, poses)
    check_ranges(spec, line, poses, model)
    tightest = max(float(np.max(np.abs(line.curvature))), 1e-9)
    return MotionPlan(
        arc_length=line.arc_length,
        time=line.time,
        speed=line.speed,
        acceleration=line.acceleration,
        position=line.position,
        tangent=line.tangent,
        surface_normal=line.surface_normal,
        curvature=line.curvature,
        phase=line.phase,
        turn=line.turn,
        turn_phase=line.curvature / tightest,
        inclination=pendulum.inclination,
        edge_angle=poses.edge_angle,
        com=com,
        pose=poses.qpos,
        ski_position=poses.ski_position,
        ski_rotation=poses.ski_rotation,
        load=pendulum.normal / STANDARD_GRAVITY,
        ski_frame=skis,
        steering=line.steering,
    )


def _angulation(spec: RunSpec, line: Line, inclination: np.ndarray) -> np.ndarray:
    """Return beta_a (n,): the spec's constant, or from speed and radius.

    The paper leaves beta_a constant and notes that faster and tighter turns should angulate more; here it grows with
    the turn's sideways acceleration in units of gravity, from 0.35 in a straight run towards 0.75. The growth is even
    in the curvature, so that it stays smooth where a turn changes side. Hips angulate by `MOST_ANGULATION` at most.
    """
    if spec.technique.angulation != "auto":
        return np.full_like(line.speed, float(spec.technique.angulation))
    sideways = line.speed**2 * line.curvature / STANDARD_GRAVITY
    share = 0.35 + 0.40 * sideways**2 / (0.36 + sideways**2)
    angle = np.maximum(share * np.abs(inclination), 1e-6)
    return -share * MOST_ANGULATION * np.tanh(angle / MOST_ANGULATION) / angle
