"""The balanced centre of mass: an inverted pendulum over the skis, planned as a boundary-value problem.

The paper leans a rigid leg by the instantaneous force balance [SG19 Eq. 7, 14], which asks for a zero-moment point
outside the stance whenever a turn changes fast. Here the offset y of the centre of mass across the skis obeys the
pendulum of [VP93 Eq. 1], written for a pivot under the middle of the skis that moves over any ground:

    y'' - (N / h + w_e^2 + w_n^2) y = g_a + D_a - p''_a + w_e' h + 2 w_e h' - w_a w_n h
    N = h'' + w_e' y + 2 w_e y' + w_n w_a y - (w_e^2 + w_a^2) h + p''_n - g_n

in the body's frame (e along the skis, a across to the left, n up from the smooth ground) that turns with angular
velocity w; h is the height over the skis, p'' their acceleration, D air drag, N the force along n per mass. On a plane,
without skidding, only w_n = kappa v is left and a steady turn gives tan(lean) = v^2 / (g r). It has one bounded
solution, which anticipates transitions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..frames import components
from .differences import Differences
from .line import Line

STEEPEST = np.deg2rad(75.0)
"""Lean [rad] at which the iteration is held; a plan that needs it is refused later."""
PADDING_TIME = 1.6
"""Time [s] by which a plan is extended at constant values so that its ends do not disturb it."""
MOST_ITERATIONS = 400
LONGEST_SMOOTHING = 0.6
"""Time [s] over which legs may spread a change of height to keep their load."""


@dataclass(frozen=True)
class Pendulum:
    """Offset `y` across the skis and height `h` (n,) [m] of the centre of mass, the rates of both [m/s], the snow's
    normal force per mass `normal` [m/s^2] and `swing` [m/s^2], what the body's motion over the skis adds to the
    acceleration along them.
    """

    y: np.ndarray
    y_rate: np.ndarray
    h: np.ndarray
    h_rate: np.ndarray
    normal: np.ndarray
    swing: np.ndarray

    @property
    def inclination(self) -> np.ndarray:
        """Lean (n,) [rad], positive to the left."""
        return np.arctan2(self.y, self.h)


@dataclass(frozen=True)
class Legs:
    """What the legs can do: `length` [m] is the height of the centre of mass of the upright stance, `extension` and
    `retraction` [m] how much they may lengthen and shorten it, `least_load` the least normal force in units of the
    skier's own, `rise` (n,) [m] how much higher the skier wants to stand than that to absorb bumps.
    """

    length: float
    extension: float
    retraction: float
    least_load: float
    rise: np.ndarray


@dataclass(frozen=True)
class _Pivot:
    """The padded terms of the pendulum that do not depend on it, (n,) each: angular velocity of the skis' frame
    `along`, `across`, `up` [rad/s], the force that drives it sideways `side`, and the normal force `rest` of a
    centre of mass that moves with the skis [m/s^2]; `time` differentiates.
    """

    time: Differences
    along: np.ndarray
    across: np.ndarray
    up: np.ndarray
    side: np.ndarray
    rest: np.ndarray
    into: np.ndarray
    rise: np.ndarray

    @cached_property
    def along_rate(self) -> np.ndarray:
        """The rate of `along` (n,) [rad/s^2]."""
        return self.time.first(self.along)


def upright(line: Line, height: float) -> Pendulum:
    """Return the pendulum of a skier who stands upright from the snow at `height` [m], whatever the forces."""
    zero = np.zeros_like(line.time)
    return Pendulum(zero, zero, np.full_like(zero, height), zero, line.gravity_into, zero)


def balanced_pendulum(line: Line, legs: Legs) -> Pendulum:
    """Return the pendulum that is balanced along `line` on `legs`."""
    pivot = _pivot(line, legs)
    y, h = np.zeros_like(pivot.rise), legs.length + pivot.rise
    least, turns_over, limit = 0.05 * pivot.into, pivot.across * pivot.up, legs.length * np.sin(STEEPEST)
    spin, roll, roll_rate = pivot.along**2 + pivot.up**2, 2.0 * pivot.along, pivot.along_rate
    smoothing = 0.0
    for _ in range(MOST_ITERATIONS):
        stiffness = np.maximum(_normal(pivot, y, h), least) / h + spin
        turning = roll_rate * h + roll * pivot.time.first(h)
        solved = pivot.time.bounded_solution(stiffness, pivot.side + turning - turns_over * h)
        change = np.clip(solved, -limit, limit) - y
        y = y + change * 0.8 / (1.0 + (y / h) ** 2)  # the height falls as the lean grows: a full step would overshoot
        h = _height(pivot, y, legs, smoothing)
        if np.max(np.abs(change)) < 1e-7:
            load = np.min(_normal(pivot, y, h) / pivot.into)
            if load >= legs.least_load or smoothing > LONGEST_SMOOTHING:
                break
            smoothing = max(1.25 * smoothing, 0.04)
            h = _height(pivot, y, legs, smoothing)
    return _cut(pivot, line, y, h)


def rigid_pendulum(line: Line, legs: Legs) -> Pendulum:
    """Return the paper's rigid leg, which leans by the force balance of the instant [SG19 Eq. 7, 14], to compare."""
    pivot = _pivot(line, legs)
    lean = np.clip(np.arctan2(-pivot.side, pivot.rest), -STEEPEST, STEEPEST)
    length = legs.length + pivot.rise
    return _cut(pivot, line, length * np.sin(lean), length * np.cos(lean))


def mirrored(pendulum: Pendulum) -> Pendulum:
    """Return a pendulum that leans to the other side."""
    return replace(pendulum, y=-pendulum.y, y_rate=-pendulum.y_rate)


def _pivot(line: Line, legs: Legs) -> _Pivot:
    along, across, up = components(line.spin)
    _, side, down = components(line.pull)
    padded = _padded(line.time, along, across, up, side, -down, line.gravity_into, legs.rise)
    padded[-1] = _eased(padded[-1], float(padded[0][1] - padded[0][0]))
    return _Pivot(Differences(padded[0]), *padded[1:])


def _normal(pivot: _Pivot, y: np.ndarray, h: np.ndarray) -> np.ndarray:
    """Return the normal force per mass (n,) [m/s^2] of a body at `y`, `h` (n,) [m]."""
    time = pivot.time
    turning = pivot.along_rate * y + 2.0 * pivot.along * time.first(y) + pivot.up * pivot.across * y
    return time.second(h) + turning - (pivot.along**2 + pivot.across**2) * h + pivot.rest


def _height(pivot: _Pivot, y: np.ndarray, legs: Legs, smoothing: float) -> np.ndarray:
    """Return the height (n,) [m] of a rigid lean, smoothed over `smoothing` [s] within what the legs can reach."""
    from scipy.ndimage import gaussian_filter1d

    rigid = np.sqrt(legs.length**2 - y**2)
    if smoothing:
        step = pivot.time.step
        room = np.sqrt((legs.length + legs.extension) ** 2 - y**2)
        rigid = np.minimum(gaussian_filter1d(rigid, smoothing / step, mode="nearest"), room)
        rigid = gaussian_filter1d(rigid, 0.03 / step, mode="nearest")
    return rigid * (1.0 + pivot.rise / legs.length)


def _cut(pivot: _Pivot, line: Line, y: np.ndarray, h: np.ndarray) -> Pendulum:
    """Return the pendulum without the padding."""
    time, up, along, across = pivot.time, pivot.up, pivot.along, pivot.across
    y_rate, h_rate = time.first(y), time.first(h)
    swing = time.first(across) * h - time.first(up) * y + 2.0 * (across * h_rate - up * y_rate)
    swing += along * (across * y + up * h)
    normal = _normal(pivot, y, h)
    lift = normal - pivot.rest  # what the body's motion over the skis adds along its up axis
    inner = slice(_PAD, -_PAD)
    y, y_rate, h, h_rate, normal, swing, lift = (array[inner] for array in (y, y_rate, h, h_rate, normal, swing, lift))
    skis = np.cross(line.body_frame[..., 1], line.surface_normal)  # along the skis on the bumpy snow
    ahead, _, lifted = (np.sum(line.body_frame[..., axis] * skis, axis=1) for axis in range(3))
    return Pendulum(y, y_rate, h, h_rate, normal * _bearing(line, y / h, lifted / ahead), swing * ahead + lift * lifted)


def _bearing(line: Line, lean: np.ndarray, pitch: np.ndarray) -> np.ndarray:
    """Return the snow's normal force (n,) for each unit of force up from the smooth ground, on a body that leans by the
    tangent `lean` to the left; `pitch` is that of the skis. Snow bears nothing along the skis.
    """
    forward, left, up = (np.sum(line.body_frame[..., axis] * line.surface_normal, axis=1) for axis in range(3))
    return up + lean * left - pitch * forward


_PAD = 320
EASING_TIME = 0.25
"""Time [s] in which legs that move at the end of a track come to rest beyond it."""


def _eased(padded: np.ndarray, step: float) -> np.ndarray:
    """Return a padded height that goes on smoothly beyond the track instead of stopping with a jerk."""
    beyond = EASING_TIME * (1.0 - np.exp(-step * np.arange(1, _PAD + 1) / EASING_TIME))
    inner = padded[_PAD:-_PAD]
    first, last = (inner[1] - inner[0]) / step, (inner[-1] - inner[-2]) / step
    return np.concatenate((inner[0] - first * beyond[::-1], inner, inner[-1] + last * beyond))


def _padded(time: np.ndarray, *arrays: np.ndarray) -> list[np.ndarray]:
    step = PADDING_TIME / _PAD
    before = time[0] - step * np.arange(_PAD, 0, -1)
    after = time[-1] + step * np.arange(1, _PAD + 1)
    return [np.concatenate((before, time, after)), *(np.pad(array, _PAD, mode="edge") for array in arrays)]


def speed_for_lean(
    lean: float, curvature: np.ndarray, gravity_left: np.ndarray, gravity_normal: np.ndarray, length: float
) -> np.ndarray:
    """Return the speeds (n,) [m/s] at which steady turns of `curvature` (n,) [1/m] need `lean` [rad], positive left.

    0 where gravity alone already asks for more, infinite where the track does not bend to the side of the lean.
    """
    y = length * np.sin(lean)
    pull = gravity_left + gravity_normal / (length * np.cos(lean)) * y
    bend = curvature - curvature**2 * y
    to_side = bend * np.sign(lean) > 1e-9
    squared = np.where(to_side, pull / np.where(to_side, bend, 1.0), np.inf)
    return np.sqrt(np.maximum(squared, 0.0))
