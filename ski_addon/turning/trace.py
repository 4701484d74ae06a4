"""From what a turning body did on the map to its motion on the ground: lifted, with heading, leg force and phase."""

from __future__ import annotations

import numpy as np

from ..frames import normalized
from ..gravity import GRAVITY, STANDARD_GRAVITY
from ..terrain import Terrain
from .body import TurningBody
from .motion import TurningMotion
from .phase import estimate_phase

STILL = 1e-6
"""A support that moves less than this [m] from one moment to the next keeps its heading."""


def motion_on_ground(
    body: TurningBody,
    terrain: Terrain,
    time: np.ndarray,
    place: np.ndarray,
    lean: np.ndarray,
    lean_rate: np.ndarray,
    curvature: np.ndarray,
    speed: np.ndarray,
    phase: np.ndarray | None = None,
) -> TurningMotion:
    """Return the motion of a body whose support passes `place` (n, 2) [m, world x and y] at `time` (n,), even [s].

    `lean`, `lean_rate`, `curvature`, `speed` and `phase` (n,) are as in `TurningMotion`; without `phase` it is
    estimated afterwards [VP93 sec. 6.2]. The support lies on `terrain`, and its heading within the surface.
    """
    x, y = np.ascontiguousarray(place[:, 0], dtype=float), np.ascontiguousarray(place[:, 1], dtype=float)
    position = np.stack((x, y, terrain.height(x, y)), axis=1)
    normal = terrain.normal(x, y)
    step = np.linalg.norm(np.diff(position, axis=0), axis=1)
    heading = _heading(position, normal)
    left = np.cross(normal, heading)
    force = body.leg_force(lean, lean_rate, curvature, speed, -(normal @ GRAVITY), left @ GRAVITY)
    return TurningMotion(
        time=np.array(time, dtype=float),
        position=position,
        heading_direction=heading,
        surface_normal=normal,
        distance=np.concatenate(([0.0], np.cumsum(step))),
        speed=np.array(speed, dtype=float),
        lean=np.array(lean, dtype=float),
        lean_rate=np.array(lean_rate, dtype=float),
        curvature=np.array(curvature, dtype=float),
        leg_force=np.hypot(*force) / STANDARD_GRAVITY,
        phase=estimate_phase(time, lean, lean_rate) if phase is None else np.array(phase, dtype=float),
    )


def _heading(position: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return unit vectors (n, 3) along a path `position` (n, 3) within the surface of `normal`; while it stands still
    the last direction goes on.
    """
    along = np.gradient(position, axis=0, edge_order=2 if len(position) > 2 else 1)
    along -= np.sum(along * normal, axis=1, keepdims=True) * normal
    moving = np.linalg.norm(along, axis=1) > STILL
    if not moving.any():
        along = np.broadcast_to([1.0, 0.0, 0.0], position.shape) - normal[:, :1] * normal
        return normalized(along)
    source = np.maximum.accumulate(np.where(moving, np.arange(len(moving)), 0))
    source = np.where(moving[source], source, int(np.argmax(moving)))
    along = along[source]
    along -= np.sum(along * normal, axis=1, keepdims=True) * normal
    return normalized(along)
