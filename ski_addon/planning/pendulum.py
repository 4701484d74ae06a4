"""The balanced centre of mass: an inverted pendulum over the skis, planned as a boundary-value problem.

The paper leans a rigid leg by the instantaneous force balance [SG19 Eq. 7, 14], which asks for a zero-moment point
outside the stance whenever a turn changes fast. Here the sideways offset y of the centre of mass obeys

    y'' - (omega^2 + (kappa v)^2) y = g_left - kappa v^2,      omega^2 = (g_normal + h'') / h

in the frame that moves and turns with the skis (curvature kappa, speed v, height h above the snow), which is the
pendulum of [VP93 Eq. 1] written for a pivot under the middle of the skis. It has one bounded solution; it agrees with
the paper in a steady turn, tan(lean) = v^2 / (g r), and anticipates transitions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

STEEPEST = np.deg2rad(75.0)
"""Lean [rad] at which the iteration is held; a plan that needs it is refused later."""
PADDING_TIME = 1.6
"""Time [s] by which a plan is extended at constant values so that its ends do not disturb it."""


@dataclass(frozen=True)
class Pendulum:
    """Sideways offset `y` and height `h` (n,) [m] of the centre of mass over the skis, the rates of both [m/s] and
    the snow's normal force per mass `normal` [m/s^2].
    """

    y: np.ndarray
    y_rate: np.ndarray
    h: np.ndarray
    h_rate: np.ndarray
    normal: np.ndarray

    @property
    def inclination(self) -> np.ndarray:
        """Lean (n,) [rad], positive to the left."""
        return np.arctan2(self.y, self.h)


def balanced_pendulum(
    time: np.ndarray,
    curvature: np.ndarray,
    speed: np.ndarray,
    gravity_left: np.ndarray,
    gravity_normal: np.ndarray,
    length: float,
    least_load: float,
    extension: float,
) -> Pendulum:
    """Return the pendulum that is balanced along a track.

    All arrays are (n,) over `time` [s]; `gravity_left` and `gravity_normal` are gravity's parts to the left within
    the surface and into it [m/s^2]; `length` [m] is the height of the centre of mass of the upright stance,
    `least_load` the least normal force in units of the skier's own, `extension` [m] how far the legs may lengthen.
    """
    from scipy.ndimage import gaussian_filter1d

    time, curvature, speed, gravity_left, gravity_normal = _padded(time, curvature, speed, gravity_left, gravity_normal)
    h = np.full_like(time, length)
    normal = gravity_normal.copy()
    y = np.zeros_like(time)
    smoothing = 0.0
    step = float(np.median(np.diff(time)))
    for _ in range(60):
        solved = _bounded_solution(time, normal / h + (curvature * speed) ** 2, gravity_left - curvature * speed**2)
        solved = np.clip(solved, -length * np.sin(STEEPEST), length * np.sin(STEEPEST))
        change = float(np.max(np.abs(solved - y)))
        y = y + 0.6 * (solved - y)  # the undamped iteration alternates when the lean is large
        rigid = np.sqrt(length**2 - y**2)
        if smoothing:
            room = np.sqrt((length + extension) ** 2 - y**2)
            h = np.minimum(gaussian_filter1d(rigid, smoothing / step, mode="nearest"), room)
            h = gaussian_filter1d(h, 0.03 / step, mode="nearest")
        else:
            h = rigid
        vertical = second_derivative(time, h)
        normal = np.maximum(gravity_normal + vertical, 0.05 * gravity_normal)
        if change < 1e-7:
            load = np.min((gravity_normal + vertical) / gravity_normal)
            if load >= least_load or smoothing > 0.6:
                break
            smoothing = max(1.25 * smoothing, 0.04)
    y_rate, h_rate = derivative(time, y), derivative(time, h)
    inner = slice(_PAD, -_PAD)
    return Pendulum(y[inner], y_rate[inner], h[inner], h_rate[inner], (gravity_normal + vertical)[inner])


_PAD = 320


def _padded(time: np.ndarray, *arrays: np.ndarray) -> list[np.ndarray]:
    step = PADDING_TIME / _PAD
    before = time[0] - step * np.arange(_PAD, 0, -1)
    after = time[-1] + step * np.arange(1, _PAD + 1)
    return [np.concatenate((before, time, after)), *(np.pad(array, _PAD, mode="edge") for array in arrays)]


def _bounded_solution(time: np.ndarray, stiffness: np.ndarray, forcing: np.ndarray) -> np.ndarray:
    """Solve y'' - stiffness y = forcing on uneven `time` with the steady value at both ends (three diagonals)."""
    from scipy.linalg import solve_banded

    before, after = np.diff(time)[:-1], np.diff(time)[1:]
    lower, upper = 2.0 / (before * (before + after)), 2.0 / (after * (before + after))
    bands = np.zeros((3, len(time)))
    bands[0, 2:] = upper
    bands[1, 1:-1] = -(lower + upper) - stiffness[1:-1]
    bands[2, :-2] = lower
    bands[1, [0, -1]] = -stiffness[[0, -1]]
    return solve_banded((1, 1), bands, forcing)


def derivative(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return d values / d time (n,), second order on uneven `time`."""
    return np.gradient(values, time, edge_order=2)


def second_derivative(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the second derivative (n,) on uneven `time`; the ends repeat their neighbours."""
    before, after = np.diff(time)[:-1], np.diff(time)[1:]
    slope = np.diff(values) / np.diff(time)
    inner = 2.0 * np.diff(slope) / (before + after)
    return np.concatenate((inner[:1], inner, inner[-1:]))


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
