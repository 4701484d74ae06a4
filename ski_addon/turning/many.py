"""All that a `TurningMotion` has, of many bodies at once that were steered down one slope."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..gravity import STANDARD_GRAVITY
from .body import TurningBody
from .pace import Pace
from .steering import Steered


@dataclass(frozen=True)
class Motions:
    """m motions of n moments; as in `TurningMotion`, with a second axis for the bodies: `time` (n,); `position`,
    `heading_direction` (n, m, 3); `surface_normal` (3,) of the one slope; the others (n, m).
    """

    time: np.ndarray
    position: np.ndarray
    heading_direction: np.ndarray
    surface_normal: np.ndarray
    distance: np.ndarray
    speed: np.ndarray
    lean: np.ndarray
    lean_rate: np.ndarray
    curvature: np.ndarray
    leg_force: np.ndarray
    phase: np.ndarray


def motions_on_slope(body: TurningBody, run: Steered, pace: Pace) -> Motions:
    """Return the motions of `run` on the plane that `pace` has gravity's parts of."""
    size = np.hypot(pace.gravity_down, pace.gravity_normal)
    cosine, sine = pace.gravity_normal / size, pace.gravity_down / size
    position = np.stack((run.down * cosine, run.left, -run.down * sine), axis=-1)
    along, across = np.cos(run.course), np.sin(run.course)
    step = np.hypot(np.diff(run.down, axis=0), np.diff(run.left, axis=0))
    distance = np.zeros_like(run.down)
    np.cumsum(step, axis=0, out=distance[1:])
    gravity_left = -pace.gravity_down * across
    force = body.leg_force(run.lean, run.lean_rate, run.curvature, run.speed, pace.gravity_normal, gravity_left)
    return Motions(
        time=run.time,
        position=position,
        heading_direction=np.stack((along * cosine, across, -along * sine), axis=-1),
        surface_normal=np.array((sine, 0.0, cosine)),
        distance=distance,
        speed=run.speed,
        lean=run.lean,
        lean_rate=run.lean_rate,
        curvature=run.curvature,
        leg_force=np.hypot(*force) / STANDARD_GRAVITY,
        phase=run.phase,
    )
