"""Alpine and telemark skiers: the mapping from the turning body to skis, legs, trunk, arms and poles [VP93 sec. 7]."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...body import Skeleton
from ...spec import FigureSpec
from .footing import Footing, edge_angles, stand_on, tilt_for_curvature
from .model import FigureModel
from .person import Frames, Limbs, Trunk, grips, person_frames, sockets, solve_arms, solve_legs, trunk_at_origin
from .poles import HandMotion, find_plants, move_pole, pole_turn, swing_weight
from .sampling import Moments, Run
from .standing import Legs, lean_line, place_pelvis, spring_legs
from .vectors import Array, apply, distance_at, smoothstep, soft_clip, turn_yxz

SIDES = np.array([1.0, -1.0])
MOST_BENT = np.deg2rad(62.0)
"""The trunk is never bent further forward."""


@dataclass(frozen=True)
class Style:
    """How a skier stands. Rows of four are for pelvis, abdomen, chest and head.

    `knee` [rad] and `waist`, bend of the waist per bend of the knees; `twist` per tilt; `pitch` shares of the waist's
    bend, `lean` shares of the body's lean, `yaw` shares of the twist; `look` of the head into the turn, per tilt;
    `hands` ahead, outside and above the shoulders' middle, `planting` what a plant adds, in statures; `leg_twist` [rad]
    at most.
    """

    knee: float
    waist: float
    twist: float
    pitch: tuple[float, ...] = (0.45, 0.75, 1.0, 0.15)
    lean: tuple[float, ...] = (0.75, 0.6, 0.45, 0.2)
    yaw: tuple[float, ...] = (0.35, 0.65, 1.0, 0.5)
    look: float = 0.4
    hands: tuple[float, ...] = (0.205, 0.19, -0.2)
    planting: tuple[float, ...] = (0.05, 0.0, 0.02)
    leg_twist: float = float(np.deg2rad(25.0))


LEAD_TILT = 0.16
"""Tilt of the skis [rad] at which a telemark skier's lead is three quarters of the split."""
SINK = 0.14
"""How far a telemark skier's legs shorten in a turn, in units of the split."""
LOWEST_LUNGE = np.deg2rad(82.0)
"""Knee bend of legs with which the hips are as low between the feet as a telemark skier goes."""
ALPINE = Style(knee=float(np.deg2rad(56.0)), waist=0.75, twist=-0.45)
TELEMARK = Style(knee=float(np.deg2rad(50.0)), waist=0.55, twist=-0.35)


@dataclass(frozen=True)
class _Stand:
    """Where a skier stands: skis, feet (m, 2, 3, 3) and ankles (m, 2, 3), and legs `length` (m,) [m] over them."""

    skis: Footing
    foot: Array
    ankle: Array
    length: Array


Stance = Callable[[Moments, Array, Legs], _Stand]
"""From moments, the turning tilt (m,) [rad] and the legs' spring to where the skier stands."""


def alpine_frames(model: FigureModel, figure: FigureSpec, run: Run, time: Array) -> Frames:
    """Return {body: (place (m, 3), turn (m, 3, 3))} of an alpine skier at `time` (m,) [s]."""

    def stand(moments: Moments, turning: Array, legs: Legs) -> _Stand:
        lead = 0.05 * model.skeleton.height * np.tanh(turning / 0.5)
        distance = moments.distance[:, None] + SIDES * lead[:, None]
        tilt = edge_angles(moments, turning, figure.outside_tilt)
        skis = _skis(model, run, distance, tilt)
        ankle = skis.place + skis.turn @ _ankle(model.skeleton)
        return _Stand(skis, skis.turn, ankle, legs.length)

    return _skier(model, figure, run, time, ALPINE, stand)


def telemark_frames(model: FigureModel, figure: FigureSpec, run: Run, time: Array) -> Frames:
    """Return {body: (place (m, 3), turn (m, 3, 3))} of a telemark skier at `time` (m,) [s].

    The outside ski leads, the heel behind lifts about the boot's ball, and the hips sink between the feet; the lead
    changes while the skis are flat.
    """
    sizes, split = model.sizes, model.sizes["split"]
    lengths = model.skeleton.lengths
    lowest = float(distance_at(lengths["thigh"], lengths["shank"], LOWEST_LUNGE))
    pivot = np.array([sizes["pivot_forward"], 0.0, sizes["pivot_height"]])

    def stand(moments: Moments, turning: Array, legs: Legs) -> _Stand:
        lead = np.tanh(turning / LEAD_TILT)  # 1: the right ski, outside in a left turn
        distance = moments.distance[:, None] - 0.5 * split * SIDES * lead[:, None]
        skis = _skis(model, run, distance, edge_angles(moments, turning, figure.outside_tilt))
        behind = smoothstep(np.maximum(SIDES * lead[:, None], 0.0))
        lifted = turn_yxz(np.deg2rad(figure.heel_lift_deg) * behind)
        foot = skis.turn @ lifted
        ankle = skis.place + apply(skis.turn, pivot + apply(lifted, _ankle(model.skeleton) - pivot))
        astride = np.square(0.5 * split * lead)
        sunk = legs.length - SINK * split * np.square(lead)
        sunk = sunk + np.square(lead) * (soft_clip(sunk, lowest, 9.0, 0.03) - sunk)
        return _Stand(skis, foot, ankle, np.sqrt(np.maximum(np.square(sunk) - astride, 0.04)))

    return _skier(model, figure, run, time, TELEMARK, stand)


def _ankle(skeleton: Skeleton) -> Array:
    return np.array([-skeleton.ankle_setback, 0.0, skeleton.ankle_height])


def _skis(model: FigureModel, run: Run, distance: Array, tilt: Array) -> Footing:
    sizes = model.sizes
    return stand_on(run, distance, 0.5 * sizes["stance_width"] * SIDES, tilt, sizes["ski_length"], sizes["ski_width"])


def _skier(model: FigureModel, figure: FigureSpec, run: Run, time: Array, style: Style, stand: Stance) -> Frames:
    skeleton, count = model.skeleton, len(time)
    plants = find_plants(run, figure, model.sizes["tip_distance"])
    events = [np.concatenate((plant.touch, plant.release)) for plant in plants]
    moments = run.at(np.concatenate((time, *events)))
    turning = tilt_for_curvature(run, moments.curvature, figure.tilt)
    knee = style.knee if figure.knee_bend_deg == "auto" else float(np.deg2rad(figure.knee_bend_deg))
    spring = spring_legs(skeleton, figure, moments, knee)
    stood = stand(moments, turning, spring)
    trunk = _trunk(skeleton, figure, style, moments, turning, spring)
    support = moments.place
    pelvis = place_pelvis(skeleton, trunk, support, lean_line(moments), stood.ankle, stood.foot, stood.length)
    trunk = trunk.moved(pelvis)
    hands = _hands(skeleton, figure, style, moments, turning, trunk)
    weights = np.stack([swing_weight(plant, moments.time) for plant in plants], axis=1)
    hands = hands + _planting(skeleton, style, moments, weights)
    held = []
    for i in range(2):
        start = count + sum(len(event) for event in events[:i])
        index = np.concatenate((np.arange(count), np.arange(start, start + len(events[i]))))
        here = _rows(moments, index)
        held.append(move_pole(run, plants[i], here, count, hands[index, i], SIDES[i], model.sizes["tip_distance"]))
    trunk = Trunk(trunk.place[:count], trunk.turn[:count])
    legs = solve_legs(
        skeleton, sockets(skeleton, trunk, "thigh"), stood.ankle[:count], stood.foot[:count], style.leg_twist
    )
    arms = _arms(skeleton, moments, trunk, held, count)
    frames = person_frames(skeleton, trunk, arms, legs)
    at = grips(skeleton, arms)
    for i, side in enumerate("LR"):
        frames[f"pole.{side}"] = at[:, i], pole_turn(held[i].up, moments.body[:count])
        frames[f"ski.{side}"] = stood.skis.place[:count, i], stood.skis.turn[:count, i]
    return frames


def _rows(moments: Moments, index: Array) -> Moments:
    return Moments(**{name: value[index] for name, value in vars(moments).items()})


def _trunk(
    skeleton: Skeleton, figure: FigureSpec, style: Style, moments: Moments, turning: Array, spring: Legs
) -> Trunk:
    waist = style.waist if figure.waist_bend == "auto" else float(figure.waist_bend)
    twist = style.twist if figure.twist == "auto" else float(figure.twist)
    yaw = (twist * turning)[:, None] * np.array(style.yaw)
    yaw[:, 3] += style.look * turning
    bend = soft_clip(waist * spring.knee, 0.0, MOST_BENT, 0.05)
    pitch = bend[:, None] * np.array(style.pitch)
    return trunk_at_origin(skeleton, moments.body, moments.lean[:, None] * np.array(style.lean), yaw, pitch)


def _hands(
    skeleton: Skeleton, figure: FigureSpec, style: Style, moments: Moments, turning: Array, trunk: Trunk
) -> Array:
    """Return where the hands are carried (m, 2, 3) [m, world]."""
    shoulder = sockets(skeleton, trunk, "upper_arm").mean(axis=1)
    twist = style.twist if figure.twist == "auto" else float(figure.twist)
    frame = moments.body @ turn_yxz(0.0, -0.4 * moments.lean) @ turn_yxz(0.0, 0.0, 0.8 * twist * turning)
    ahead, outside, above = (value * skeleton.height for value in style.hands)
    local = np.array([[ahead, outside, above], [ahead, -outside, above]])
    return shoulder[:, None] + local @ np.swapaxes(frame, -1, -2)


def _planting(skeleton: Skeleton, style: Style, moments: Moments, weights: Array) -> Array:
    """Return how far (m, 2, 3) [m, world] the hands go for a plant."""
    way = skeleton.height * np.array(style.planting) * np.array([[1.0, 1.0, 1.0], [1.0, -1.0, 1.0]])
    return (weights[..., None] * way) @ np.swapaxes(moments.body, -1, -2)


def _arms(skeleton: Skeleton, moments: Moments, trunk: Trunk, held: list[HandMotion], count: int) -> Limbs:
    grip = np.stack([motion.grip for motion in held], axis=1)
    elbow = np.array([[-0.4, 0.4, -0.8], [-0.4, -0.4, -0.8]])
    bend = elbow @ np.swapaxes(moments.body[:count], -1, -2)
    shoulder = sockets(skeleton, trunk, "upper_arm")
    return solve_arms(skeleton, shoulder, grip, bend, np.zeros((count, 2)))
