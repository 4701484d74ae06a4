"""Numbers of an instant motion to see in a graph or to drive something with."""

from __future__ import annotations

import numpy as np

from ...animation.poses import Channel
from ...spec import RunSpec
from ..motion import TurningMotion
from .model import FigureModel


def figure_channels(figure: FigureModel, spec: RunSpec, motion: TurningMotion, time: np.ndarray) -> tuple[Channel, ...]:
    """Return the numbers of `motion` at `time` (m,) [s] since its start; angles in degrees, positive to the left.

    `turn_phase` runs from -1 (right) to 1 (left), as that of a recording does.
    """
    degrees = np.degrees
    rows = (
        ("speed", "Speed of the centre of mass", "m/s", motion.speed),
        ("inclination", "Lean of the body, positive to the left", "deg", degrees(motion.lean)),
        ("lean_rate", "How fast the lean changes", "deg/s", degrees(motion.lean_rate)),
        ("curvature", "Curvature of the track, positive to the left", "1/m", motion.curvature),
        ("leg_force", "Force along the legs, in body weights", "", motion.leg_force),
        ("turn_phase", "Where in the turn: 1 = full left turn, -1 = full right turn", "", np.sin(motion.phase)),
    )
    clock = motion.time - motion.time[0]
    return tuple(Channel(name, doc, unit, np.interp(time, clock, values)) for name, doc, unit, values in rows)
