"""The motion plan: how a skier skis a track [SG19 sec. 4], all by arc length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..course import Track
from ..errors import PlanInfeasible
from ..gravity import GRAVITY, STANDARD_GRAVITY
from ..snow import Snow
from ..spec import RunSpec
from .pendulum import Pendulum, balanced_pendulum, speed_for_lean
from .pose import PlannedPoses, plan_poses, track_frames
from .speed import plan_speed, travel_time
from .stance import Stance, build_stance

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


@dataclass(frozen=True)
class _Gravity:
    """Gravity's parts (n,) along the track, to its left and into the snow [m/s^2]."""

    along: np.ndarray
    left: np.ndarray
    into: np.ndarray


def plan_motion(spec: RunSpec, track: Track, model: SkierModel) -> MotionPlan:
    """Plan how the skier of `model` skis `track`, which carries the ground's frames.

    Raises `PlanInfeasible`, with the place and the speed that would work there, when the track needs more lean than
    `technique.inclination_max_deg`, when friction stops the skier, or when the legs cannot reach.
    """
    stance = build_stance(model.skeleton, np.deg2rad(spec.technique.knee_bend_deg))
    gravity = _Gravity(track.tangent @ GRAVITY, track.left @ GRAVITY, -(track.surface_normal @ GRAVITY))
    time, speed, pendulum = _balance(spec, track, stance, gravity)
    if spec.technique.inclination:
        _check_lean(spec, track, time, speed, pendulum, gravity, stance)
        _check_load(spec, track, time, pendulum, gravity)
    else:
        pendulum = _upright(track, stance, gravity)
    frames = track_frames(track.tangent, track.surface_normal)
    com = track.position + pendulum.y[:, None] * frames[..., 1] + pendulum.h[:, None] * frames[..., 2]
    angulation = _angulation(spec, speed, track.curvature)
    poses = plan_poses(model.skeleton, stance, frames, track.position, com, pendulum.inclination, angulation)
    _check_reach(track, time, poses)
    _check_ranges(track, time, poses, model)
    tightest = max(float(np.max(np.abs(track.curvature))), 1e-9)
    return MotionPlan(
        arc_length=track.arc_length,
        time=time,
        speed=speed,
        acceleration=np.gradient(speed, time, edge_order=2),
        position=track.position,
        tangent=track.tangent,
        surface_normal=track.surface_normal,
        curvature=track.curvature,
        phase=track.phase,
        turn=track.turn,
        turn_phase=track.curvature / tightest,
        inclination=pendulum.inclination,
        edge_angle=poses.edge_angle,
        com=com,
        pose=poses.qpos,
        ski_position=poses.ski_position,
        ski_rotation=poses.ski_rotation,
        load=pendulum.normal / STANDARD_GRAVITY,
        ski_frame=frames,
        steering=np.zeros_like(speed),
    )


def _balance(spec: RunSpec, track: Track, stance: Stance, gravity: _Gravity) -> tuple[np.ndarray, np.ndarray, Pendulum]:
    """Find speed and lean together: lean depends on speed, and a leaning skier's skis run faster than the body."""
    snow = Snow.of(spec.snow, spec.skier)
    pendulum = _upright(track, stance, gravity)
    speed = np.full_like(track.arc_length, track.start_speed)
    for attempt in range(25):
        planned = plan_speed(track.arc_length, track.curvature, gravity.along, pendulum, snow, track.start_speed)
        if planned[-1] <= 0.0:
            raise _stopped(track, int(np.argmin(planned > 0.0)))
        change = float(np.max(np.abs(planned - speed)))
        speed = planned
        time = travel_time(track.arc_length, speed)
        if (change < 1e-6 and attempt) or not spec.technique.inclination:
            break
        pendulum = balanced_pendulum(
            time,
            track.curvature,
            speed,
            gravity.left,
            gravity.into,
            stance.height,
            spec.technique.load_min,
            stance.extension,
        )
    return time, speed, pendulum


def _upright(track: Track, stance: Stance, gravity: _Gravity) -> Pendulum:
    zero = np.zeros_like(track.arc_length)
    return Pendulum(zero, zero, np.full_like(zero, stance.height), zero, gravity.into)


def _angulation(spec: RunSpec, speed: np.ndarray, curvature: np.ndarray) -> np.ndarray:
    """Return beta_a (n,): the spec's constant, or from speed and radius.

    The paper leaves beta_a constant and notes that faster and tighter turns should angulate more; here it grows with
    the turn's sideways acceleration in units of gravity, from 0.35 in a straight run towards 0.75. The growth is even
    in the curvature, so that it stays smooth where a turn changes side.
    """
    if spec.technique.angulation != "auto":
        return np.full_like(speed, float(spec.technique.angulation))
    sideways = speed**2 * curvature / STANDARD_GRAVITY
    return -(0.35 + 0.40 * sideways**2 / (0.36 + sideways**2))


def _place(track: Track, time: np.ndarray, index: int) -> str:
    kind = "the transition after turn" if track.phase[index] == 0 else "turn"
    return f"{kind} {track.turn[index]} ({track.arc_length[index]:.1f} m, {time[index]:.1f} s)"


def _stopped(track: Track, index: int) -> PlanInfeasible:
    place = f"turn {track.turn[index]} ({track.arc_length[index]:.1f} m)"
    hint = "friction stops the skier: make the slope steeper, lower snow.friction, start faster or turn less"
    return PlanInfeasible(place, None, hint)


def _check_lean(
    spec: RunSpec,
    track: Track,
    time: np.ndarray,
    speed: np.ndarray,
    pendulum: Pendulum,
    gravity: _Gravity,
    stance: Stance,
) -> None:
    most = np.deg2rad(spec.technique.inclination_max_deg)
    lean = np.abs(pendulum.inclination)
    worst = int(np.argmax(lean))
    if lean[worst] <= most:
        return
    same_turn = track.turn == track.turn[worst]
    allowed = speed_for_lean(
        most * np.sign(pendulum.y[worst]), track.curvature, gravity.left, gravity.into, stance.height
    )
    works = speed[worst] * float(np.min((allowed / speed)[same_turn]))
    needed = np.ceil(10 * np.rad2deg(lean[worst])) / 10
    reason = (
        f"at {speed[worst]:.1f} m/s it needs {needed:.1f} degrees of lean, more than "
        f"technique.inclination_max_deg = {spec.technique.inclination_max_deg:g} (use a larger radius, a gentler slope "
        "or a lower start speed)"
    )
    raise PlanInfeasible(_place(track, time, worst), works, reason)


def _check_load(spec: RunSpec, track: Track, time: np.ndarray, pendulum: Pendulum, gravity: _Gravity) -> None:
    load = pendulum.normal / gravity.into
    worst = int(np.argmin(load))
    if load[worst] < spec.technique.load_min - 0.01:
        reason = (
            f"only {load[worst]:.2f} of the skier's weight would stay on the snow, less than technique.load_min = "
            f"{spec.technique.load_min:g} (use longer transitions, a larger radius or a lower speed)"
        )
        raise PlanInfeasible(_place(track, time, worst), None, reason)


def _check_reach(track: Track, time: np.ndarray, poses: PlannedPoses) -> None:
    missing = np.max(np.abs(poses.reach_error), axis=1)
    worst = int(np.argmax(missing))
    if missing[worst] > 1e-6:
        reason = (
            f"a leg would have to be {1000 * missing[worst]:.0f} mm longer or shorter than it can be "
            "(change technique.knee_bend_deg or skier.stance_width, or lean less)"
        )
        raise PlanInfeasible(_place(track, time, worst), None, reason)


def _check_ranges(track: Track, time: np.ndarray, poses: PlannedPoses, model: SkierModel) -> None:
    angles = poses.qpos[:, model.actuated_qpos]
    beyond = np.maximum(model.joint_lower - angles, angles - model.joint_upper)
    worst, hinge = np.unravel_index(int(np.argmax(beyond)), beyond.shape)
    if beyond[worst, hinge] > 0.0:
        name = model.skeleton.joint_names[model.skeleton.actuated[hinge]]
        reason = (
            f"{name} would bend {np.rad2deg(beyond[worst, hinge]):.1f} degrees past its range (bring "
            "technique.angulation nearer to 0, change technique.knee_bend_deg or lean less)"
        )
        raise PlanInfeasible(_place(track, time, int(worst)), None, reason)
