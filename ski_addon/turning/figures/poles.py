"""Poles: carried behind, swung forward round the outside, planted, held still in the snow and let go [VP93 sec. 7]."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...spec import FigureSpec
from ..motion import TurningMotion
from .sampling import Moments, Run
from .vectors import Array, apply, columns, cross, dot, smoothstep, unit

PLANT_PHASE = {"teaching": np.deg2rad(-30.0), "paper": np.deg2rad(30.0)}
"""Phase of the turn at which the left pole is planted: before the body is upright as taught, after it in the paper."""
SLOWEST, LEAST_RATE = 1.0, 0.06
"""Speed [m/s] and rate of lean [rad/s] below which no pole is planted."""
SWING, RECOVERY = 0.5, 0.4
"""Time [s] before a plant in which the pole swings forward, and after it in which it swings back."""
AHEAD, OUTSIDE = 0.36, 0.16
"""Where the tip goes in, ahead and to the outside of the hand, in units of the pole's length below the hand."""
CARRIED = (np.deg2rad(52.0), np.deg2rad(170.0))
"""A carried pole: angle from upright, and direction of the tip from straight ahead to the outside."""
MOST_RAISED = 0.10
"""How far a hand is raised or sunk to fit its pole to the ground, in units of the pole's length."""
CLEARANCE = 0.04
"""Height [m] of a carried tip over the snow, at least."""


@dataclass(frozen=True)
class Plants:
    """Plants of one pole, k in order: `touch` and `release` (k,) [s]."""

    touch: Array
    release: Array


@dataclass(frozen=True)
class HandMotion:
    """What a pole does with its hand: `grip` (m, 3) [m, world] and the direction `up` (m, 3) from tip to grip."""

    grip: Array
    up: Array


def find_plants(run: Run, figure: FigureSpec, tip_distance: float) -> tuple[Plants, Plants]:
    """Return the plants of the left and the right pole."""
    if figure.pole_plant == "none" or len(run.motion.time) < 2:
        nothing = Plants(np.zeros(0), np.zeros(0))
        return nothing, nothing
    phase = PLANT_PHASE.get(figure.pole_plant, np.deg2rad(figure.pole_phase_deg))
    return tuple(_plants(run.motion, phase + half, 2.0 * AHEAD * tip_distance) for half in (0.0, np.pi))  # type: ignore[return-value]


def _plants(motion: TurningMotion, phase: float, way: float) -> Plants:
    past = np.mod(motion.phase - phase + np.pi, 2.0 * np.pi) - np.pi
    i = np.flatnonzero((past[:-1] < 0.0) & (past[1:] >= 0.0) & (past[1:] - past[:-1] < np.pi))
    share = past[i] / (past[i] - past[i + 1])
    touch = motion.time[i] + share * (motion.time[i + 1] - motion.time[i])
    brisk = np.abs(motion.lean_rate[i]) + np.abs(motion.lean[i]) > LEAST_RATE
    touch = touch[(motion.speed[i] > SLOWEST) & brisk]
    moving = np.concatenate(([True], np.diff(motion.distance) > 1e-9))
    distance, time = motion.distance[moving], motion.time[moving]
    release = np.interp(np.interp(touch, motion.time, motion.distance) + way, distance, time)
    good = release > touch + 1e-6
    return Plants(touch[good], release[good])


def swing_weight(plants: Plants, time: Array) -> Array:
    """Return how far (m,) the hand is brought to its plant: 0 carried, 1 from touch to release, eased."""
    if not len(plants.touch):
        return np.zeros(len(time))
    before, after = _neighbours(plants, time)
    return np.maximum(smoothstep(before), smoothstep(after))


def _neighbours(plants: Plants, time: Array) -> tuple[Array, Array]:
    """Return how near (m,) the next touch is and how near the last release, 0 to 1; 1 while planted."""
    count = len(plants.touch)
    last = np.searchsorted(plants.touch, time, side="right") - 1
    soon = np.minimum(last + 1, count - 1)
    before = np.where(last + 1 < count, 1.0 - (plants.touch[soon] - time) / SWING, 0.0)
    ago = time - plants.release[np.maximum(last, 0)]
    after = np.where(last >= 0, np.minimum(1.0 - ago / RECOVERY, 1.0), 0.0)
    return np.clip(before, 0.0, 1.0), np.clip(after, 0.0, 1.0)


def move_pole(
    run: Run, plants: Plants, moments: Moments, count: int, hand: Array, side: float, length: float
) -> HandMotion:
    """Return hand and pole at the first `count` of `moments`; the others are the touches, then the releases.

    `hand` (m, 3) [m, world] is where the arm would hold the pole, `side` is 1 for the left one, -1 for the right one,
    `length` [m] from grip to tip.
    """
    k = len(plants.touch)
    body = moments.body
    if not k:
        grip = hand[:count]
        return HandMotion(grip, _free(run, moments, grip, side, length, count))
    touch, release = slice(count, count + k), slice(count + k, count + 2 * k)
    ahead, out = AHEAD * length, OUTSIDE * length
    tip = _tips(run, moments, touch, hand[touch], np.array([ahead, side * out, 0.0]), length)
    raised = _raise(hand[touch], tip, body[touch, :, 2], length)
    at_release = hand[release] + raised[:, None] * body[release, :, 2]
    pushed = tip + length * unit(at_release - tip) - at_release
    left_over = np.einsum("kji,kj->ki", body[release], pushed)  # in the body's frame
    grip = _grips(plants, moments, count, hand, tip, raised, left_over, length)
    ends = (
        (hand[touch] + raised[:, None] * body[touch, :, 2], tip, touch),
        (at_release + pushed, tip, release),
    )
    up = _free(run, moments, grip, side, length, count, plants, ends)
    index, planted = _planted(plants, moments.time[:count])
    held = unit(grip - tip[index])
    return HandMotion(grip, np.where(planted[:, None], held, up))


def _planted(plants: Plants, time: Array) -> tuple[Array, Array]:
    """Return the plant (m,) that each moment is in or after, and whether the tip is in the snow."""
    index = np.maximum(np.searchsorted(plants.touch, time, side="right") - 1, 0)
    return index, (time >= plants.touch[index]) & (time <= plants.release[index])


def _tips(run: Run, moments: Moments, which: slice, hand: Array, way: Array, length: float) -> Array:
    """Return where the tips (k, 3) [m, world] go in, in the direction `way` (3,) of the body's frame from the hand.

    On a plane it is at the distance of `way`; where bumps bring the ground too near or too far, it is at another.
    """
    body, up = moments.body[which], moments.body[which, :, 2]
    flat = apply(body, way)
    distance = np.full(len(hand), float(np.hypot(*way[:2])))
    ahead = flat / distance[:, None]
    usual = np.sqrt(length**2 - distance**2)
    for _ in range(3):
        tip = _down_to_ground(run, moments, which, hand + distance[:, None] * ahead - usual[:, None] * up)
        height = dot(hand - tip, up)
        past = height - np.clip(height, usual - MOST_RAISED * length, usual + MOST_RAISED * length)
        distance = np.sqrt(length**2 - np.square(np.clip(usual + past, 0.5 * length, 0.985 * length)))
    return tip


def _down_to_ground(run: Run, moments: Moments, which: slice, tip: Array) -> Array:
    """Return `tip` (k, 3) moved along the body's up to the ground."""
    up = moments.body[which, :, 2]
    if run.terrain is None:
        return tip - dot(tip - moments.place[which], up)[:, None] * up
    under, normal = run.on_ground(tip), run.terrain.normal(tip[:, 0], tip[:, 1])
    return run.on_ground(tip - (dot(tip - under, normal) / dot(up, normal))[:, None] * up)


def _raise(hand: Array, tip: Array, up: Array, length: float) -> Array:
    """Return how far (k,) [m] hands must be raised along `up` to be `length` from their tips."""
    arm = hand - tip
    height = dot(arm, up)
    flat = arm - height[:, None] * up
    return np.sqrt(np.maximum(length**2 - dot(flat, flat), (0.3 * length) ** 2)) - height


def _grips(
    plants: Plants,
    moments: Moments,
    count: int,
    hand: Array,
    tip: Array,
    raised: Array,
    left_over: Array,
    length: float,
) -> Array:
    time, body = moments.time[:count], moments.body[:count]
    before, after = (smoothstep(weight) for weight in _neighbours(plants, time))
    last = np.searchsorted(plants.touch, time, side="right") - 1
    soon, last_held = np.minimum(last + 1, len(tip) - 1), np.maximum(last, 0)
    rise = (before * raised[soon] * before + after * raised[last_held] * after) / np.maximum(before + after, 1e-9)
    free = hand[:count] + rise[:, None] * body[..., 2]
    index, planted = _planted(plants, time)
    held = tip[index] + length * unit(free - tip[index])
    let_go = free + after[:, None] * apply(body, left_over[last_held]) * (last >= 0)[:, None]
    return np.where(planted[:, None], held, let_go)


def _free(
    run: Run,
    moments: Moments,
    grip: Array,
    side: float,
    length: float,
    count: int,
    plants: Plants | None = None,
    ends: tuple[tuple[Array, Array, slice], ...] = (),
) -> Array:
    """Return the direction (m, 3) from tip to grip of a pole in the air; its tip stays over the snow."""
    body, time = moments.body[:count], moments.time[:count]
    polar, azimuth = (np.full(count, angle) for angle in CARRIED)
    height, margin = _height(moments, slice(0, count), grip), np.full(count, CLEARANCE)
    if plants is not None:
        before, after = (smoothstep(weight) for weight in _neighbours(plants, time))
        last = np.searchsorted(plants.touch, time, side="right") - 1
        which = (np.minimum(last + 1, len(plants.touch) - 1), np.maximum(last, 0))
        share = np.maximum(before + after, 1e-9)
        for weight, (hand, tip, at), index in zip((before, after), ends, which, strict=True):
            end_polar, end_azimuth = _angles(hand - tip, moments.body[at], side)
            lower = length * np.cos(end_polar) - _height(moments, at, hand)  # the tip's ground under the smooth one
            part = weight * weight / share
            polar = polar + part * (end_polar[index] - CARRIED[0])
            azimuth = azimuth + part * (end_azimuth[index] - CARRIED[1])
            height = height + part * lower[index]
        margin = CLEARANCE * np.sqrt(1.0 - np.maximum(before, after))  # evenly down to the touch: no tip drags
    least = np.arccos(np.clip((height - margin) / length, 0.0, 1.0))
    polar = np.maximum(polar, least)
    sine = np.sin(polar)
    return unit(
        apply(body, np.stack((-sine * np.cos(azimuth), -side * sine * np.sin(azimuth), np.cos(polar)), axis=-1))
    )


def _height(moments: Moments, which: slice, place: Array) -> Array:
    """Return the height [m] of `place` (k, 3) over the ground's smooth course at those of the `moments`."""
    return dot(place - moments.place[which], moments.body[which, :, 2]) - moments.smooth[which]


def _angles(up: Array, body: Array, side: float) -> tuple[Array, Array]:
    """Return angle from upright and direction of the tip, to the outside from straight ahead, of poles `up` (k, 3).

    The direction is less than half a circle from that of a carried pole, so that the way between goes round outside.
    """
    local = np.einsum("kji,kj->ki", body, unit(up))
    past = np.arctan2(-side * local[:, 1], -local[:, 0]) - CARRIED[1]
    azimuth = CARRIED[1] + np.mod(past + np.pi, 2.0 * np.pi) - np.pi
    return np.arccos(np.clip(local[:, 2], -1.0, 1.0)), azimuth


def pole_turn(up: Array, body: Array) -> Array:
    """Return rotations (m, 3, 3) of poles with z along `up` (m, 3) and y as near to that of `body` as it can be."""
    y = unit(body[..., 1] - dot(body[..., 1], up)[:, None] * up)
    return columns(cross(y, up), y, up)
