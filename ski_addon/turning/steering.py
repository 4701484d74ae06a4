"""Phase control at work: thousands of bodies that swing with frequencies, sharpnesses and headings of their own.

Each step asks the ellipse control for a lean acceleration, the inverse dynamics for the curvature that gives it, bounds
the curvature and its rate, and takes the acceleration that is left [VP93 Eqs. 1, 2, sec. 5]. The steps are those of the
second-order Adams-Bashforth rule: as quick as the paper's Euler, with errors in the square of the step.

At phases 0 and 180 degrees the coming half swing gets its target: the frequency and sharpness that are asked for in its
middle, modified by beta so that it ends in the direction asked for [VP93 sec. 5.2], which is the heading of that time
and half a swing to the turn's side. A target that changed within the half swing, as in the paper, would be missed by as
much as it changes, and jerk where one controlling ellipse gives way to the other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from .body import TurningBody, steered_acceleration
from .ellipse import ControlBounds, wanted_acceleration
from .heading import heading_change, turn_modifier
from .numbers import ARRAYS, PLAIN, Numbers
from .pace import Pace
from .phase import phase_of

SLOWEST = 0.5
"""A body slower than this [m/s] has stopped."""
FALLEN = math.radians(75.0)
"""A body that leans further [rad] has fallen."""
LEAST_BETA, MOST_BETA = 0.4, 2.0
"""A half swing is changed to between these shares of its sharpness and duration; the rest is left to later ones."""
SHARPEST = math.radians(65.0)
"""No half swing is made sharper than this [rad]."""

RUNNING, STOPPED, FELL = 0, 1, 2
"""How a body's run ended: at the end of its time, because it stood, or because it fell."""


@dataclass(frozen=True)
class Targets:
    """What is asked for at n moments, every `step` [s]: `frequency` [rad/s], `sharpness` [rad] and `heading` [rad],
    each (n, m) for m bodies.
    """

    step: float
    frequency: np.ndarray
    sharpness: np.ndarray
    heading: np.ndarray


@dataclass(frozen=True)
class Start:
    """How bodies begin, each a number or (m,): `speed` [m/s]; `side` of the first turn, +1 left, -1 right; `swinging`
    bodies come upright on their ellipse as they start, others go straight on and are sent into their first turn;
    `heading` [rad] at the start, or None for one from which the first swings go where they are asked to.
    """

    speed: Any = 8.0
    side: Any = 1.0
    swinging: bool = True
    heading: Any = None


@dataclass(frozen=True)
class Steered:
    """What m bodies did at n moments; arrays (n, m), in the coordinates of the slope.

    `down`, `left` [m] of the support and `course` [rad], the direction it goes, from the fall line to the left; `speed`
    [m/s] of the centre of mass; `lean` [rad], `lean_rate` [rad/s], `curvature` [1/m] and `phase` [rad] as in
    `TurningMotion`; `beta` is the modifier of the half swing. `ended` (m,) is how the run of each body ended and `last`
    (m,) its last moment. `turns` are the half swings as they began, in the order of time.
    """

    time: np.ndarray
    down: np.ndarray
    left: np.ndarray
    course: np.ndarray
    speed: np.ndarray
    lean: np.ndarray
    lean_rate: np.ndarray
    curvature: np.ndarray
    phase: np.ndarray
    beta: np.ndarray
    ended: np.ndarray
    last: np.ndarray
    turns: tuple[HalfSwing, ...] = ()


@dataclass(frozen=True)
class HalfSwing:
    """Half swings that began at moment `index` for the bodies `body` (k,): the `speed` [m/s] they were counted with,
    the `frequency` [rad/s] and `sharpness` [rad] asked for, the `turn` [rad] that was asked of them, positive to their
    own `side` (k,), the `beta` (k,) they got, and by how much they will miss the direction asked for because beta has
    limits, `missed` (k,) [rad].
    """

    index: int
    body: np.ndarray
    side: np.ndarray
    speed: np.ndarray
    frequency: np.ndarray
    sharpness: np.ndarray
    turn: np.ndarray
    beta: np.ndarray
    missed: np.ndarray


@dataclass
class _State:
    """Where the bodies are: numbers or arrays (m,)."""

    down: Any
    left: Any
    course: Any
    speed: Any
    lean: Any
    rate: Any
    curvature: Any
    beta: Any
    frequency: Any
    sharpness: Any
    before: tuple[Any, Any, Any] | None = None
    gain: Any = 0.0
    turns: list[HalfSwing] = field(default_factory=list)

    def row(self, curvature: Any) -> tuple[Any, ...]:
        """Return what is kept of this moment, in the order of `_Steering._result`."""
        ellipse = (self.beta, self.sharpness, self.frequency * self.sharpness)
        return (self.down, self.left, self.course, self.speed, self.lean, self.rate, curvature, *ellipse)


def steer(
    body: TurningBody,
    targets: Targets,
    start: Start | None = None,
    pace: Pace | None = None,
    bounds: ControlBounds | None = None,
) -> Steered:
    """Return how m bodies swing who are asked for `targets`.

    `body` may have fields (m,). Bodies that fall or stop are carried on at their limits; see `Steered.last`.
    """
    return _Steering(body, targets, start or Start(), pace or Pace(), bounds or ControlBounds()).run()


class _Steering:
    def __init__(self, body: TurningBody, targets: Targets, start: Start, pace: Pace, bounds: ControlBounds) -> None:
        self.body, self.targets, self.start, self.pace, self.bounds = body, targets, start, pace, bounds
        self.count, self.bodies = targets.frequency.shape
        self.single = self.bodies == 1
        self.numbers: Numbers = PLAIN if self.single else ARRAYS
        self.length = self._own(body.effective_length)
        self.leg = self._own(body.leg_length)
        self.sharpest = self._own(body.curvature_bound)
        self.most_change = self._own(body.curvature_rate_bound) * targets.step
        self.side = self._own(start.side)
        self.leaned_left = self.side > 0.0  # the half swing that the body begins with
        self.normal, self.gravity = self._own(pace.gravity_normal), self._own(pace.gravity_down)

    def _own(self, value: Any) -> Any:
        """Return a parameter as the kind of number the steps are made with."""
        return (
            float(np.reshape(value, -1)[0]) if self.single else np.broadcast_to(np.asarray(value, float), self.bodies)
        )

    def run(self) -> Steered:
        """Take all steps."""
        state = self._begin()
        kept = np.empty((10, self.count, self.bodies))
        rows = []
        for index in range(self.count):
            curvature = self._curvature(state)
            row = state.row(curvature)
            if self.single:
                rows.append(row)
                if abs(state.lean) > FALLEN or state.speed < SLOWEST:
                    break
            else:
                for place, value in enumerate(row):
                    kept[place, index] = value
            self._advance(state, curvature)
            self._modify(state, index + 1)
        if self.single:
            kept = np.array(rows).T[:, :, None]
        return self._result(kept, state)

    def _begin(self) -> _State:
        one = 1.0 if self.single else np.ones(self.bodies)
        start, side = self.start, self.side
        speed = self._own(start.speed) * one
        frequency, sharpness = self._first(self.targets.frequency), self._first(self.targets.sharpness)
        rate = side * frequency * sharpness if start.swinging else 0.0 * one
        heading = self._first(self.targets.heading)
        if start.heading is not None:
            course = self._own(start.heading) * one
        elif start.swinging:
            course = heading - 0.5 * side * self._swing(sharpness, frequency, speed)
        else:
            course = heading * one
        curvature = -self.gravity * self.numbers.sin(course) / (speed * speed) if start.swinging else 0.0 * one
        curvature = self.numbers.held(curvature, -self.sharpest, self.sharpest)
        state = _State(0.0 * one, 0.0 * one, course, speed, 0.0 * one, rate, curvature, one, frequency, sharpness)
        if start.swinging:
            self._modify_now(state, 0, np.arange(self.bodies))
        return state

    def _first(self, values: np.ndarray) -> Any:
        return float(values[0, 0]) if self.single else values[0].copy()

    def _swing(self, sharpness: Any, frequency: Any, speed: Any) -> Any:
        change = heading_change(self._shared(np.arange(self.bodies)), sharpness, frequency, speed, self.normal)
        return float(change) if self.single else change

    def _shared(self, which: np.ndarray) -> TurningBody:
        """Return the bodies `which` (k,) alone."""
        if self.single:
            return TurningBody(self.leg, (self.length - self.leg) * self.leg)
        leg = self.leg[which]
        return TurningBody(leg, (self.length[which] - leg) * leg)

    def _curvature(self, state: _State) -> Any:
        """Return the curvature for the coming step: the wanted one within its bounds."""
        numbers = self.numbers
        wanted = wanted_acceleration(
            state.lean, state.rate, state.frequency, state.sharpness, self.bounds, self.side, numbers
        )
        sine, cosine = numbers.sin(state.lean), numbers.cos(state.lean)
        self.pull = self.normal * sine - self.gravity * numbers.sin(state.course) * cosine
        self.sine, self.cosine = sine, cosine
        push = self.pull - wanted * self.length
        room = numbers.most(push * self.leg * sine + state.speed * state.speed * cosine, 1e-6)
        curvature = push / room  # [VP93 Eq. 1]; a slow body would need turns tighter than its leg: at the bound then
        curvature = numbers.held(curvature, state.curvature - self.most_change, state.curvature + self.most_change)
        return numbers.held(curvature, -self.sharpest, self.sharpest)

    def _advance(self, state: _State, curvature: Any) -> None:
        """Move on by one step."""
        numbers, step = self.numbers, self.targets.step
        circle = 1.0 - curvature * self.leg * self.sine
        support = state.speed / circle
        turning = support * curvature
        fall = steered_acceleration(self.pull, self.sine, self.cosine, curvature, state.speed, self.leg, self.length)
        if self.pace.held:
            gain = 0.0 * state.speed
        else:
            along = self.gravity * numbers.cos(state.course)
            side = turning * state.speed + self.gravity * numbers.sin(state.course)
            gain = self.pace.acceleration(state.speed, along, side, numbers)
        now = (fall, turning, gain)
        fall, turning, gain = self._ahead(now, state.before)
        rate, course = state.rate + step * fall, state.course + step * turning
        speed = numbers.most(state.speed + step * gain, 0.5 * SLOWEST)
        way, middle = 0.5 * step * (state.speed + speed) / circle, 0.5 * (state.course + course)
        state.down = state.down + way * numbers.cos(middle)
        state.left = state.left + way * numbers.sin(middle)
        lean = state.lean + 0.5 * step * (state.rate + rate)
        state.lean = lean if self.single else np.clip(lean, -1.4, 1.4)
        state.rate, state.course, state.speed, state.curvature = rate, course, speed, curvature
        state.before, state.gain = now, now[2]

    @staticmethod
    def _ahead(now: tuple[Any, Any, Any], before: tuple[Any, Any, Any] | None) -> tuple[Any, Any, Any]:
        if before is None:
            return now
        fall, turning, gain = (1.5 * a - 0.5 * b for a, b in zip(now, before, strict=True))
        return fall, turning, gain

    def _modify(self, state: _State, index: int) -> None:
        """Choose beta anew for the bodies that just came upright."""
        if index >= self.count:
            return
        lean, rate = state.lean, state.rate
        if self.single:
            if (lean >= 0.0) != self.leaned_left and rate * lean >= 0.0:
                self._modify_now(state, index, np.zeros(1, dtype=int))
            self.leaned_left = lean >= 0.0
            return
        left = lean >= 0.0
        crossed = np.flatnonzero((left != self.leaned_left) & (rate * lean >= 0.0))
        self.leaned_left = left
        if len(crossed):
            self._modify_now(state, index, crossed)

    def _modify_now(self, state: _State, index: int, which: np.ndarray) -> None:
        """Choose beta for the bodies `which` (k,), whose half swing begins at moment `index`."""

        def of(value: Any) -> np.ndarray:
            return np.reshape(value, -1)[which] if np.ndim(value) else np.full(len(which), value)

        rate, course, speed = of(state.rate), of(state.course), of(state.speed)
        side = np.where(rate >= 0.0, 1.0, -1.0)
        middle, end, half = self._moments(index, which)
        frequency, sharpness = self.targets.frequency[middle, which], self.targets.sharpness[middle, which]
        bodies, normal, gravity = self._shared(which), of(self.normal), of(self.gravity)
        speed = np.maximum(speed + 0.5 * half * of(state.gain), 0.5 * speed)
        swing = heading_change(bodies, sharpness, frequency, speed, normal)
        turn = side * (self.targets.heading[end, which] - course) + 0.5 * swing
        drift = -gravity / speed * _mean_sine(course, course + side * turn) * side
        rate = np.maximum(np.abs(rate), self.bounds.origin * frequency * sharpness)
        limits = (LEAST_BETA, np.minimum(MOST_BETA, np.maximum(SHARPEST / sharpness, 1.0)))
        beta, missed = turn_modifier(bodies, turn, sharpness, frequency, speed, rate, drift, normal, limits)
        state.turns.append(HalfSwing(index, which, side, speed, frequency, sharpness, turn, beta, missed))
        for name, value in (("beta", beta), ("frequency", frequency / beta), ("sharpness", sharpness * beta)):
            if self.single:
                setattr(state, name, float(value[0]))
            else:
                getattr(state, name)[which] = value

    def _moments(self, index: int, which: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the moments (k,) in the middle and at the end of half swings that begin at `index`, and how long they
        last [s].
        """
        step = self.targets.step
        half = np.pi / self.targets.frequency[index, which]
        middle = np.minimum(index + (0.5 * half / step).astype(int), self.count - 1)
        half = np.pi / self.targets.frequency[middle, which]
        return middle, np.minimum(index + (half / step).astype(int), self.count - 1), half

    def _result(self, kept: np.ndarray, state: _State) -> Steered:
        down, left, course, speed, lean, rate, curvature, beta, sharpness, swing = kept
        count = kept.shape[1]
        over = (np.abs(lean) > FALLEN) | (speed < SLOWEST)
        last = np.where(over.any(axis=0), np.argmax(over, axis=0), count - 1)
        fell = np.abs(lean[last, np.arange(self.bodies)]) > FALLEN
        ended = np.where(over.any(axis=0), np.where(fell, FELL, STOPPED), RUNNING)
        phase = phase_of(lean, rate, sharpness, swing)
        time = self.targets.step * np.arange(count)
        return Steered(
            time, down, left, course, speed, lean, rate, curvature, phase, beta, ended, last, tuple(state.turns)
        )


def _mean_sine(begin: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return the mean sine of the direction over a half swing from `begin` to `end` (k,) [rad]."""
    middle, half = 0.5 * (begin + end), 0.5 * (end - begin)
    return np.sin(middle) * (2.0 * np.cos(math.sqrt(0.75) * half) + 1.0) / 3.0
