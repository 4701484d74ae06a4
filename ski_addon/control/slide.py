"""Sliding along skis that are turned across the track.

Nothing drives a skier along the skis. Where they point down the track this is settled by progress: the plan is looked
up where the skier is. Skis thrown across the track to brake slide sideways over the snow in their own direction, and
there the whole plan moves along with the body; back on a track it returns.
"""

from __future__ import annotations

import numpy as np

from .dynamics import Dynamics
from .motion import Motion

STRAIGHT_COSINE, ACROSS_COSINE = 0.75, 0.40
"""Cosines of the angle between skis and track from which on progress, and up to which sliding, is all there is."""
PULL = 10.0
"""Rate [1/s] at which the plan is drawn to where the body is along the skis."""
RETURN_TIME = 1.0
"""Time [s] in which skis that point down the track again come back to it."""


def share_of_sliding(cosine: float) -> float:
    """Return 0 for skis along the track, 1 for skis across it, from the `cosine` of the angle between them."""
    x = min(max((STRAIGHT_COSINE - cosine) / (STRAIGHT_COSINE - ACROSS_COSINE), 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


class Slide:
    """Shifts the motion that is followed along the skis: `shift` (3,) [m, world]; `share` 0..1 how much they slide."""

    STATE = ("shift",)

    def __init__(self, dynamics: Dynamics, motion: Motion, time_step: float) -> None:
        """Bind to the skier and the motion; `apply` is called every `time_step` [s]."""
        self._dynamics, self._motion, self._step = dynamics, motion, time_step
        self.shift = np.zeros(3)
        self.share = 0.0
        self.active = False
        columns = motion.columns
        ski = columns["ski_position"].start
        self._places = (
            columns["com"],
            columns["track_position"],
            slice(ski, ski + 3),
            slice(ski + 3, ski + 6),
        )

    def apply(self) -> None:
        """Move the motion just read by the shift, and the shift on."""
        motion, dynamics, columns = self._motion, self._dynamics, self._motion.columns
        along = motion.value[columns["along"]]
        share = self.share = share_of_sliding(float(along @ motion.value[columns["tangent"]]))
        self.active = share > 0.0 or bool(self.shift.any())
        if not self.active:
            return
        com = columns["com"]
        behind = float(along @ (dynamics.com - motion.value[com] - self.shift))
        faster = float(along @ (dynamics.com_velocity - motion.velocity[com]))
        rate = share * (faster + PULL * behind) * along - (1.0 - share) / RETURN_TIME * self.shift
        for place in self._places:
            motion.value[place] += self.shift
            motion.velocity[place] += rate
        self.shift += self._step * rate
        if share == 0.0 and float(self.shift @ self.shift) < 1e-10:
            self.shift[:] = 0.0
