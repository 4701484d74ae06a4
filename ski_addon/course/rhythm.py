"""Courses by rhythm as a track: the way of a body that swings, laid on the ground [VP93 sec. 5, 8].

The paper ends with the idea to use such motions as set-points for a complete physical model. This is it: the track goes
to the plan and the whole-body controller like any other.
"""

from __future__ import annotations

import numpy as np

from ..spec import RunSpec
from ..terrain import Terrain
from .labels import label_turns
from .smoothing import curvature, interpolated, smoothed
from .surface import track_on_surface
from .track import Track

LEAST_TURN, TURN_SHARE = 0.02, 0.35
"""Curvature [1/m] from which on a bend counts as a turn, and the share of the tightest one; the lesser of both."""
ROUNDING = 0.8
"""Length [m] over which corners of the curvature are rounded, where one controlling ellipse gives way to the next: a
body with joints would feel each as a jolt. Of a swing 12 m long that takes half a percent.
"""


def build_rhythm_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return the track of a body that keeps to the `[[rhythm]]` rows of `spec`.

    Raises `SpecError` for rows that are none and `PlanInfeasible` for a rhythm that cannot be kept.
    """
    from ..turning.rhythm import run_rhythm  # the turning body's speed is planned as a skier's, along a track

    made = run_rhythm(spec, terrain.mean_angle)
    if made.problem is not None:
        raise made.problem
    run = made.run
    path = smoothed(interpolated(np.stack((run.down[:, 0], run.left[:, 0]), axis=1)), ROUNDING)
    bend = curvature(path)
    phase, turn = label_turns(bend, min(LEAST_TURN, TURN_SHARE * float(np.max(np.abs(bend)))))
    down, left = np.ascontiguousarray(path.T)
    return track_on_surface(terrain, down, left, phase, turn, spec.course.start_speed)
