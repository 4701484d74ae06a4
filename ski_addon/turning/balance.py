"""The lean that a known way of the support asks for: the one motion of the pendulum that stays bounded.

Given the way, the pendulum has a part that runs away forward in time and one that does so backward. The bounded motion
is found for the whole run at once, as in the plan: it leans before a turn begins.
"""

from __future__ import annotations

import numpy as np

from .body import TurningBody

PADDING_TIME = 1.6
"""Time [s] by which a run is extended at constant forces, so that its ends do not disturb it."""
LEAST_LOAD = 0.2
"""Share of the usual force into the ground that is kept where the ground falls away, so that a lean exists."""
STEEPEST = np.deg2rad(75.0)
"""Lean [rad] at which the iteration is held."""
CLOSE = 1e-9
"""Change of the lean [rad] at which the iteration ends."""


def balanced_lean(
    body: TurningBody,
    step: float,
    pull_left: np.ndarray,
    pull_into: np.ndarray,
    yaw_rate: np.ndarray,
    roll_change: np.ndarray | float = 0.0,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the bounded lean (n,) [rad] and its rate [rad/s] of a body whose support moves, every `step` [s].

    `pull_left` and `pull_into` (n,) [m/s^2] are gravity less the support's acceleration, to the left and into the
    ground; `yaw_rate` (n,) [rad/s] of the body about the ground's normal, `roll_change` (n,) [rad/s^2] of the ground
    under it, positive when the left side rises. [VP93 Eq. 20] with the support's own acceleration in place of its
    curvature, solved by Newton's method on second differences.
    """
    pad = int(np.ceil(PADDING_TIME / step))
    spin, roll = np.square(yaw_rate) * body.leg_length, np.broadcast_to(roll_change, len(pull_left))
    left, into, spin, roll = (np.pad(column, pad, mode="edge") for column in (pull_left, pull_into, spin, roll))
    roll[:pad] = roll[-pad:] = 0.0
    length = body.leg_length + body.inertia / body.leg_length
    lean = _newton_step(np.zeros_like(left), step, left / length + roll, into / length)
    for _ in range(30):
        lean = np.clip(lean, -STEEPEST, STEEPEST)
        sine, cosine = np.sin(lean), np.cos(lean)
        fall = (left * cosine + into * sine + spin * sine * cosine) / length + roll
        slope = (into * cosine - left * sine + spin * (cosine * cosine - sine * sine)) / length
        change = _newton_step(lean, step, fall, slope)
        lean = lean + change
        if np.max(np.abs(change)) < CLOSE:
            break
    rate = np.gradient(lean, step)
    inner = slice(pad, len(lean) - pad)
    return lean[inner], rate[inner]


def _newton_step(lean: np.ndarray, step: float, fall: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Return the change of `lean` (n,) that makes its second differences equal `fall` (n,) [rad/s^2], whose derivative
    is `slope` (n,) [1/s^2]; at both ends the one that makes `fall` vanish.
    """
    from scipy.linalg import solve_banded

    square = step * step
    bands = np.empty((3, len(lean)))
    bands[0], bands[2] = 1.0, 1.0
    bands[1] = -2.0 - square * slope
    bands[1, [0, -1]] = -square * slope[[0, -1]]
    bands[0, 1] = bands[2, -2] = 0.0
    residual = square * fall
    residual[1:-1] -= lean[2:] - 2.0 * lean[1:-1] + lean[:-2]
    return solve_banded((1, 1), bands, residual, overwrite_ab=True, overwrite_b=True, check_finite=False)
