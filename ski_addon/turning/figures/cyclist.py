"""The cyclist on the bicycle: seated, pedalling by the way travelled, hands on the bar [VP93 sec. 7]."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...spec import FigureSpec
from .bicycle import Bicycle, ride
from .bicycle_sizes import TOES_DOWN, TRUNK, fork_place, grip_places, saddle_place
from .footing import tilt_for_curvature
from .model import FigureModel
from .pedalling import crank_angle, held_cranks
from .person import Frames, Limbs, Trunk, person_frames, sockets, solve_arms, solve_legs, trunk_at_origin
from .sampling import Run
from .vectors import Array, columns, cross, dot, turn_yxz, unit

PITCH = np.array([0.6, 1.0, 1.25, 0.35])
"""Forward bend of pelvis, abdomen, chest and head, in units of the trunk's lean."""
RIGHTING = np.array([0.0, 0.08, 0.16, 0.7])
"""Share of the bicycle's lean that pelvis, abdomen, chest and head take back."""
LOOK = 0.5
"""How far the head turns into the curve, per lean of a steady turn."""
ANKLING = np.deg2rad(8.0)
"""How far the foot pitches to and fro in a turn of the crank."""
LEG_TWIST = float(np.deg2rad(6.0))


@dataclass(frozen=True)
class _Pedals:
    """Crank (m, 3, 3) and pedals' middles (m, 2, 3) [m, world]; angle (m, 2) [rad] of each arm, 0 ahead, then down."""

    middle: Array
    crank: Array
    place: Array
    angle: Array


def bicycle_frames(model: FigureModel, figure: FigureSpec, run: Run, time: Array) -> Frames:
    """Return {body: (place (m, 3), turn (m, 3, 3))} of a cyclist at `time` (m,) [s]."""
    skeleton, sizes = model.skeleton, model.sizes
    moments = run.at(time)
    bicycle = ride(sizes, run, time)
    held = held_cranks(run.motion, figure.development) if figure.coasting else []
    pedals = _pedals(sizes, bicycle, crank_angle(held, bicycle.rear_way, figure.development))
    turning = tilt_for_curvature(run, moments.curvature, 1.0)
    twist = 0.0 if figure.twist == "auto" else float(figure.twist)
    trunk = _trunk(model, bicycle, moments.lean, turning, twist)
    foot = bicycle.frame[:, None] @ turn_yxz(TOES_DOWN - ANKLING * np.cos(pedals.angle))
    ankle = pedals.place + foot @ np.array([-sizes["ball_forward"], 0.0, sizes["ankle_height"]])
    legs = solve_legs(skeleton, sockets(skeleton, trunk, "thigh"), ankle, foot, LEG_TWIST)
    frames = person_frames(skeleton, trunk, _arms(model, bicycle, trunk), legs)
    return frames | _gear(sizes, bicycle, pedals)


def _gear(sizes: dict[str, float], bicycle: Bicycle, pedals: _Pedals) -> Frames:
    rolled = [way / sizes["wheel_radius"] for way in (bicycle.rear_way, bicycle.front_way)]
    return {
        "frame": (bicycle.rear, bicycle.frame),
        "fork": (bicycle.rear + bicycle.frame @ fork_place(sizes), bicycle.fork),
        "wheel_rear": (bicycle.rear, bicycle.rear_wheel @ turn_yxz(rolled[0])),
        "wheel_front": (bicycle.front, bicycle.front_wheel @ turn_yxz(rolled[1])),
        "crank": (pedals.middle, pedals.crank),
        "pedal.L": (pedals.place[:, 0], bicycle.frame),
        "pedal.R": (pedals.place[:, 1], bicycle.frame),
    }


def _pedals(sizes: dict[str, float], bicycle: Bicycle, angle: Array) -> _Pedals:
    up = sizes["bottom_bracket_height"] - sizes["wheel_radius"]
    middle = bicycle.rear + bicycle.frame @ np.array([sizes["bottom_bracket_forward"], 0.0, up])
    crank = bicycle.frame @ turn_yxz(angle)
    arm, half = sizes["crank_length"], 0.5 * sizes["pedal_width"]
    ends = np.array([[arm, half, 0.0], [-arm, -half, 0.0]])
    place = middle[:, None] + ends @ np.swapaxes(crank, -1, -2)
    return _Pedals(middle, crank, place, np.stack((angle, angle + np.pi), axis=1))


def _trunk(model: FigureModel, bicycle: Bicycle, lean: Array, turning: Array, twist: float) -> Trunk:
    """Return the trunk with the hips over the saddle."""
    skeleton = model.skeleton
    yaw = np.zeros((len(lean), 4))
    yaw[:, 1:3] = (twist * turning)[:, None] * [0.5, 1.0]
    yaw[:, 3] = LOOK * turning
    pitch = np.broadcast_to(TRUNK * PITCH, yaw.shape)
    trunk = trunk_at_origin(skeleton, bicycle.frame, -lean[:, None] * RIGHTING, yaw, pitch)
    hips = saddle_place(model.sizes) + [0.0, 0.0, model.sizes["hip_height"]]
    middle = sockets(skeleton, trunk, "thigh").mean(axis=1)
    return trunk.moved(bicycle.rear + bicycle.frame @ hips - middle)


def _arms(model: FigureModel, bicycle: Bicycle, trunk: Trunk) -> Limbs:
    """Return the arms with the hands round the bar, palms down."""
    skeleton, sizes = model.skeleton, model.sizes
    fork = bicycle.rear + bicycle.frame @ fork_place(sizes)
    grip = fork[:, None] + grip_places(sizes) @ np.swapaxes(bicycle.fork, -1, -2)
    elbow = np.array([[-0.2, 0.5, -0.8], [-0.2, -0.5, -0.8]]) @ np.swapaxes(bicycle.frame, -1, -2)
    arms = solve_arms(skeleton, sockets(skeleton, trunk, "upper_arm"), grip, elbow, np.zeros(grip.shape[:2]))
    inward = bicycle.fork[:, None, :, 1] * np.array([[-1.0], [1.0]])
    hand = _rolled(arms.last, inward)
    half_way = unit(arms.lower[..., 1] + hand[..., 1])
    along = arms.lower[..., 2]
    fore = columns(cross(half_way, along), half_way, along)
    return replace(arms, lower=fore, last=hand)


def _rolled(hand: Array, thumb: Array) -> Array:
    """Return hands turned about their own length until the thumb's side points as near to `thumb` as it can."""
    z = hand[..., 2]
    x = unit(thumb - dot(thumb, z)[..., None] * z)
    return columns(x, cross(z, x), z)
