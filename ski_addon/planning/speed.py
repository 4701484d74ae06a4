"""Speed along the track, with snow friction and air drag.

The paper plans without friction and then meets its own snow's, so that plan and physics part. Here gravity, friction
and drag act on the centre of mass, which runs on a smaller circle than the skis when it leans into a turn:
its speed is u = v (1 - kappa y), and u' = a + y' kappa v.
"""

from __future__ import annotations

import numpy as np

from ..snow import Snow
from .pendulum import Pendulum


def plan_speed(
    arc_length: np.ndarray,
    curvature: np.ndarray,
    gravity_along: np.ndarray,
    pendulum: Pendulum,
    snow: Snow,
    start_speed: float,
) -> np.ndarray:
    """Return the skis' speed (n,) [m/s] by `arc_length` (n,) [m], starting with `start_speed` at the skis.

    `gravity_along` (n,) [m/s^2] is gravity's part along the track. Integrated by Heun's method in u^2 / 2; where the
    skier would stop the speed is held at zero, for the caller to see.
    """
    inside = 1.0 - curvature * pendulum.y
    drift = pendulum.y_rate * curvature
    normal = pendulum.normal
    steps = np.diff(arc_length)
    speed = np.zeros_like(arc_length)
    speed[0] = start_speed

    def gain(i: int, v: float) -> float:
        """d(u^2 / 2) / ds = u u' / v."""
        return inside[i] * (snow.glide_acceleration(gravity_along[i], normal[i], v) + drift[i] * v)

    energy = 0.5 * (start_speed * inside[0]) ** 2
    for i, step in enumerate(steps):
        first = gain(i, speed[i])
        guess = np.sqrt(max(2.0 * (energy + step * first), 0.0)) / inside[i + 1]
        energy += 0.5 * step * (first + gain(i + 1, guess))
        if energy <= 0.0:
            break
        speed[i + 1] = np.sqrt(2.0 * energy) / inside[i + 1]
    return speed


def travel_time(arc_length: np.ndarray, speed: np.ndarray) -> np.ndarray:
    """Return the time (n,) [s] at which each place is passed, from 0."""
    steps = np.diff(arc_length) * 2.0 / (speed[1:] + speed[:-1])
    return np.concatenate(([0.0], np.cumsum(steps)))
