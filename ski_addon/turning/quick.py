"""The preview of gates while one of them is dragged: in a few hundredths of a second, a little less exactly.

The line past the gates is looked for from the line before, and settled to a centimetre; the track is sampled coarsely
and laid on the ground without splines; the way is ridden as it was before, as long as it is nearly as long; the run to
a stop is left out. Everything else is the preview's own.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..course.fair_line import STEEPEST, FairLine, Poles, turning_curvature
from ..course.gate_checks import check_line, check_places
from ..course.gate_settings import run_in_of, set_poles
from ..course.gates import LEAST_BEND, gate_line
from ..course.labels import label_turns
from ..course.track import Track
from ..frames import normalized
from ..planning import as_planned
from ..spec import RunSpec
from ..terrain import Terrain
from .preview import Preview, Riding, preview_track, ride_track

SPACING = 0.25
"""Distance between neighbouring places of the track [m]."""
RIDE_STEP = 0.05
"""Step [s] in which the speed is integrated."""
NEARLY = 0.03
"""Share by which the length of a way may change until its speed is worked out anew."""
TOLERANCE = 3e-3
"""When the line has settled, in sines of headings and metres."""


@dataclass(frozen=True)
class QuickPreview:
    """A `preview`, and from what the next one begins: the `line` past the gates, and how a way of so many metres, the
    `length`, was ridden.
    """

    preview: Preview
    line: FairLine
    riding: Riding
    length: float


def quick_gates(spec: RunSpec, terrain: Terrain, like: QuickPreview | None = None) -> QuickPreview:
    """Return the preview of a course of gates; `like` is the one before.

    Raises `SpecError` for a gate off the ground or out of order, or a line that cannot be, as `build_track` does; what
    else may be wrong with it only the whole preview tells.
    """
    believed = as_planned(spec)
    poles = set_poles(believed)
    check_places(believed, poles, terrain)
    line = gate_line(believed, poles, TOLERANCE, like.line if like else None)
    if not line.settled or line.steepest > STEEPEST:  # the whole preview, a moment later, checks everything
        check_line(believed, poles, line)
    track = _coarse_track(believed, poles, line, terrain)
    length = float(track.arc_length[-1])
    if like is not None and abs(length - like.length) < NEARLY * length:
        (time, arc, speed), stretch = like.riding, length / like.length
        made = Preview(preview_track(believed, track, terrain, (time, arc * stretch, speed * stretch)), None)
        return QuickPreview(made, line, like.riding, like.length)
    riding = ride_track(believed, track, RIDE_STEP)
    return QuickPreview(Preview(preview_track(believed, track, terrain, riding), None), line, riding, length)


def _coarse_track(spec: RunSpec, poles: Poles, line: FairLine, terrain: Terrain) -> Track:
    """Return the track along `line`, and before it straight from the start."""
    down, left, curvature = line.sampled(SPACING)
    turning = turning_curvature(poles, line, down)
    start = float(poles.down[0] - run_in_of(spec.course, poles.down))
    ahead = np.arange(down[0] - SPACING, start, -SPACING)[::-1]
    down, left = np.concatenate((ahead, down)), np.concatenate((np.full(len(ahead), left[0]), left))
    curvature, turning = (np.concatenate((np.zeros(len(ahead)), values)) for values in (curvature, turning))
    phase, turn = label_turns(turning, LEAST_BEND)
    x = down * np.cos(terrain.mean_angle)
    position = np.stack((x, left, terrain.height(x, left)), axis=1)
    arc = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(position, axis=0), axis=1))))
    normal = terrain.normal(x, left)
    tangent = normalized(np.gradient(position, arc, axis=0, edge_order=2))
    none = np.zeros(len(arc))
    bend = np.gradient(normal, arc, axis=0)
    return Track(
        arc_length=arc,
        position=position,
        tangent=tangent,
        surface_normal=normal,
        curvature=curvature,
        normal_curvature=-np.sum(bend * tangent, axis=1),
        torsion=none,
        phase=phase.astype(np.int8),
        turn=turn,
        start_speed=spec.course.start_speed,
    )
