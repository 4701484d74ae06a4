"""The cranks: turned by the way travelled, held with the inside pedal up where the bicycle leans over [VP93 sec. 7].

A freewheel lets the cranks be slower than the wheel, never faster. Between two sharp turns they are brought from one
inside pedal up to the next by as many turns as the way allows, and start and stop gently.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...gravity import STANDARD_GRAVITY
from ..motion import TurningMotion
from .vectors import Array

LEANING = np.deg2rad(13.0)
"""Lean [rad] of a steady turn from which on the cranks are held."""
UP = {1: -0.5 * np.pi, -1: 0.5 * np.pi}
"""Angle of the cranks [rad] with the left pedal up, for a turn to the left, and with the right one up."""
RAMP, START = 0.2, 1.0
"""Share of a stretch of pedalling in which the cranks gather speed, and as long to stop; at both ends of a run [m]."""


@dataclass(frozen=True)
class Held:
    """A stretch of the way, from `begin` to `end` [m], on which the cranks are held at `angle` [rad]."""

    begin: float
    end: float
    angle: float


def held_cranks(motion: TurningMotion, development: float) -> list[Held]:
    """Return where the cranks of a bicycle are held in `motion`; `development` [m] is its way for one turn of them."""
    pull = np.arctan(np.square(motion.speed) * motion.curvature / STANDARD_GRAVITY)
    side = np.sign(pull) * (np.abs(pull) > LEANING)
    bounds = np.concatenate(([0], np.flatnonzero(np.diff(side)) + 1, [len(side)]))
    sharp = [(i, j - 1) for i, j in zip(bounds, bounds[1:], strict=False) if side[i] and j - i > 1]
    turns = [(motion.distance[i], motion.distance[j], int(side[i])) for i, j in sharp]
    return _placed([turn for turn in turns if turn[1] > turn[0]], development)


def _placed(turns: list[tuple[float, float, int]], development: float) -> list[Held]:
    """Return the stretches (begin, end, side) with angles that one after the other can be reached.

    A stretch gives way to its neighbours where there is too little way to change the pedals; one that has nothing left
    is pedalled through.
    """
    held: list[Held] = []
    for begin, end, side in turns:
        if not held:
            held.append(Held(begin, end, UP[side]))
            continue
        last = held[-1]
        needed = np.mod(UP[side] - last.angle, 2.0 * np.pi)
        missing = 0.5 * max(needed / _most(1.0, development) - (begin - last.end), 0.0)
        if last.end - missing <= last.begin or begin + missing >= end:
            continue
        held[-1] = Held(last.begin, last.end - missing, last.angle)
        begin = begin + missing
        rounds = np.floor((_most(begin - held[-1].end, development) - needed) / (2.0 * np.pi) + 1e-9)
        held.append(Held(begin, end, last.angle + needed + 2.0 * np.pi * rounds))
    return held


def _most(way: float, development: float) -> float:
    """Return how far [rad] the cranks can come on `way` [m] from rest to rest."""
    return 2.0 * np.pi * (1.0 - RAMP) * way / development


def crank_angle(held: list[Held], way: Array, development: float) -> Array:
    """Return the angle (m,) [rad] of the cranks where the rear wheel has come `way` (m,) [m]."""
    rate = 2.0 * np.pi / development
    if not held:
        return rate * way
    angle = held[0].angle - rate * _from_rest(held[0].begin - way)
    for last, following in zip(held, held[1:], strict=False):
        share = np.clip((way - last.end) / (following.begin - last.end), 0.0, 1.0)
        angle = np.where(way > last.end, last.angle + (following.angle - last.angle) * _rest_to_rest(share), angle)
    return angle + rate * _from_rest(way - held[-1].end)


def _from_rest(way: Array) -> Array:
    """Return how much of the way (m,) [m] the cranks turn with the wheel after they were held; nothing before it."""
    way = np.maximum(way, 0.0)
    return np.where(way < START, np.square(way) / (2.0 * START), way - 0.5 * START)


def _rest_to_rest(share: Array) -> Array:
    """Return the part of a turn that is done at a `share` (m,) of its way, with gentle start and stop."""
    peak = 1.0 / (1.0 - RAMP)
    near = np.minimum(share, 1.0 - share)
    eased = peak * np.where(near < RAMP, np.square(near) / (2.0 * RAMP), near - 0.5 * RAMP)
    return np.where(share < 0.5, eased, 1.0 - eased)
