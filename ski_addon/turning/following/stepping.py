"""One stage of many turning bodies along a lane, with the curvature changing at constant rates [VP93 sec. 3, 6.1]."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...frames import Array
from ..body import TurningBody, support_speed
from .lane import Lane

X, Y, HEADING, LEAN, LEAN_RATE, CURVATURE = range(6)
"""Rows of a state (6, n): place of the support [m], heading [rad], lean [rad] and its rate [rad/s], curvature [1/m];
all but x positive to the left."""


@dataclass(frozen=True)
class Bodies:
    """Many bodies at one moment: `state` (6, n) and the lane's `nearest` samples (n,)."""

    state: Array
    nearest: Array

    def some(self, index: Array | slice) -> Bodies:
        """Return those of `index`."""
        return Bodies(self.state[:, index], self.nearest[index])


@dataclass(frozen=True)
class Stage:
    """Many bodies at the samples of one stage: `states` (s, 6, n), `nearest` samples of the lane (s, n) and the
    `distance` (s, n) [m] to them.
    """

    states: Array
    nearest: Array
    distance: Array

    @property
    def last(self) -> Bodies:
        """The bodies at the end of the stage."""
        return Bodies(self.states[-1], self.nearest[-1])

    def some(self, index: Array | slice) -> Stage:
        """Return those of `index`."""
        return Stage(self.states[:, :, index], self.nearest[:, index], self.distance[:, index])


def body_on(lane: Lane, place: Array | None = None, heading: float | None = None) -> Bodies:
    """Return one upright body that runs straight on, by default at the lane's beginning and along it."""
    place = lane.path.places[0] if place is None else np.asarray(place, dtype=float)
    nearest = lane.nearest_of_all(place)
    heading = float(lane.path.heading[nearest]) if heading is None else heading
    return Bodies(np.array([place[0], place[1], heading, 0.0, 0.0, 0.0])[:, None], np.array([nearest]))


def ridden(body: TurningBody, lane: Lane, now: Bodies, rate: Array, step: float, count: int) -> Stage:
    """Return `count` samples, `step` [s] apart, of bodies whose curvature changes by `rate` (n,) [1/m/s]."""
    size, last = len(now.nearest), len(lane.path.along) - 1
    passed = (step * lane.samples_per_second[now.nearest]) * np.arange(count + 1, dtype=float)[:, None]
    hint = np.minimum(now.nearest + passed.astype(now.nearest.dtype), last)
    at = np.minimum(now.nearest + (0.5 * passed[-1]).astype(now.nearest.dtype), last)  # in the middle of the stage
    pull = lane.pull[at] if lane.tilted else None
    states = motion_after(body, now.state, rate, step, count, lane.speed[at], lane.normal[at], pull)
    nearest, distance = lane.nearest(states[:, X].ravel(), states[:, Y].ravel(), hint[1:].ravel())
    return Stage(states, nearest.reshape(count, size), distance.reshape(count, size))


def motion_after(
    body: TurningBody,
    state: Array,
    rate: Array,
    step: float,
    count: int,
    speed: Array,
    normal: Array,
    pull: Array | None,
) -> Array:
    """Return states (count, 6, n), `step` [s] apart, from `state` (6, n) on at `speed` (n,) [m/s].

    Gravity is `normal` (n,) into the ground and `pull` (n, 2) along it [m/s^2] (None for level ground). The lean is
    integrated by Nyström's method of fourth order, which suits an acceleration that depends on the lean and not on
    its rate; heading and place follow by Simpson's rule.
    """
    halves = np.arange(2 * count + 1)[:, None] * (0.5 * step)
    curve = state[CURVATURE] + halves * rate
    across = _pull_across(state, rate, speed, halves, pull)
    lean, lean_rate = _leans(body, state, curve, step, speed, normal, across)
    pace = support_speed(lean, curve, speed, body.leg_length)
    heading = state[HEADING] + _integral(curve * pace, step)
    x, y = _simpson(pace * np.cos(heading), step), _simpson(pace * np.sin(heading), step)
    states = np.empty((count, *state.shape))
    states[:, X], states[:, Y] = state[X] + x, state[Y] + y
    states[:, HEADING], states[:, LEAN], states[:, LEAN_RATE] = heading[2::2], lean[2::2], lean_rate
    states[:, CURVATURE] = curve[2::2]
    return states


def _pull_across(state: Array, rate: Array, speed: Array, halves: Array, pull: Array | None) -> Array | None:
    """Return gravity to the left (2 count + 1, n) [m/s^2] along a heading that turns as the centre of mass would."""
    if pull is None:
        return None
    heading = state[HEADING] + speed * halves * (state[CURVATURE] + 0.5 * halves * rate)
    return np.asarray(pull[:, 1] * np.cos(heading) - pull[:, 0] * np.sin(heading))


def _leans(
    body: TurningBody, state: Array, curve: Array, step: float, speed: Array, normal: Array, across: Array | None
) -> tuple[Array, Array]:
    """Return leans (2 count + 1, n) at every half step and their rates (count, n) at every step."""
    half, size = 0.5 * step, len(curve) // 2
    leans, rates = np.empty_like(curve), np.empty_like(curve[:size])
    lean, lean_rate = state[LEAN], state[LEAN_RATE]
    leans[0] = lean
    for k in range(size):
        a, b, c = (0.0, 0.0, 0.0) if across is None else across[2 * k : 2 * k + 3]
        first = body.lean_acceleration(lean, curve[2 * k], speed, normal, a)
        middle = lean + half * (lean_rate + 0.5 * half * first)
        second = body.lean_acceleration(middle, curve[2 * k + 1], speed, normal, b)
        end = lean + step * (lean_rate + half * second)
        third = body.lean_acceleration(end, curve[2 * k + 2], speed, normal, c)
        lean = lean + step * (lean_rate + step / 6.0 * (first + 2.0 * second))
        lean_rate = lean_rate + step / 6.0 * (first + 4.0 * second + third)
        leans[2 * k + 1], leans[2 * k + 2], rates[k] = middle, lean, lean_rate
    return leans, rates


def _simpson(values: Array, step: float) -> Array:
    """Return the integral (count, n) at every step of `values` (2 count + 1, n) at every half step."""
    return np.cumsum((step / 6.0) * (values[:-2:2] + 4.0 * values[1::2] + values[2::2]), axis=0)


def _integral(values: Array, step: float) -> Array:
    """Return the integral (2 count + 1, n) of `values` at every half step, from parabolas through three of them."""
    found = np.zeros_like(values)
    found[2::2] = _simpson(values, step)
    found[1::2] = found[:-2:2] + (step / 24.0) * (5.0 * values[:-2:2] + 8.0 * values[1::2] - values[2::2])
    return found
