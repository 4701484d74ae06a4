"""Small scenes to follow a path in."""

from __future__ import annotations

import math

import numpy as np

from ski_addon.turning.body import TurningBody
from ski_addon.turning.following import (
    DISC,
    LINE,
    Obstacle,
    Obstacles,
    Problem,
    SearchSettings,
    hermite_path,
    lane_on_flat,
)


def disc(x: float, y: float, radius: float = 0.35, tolerance: float = 0.4, name: str = "tree") -> Obstacle:
    return Obstacle(DISC, np.array([[x, y]]), radius, tolerance, name)


def wall(*points: tuple[float, float], tolerance: float = 0.3, name: str = "wall") -> Obstacle:
    return Obstacle(LINE, np.array(points, dtype=float), 0.0, tolerance, name)


def scene(
    points: list[tuple[float, float]],
    obstacles: tuple[Obstacle, ...] = (),
    speed: float = 8.0,
    rate: float = 0.3,
    **settings: float,
) -> Problem:
    body = TurningBody(curvature_bound=0.3, curvature_rate_bound=rate)
    lane = lane_on_flat(hermite_path(np.array(points, dtype=float)), speed)
    return Problem(body, lane, Obstacles.of(obstacles), SearchSettings(**settings))


def sine(rate: float = 0.3, obstacles: tuple[Obstacle, ...] = (), **settings: float) -> Problem:
    """A path of waves of 1 m by 20 m at 8 m/s."""
    return scene([(x, math.sin(0.1 * math.pi * x)) for x in range(0, 62, 5)], obstacles, rate=rate, **settings)
