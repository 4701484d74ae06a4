"""The part of a run that is baked: scene frames from the first to the last one, asked for in seconds or in frames."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SpecError
from ..frames import Array

WHOLE, SECONDS, FRAMES = "WHOLE", "SECONDS", "FRAMES"
_SLACK = 1e-4
"""How far [frames] a key may lie beyond the span and still count: seconds are seldom whole frames."""


@dataclass(frozen=True)
class FrameSpan:
    """Scene frames from `first` to `last`, both included; by default all there are."""

    first: float = -math.inf
    last: float = math.inf

    def within(self, frame: Array) -> Array:
        """Return which of `frame` (m,) lie in the span."""
        return np.asarray((frame >= self.first - _SLACK) & (frame <= self.last + _SLACK))


ALL_FRAMES = FrameSpan()


@dataclass(frozen=True)
class Part:
    """What part of a run is asked for: `begin` and `end` as seconds of the run or scene frames, as `unit` says.

    `unit` is WHOLE, SECONDS or FRAMES; in seconds an `end` of 0 stands for the end of the run.
    """

    unit: str = WHOLE
    begin: float = 0.0
    end: float = 0.0

    def span(self, rate: float, frame_start: float, duration: float) -> FrameSpan:
        """Return the frames of the part of a run of `duration` [s] from `frame_start` on, at `rate` [frames/s].

        What lies beyond the run is left out. Raises `SpecError` for a part without two frames of the run.
        """
        if self.unit == WHOLE:
            return ALL_FRAMES
        seconds = self.unit == SECONDS
        end = duration if seconds and self.end == 0.0 else self.end
        asked = f"{self.begin:g} to {end:g} {'s' if seconds else 'frames'}"
        last = frame_start + math.floor(duration * rate + 1e-6)
        there = f"0 to {duration:.1f} s" if seconds else f"frames {frame_start:g} to {last:g}"
        if end <= self.begin:
            raise SpecError("the part to bake", asked, hint="let it end later", problem="ends before it begins")
        first, final = (frame_start + rate * x for x in (self.begin, end)) if seconds else (self.begin, end)
        if final < frame_start or first > last:
            raise SpecError("the part to bake", asked, there, "choose a part within it", problem="is not in the run,")
        if min(math.floor(final + _SLACK), last) <= max(math.ceil(first - _SLACK), frame_start):
            raise SpecError("the part to bake", asked, hint="make it longer", problem="has fewer than two frames")
        return FrameSpan(first, final)
