"""One stage of many turning bodies along a lane, with the curvature changing at constant rates [VP93 sec. 3, 6.1]."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...frames import Array
from ..body import TurningBody
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
    lean, lean_rate, sine = _leans(body, state, curve, step, speed, normal, across)
    pace = speed / (1.0 - float(body.leg_length) * curve * sine)  # of the support [VP93 Eq. 21]
    heading = state[HEADING] + _integral(curve * pace, step)
    states = np.empty((count, *state.shape))
    states[:, X] = state[X] + _simpson(pace * np.cos(heading), step)
    states[:, Y] = state[Y] + _simpson(pace * np.sin(heading), step)
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
) -> tuple[Array, Array, Array]:
    """Return leans (2 count + 1, n) at every half step, their rates (count, n) at every step, and the leans' sines."""
    half, sixth, size = 0.5 * step, step / 6.0, len(curve) // 2
    leans, rates, sines = np.empty_like(curve), np.empty_like(curve[:size]), np.empty_like(curve)
    lean, lean_rate = state[LEAN], state[LEAN_RATE]
    pushes = _Pushes(body, curve, speed, normal, across)
    for k in range(size):
        leans[2 * k] = lean
        first = pushes.at(2 * k, lean, sines)
        middle = lean + half * (lean_rate + 0.5 * half * first)
        leans[2 * k + 1] = middle
        second = pushes.at(2 * k + 1, middle, sines)
        third = pushes.at(2 * k + 2, lean + step * (lean_rate + half * second), sines)
        lean = lean + step * (lean_rate + sixth * (first + 2.0 * second))
        lean_rate = lean_rate + sixth * (first + 4.0 * second + third)
        rates[k] = lean_rate
    leans[-1] = lean
    np.sin(lean, out=sines[-1])
    return leans, rates, sines


class _Pushes:
    """Accelerations of leans at the moments of a stage: `TurningBody.lean_acceleration` with all that the moments
    share worked out before.
    """

    def __init__(self, body: TurningBody, curve: Array, speed: Array, normal: Array, across: Array | None) -> None:
        effective = 1.0 / float(body.effective_length)
        self.normal = normal * effective
        self.across = None if across is None else across * effective
        self.turn = curve * (np.square(speed) * effective)
        self.bend = curve * float(body.leg_length)

    def at(self, moment: int, lean: Array, sines: Array) -> Array:
        """Return the accelerations (n,) [rad/s^2] of `lean` (n,) at a moment; its sines go into row `moment`."""
        sine, cosine = np.sin(lean, out=sines[moment]), np.cos(lean)
        steering = self.turn[moment] / (1.0 - self.bend[moment] * sine)
        if self.across is not None:
            steering -= self.across[moment]
        return self.normal * sine - steering * cosine


def _simpson(values: Array, step: float) -> Array:
    """Return the integral (count, n) at every step of `values` (2 count + 1, n) at every half step."""
    return np.cumsum((step / 6.0) * (values[:-2:2] + 4.0 * values[1::2] + values[2::2]), axis=0)


def _integral(values: Array, step: float) -> Array:
    """Return the integral (2 count + 1, n) of `values` at every half step, from parabolas through three of them."""
    found = np.zeros_like(values)
    found[2::2] = _simpson(values, step)
    found[1::2] = found[:-2:2] + (step / 24.0) * (5.0 * values[:-2:2] + 8.0 * values[1::2] - values[2::2])
    return found
