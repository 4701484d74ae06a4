"""Where the turns of a timeline are."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..frames import Array

if TYPE_CHECKING:
    from .ride import Timeline


def turn_starts(timeline: Timeline) -> Array:
    """Return the indices at which the skis change edges: where the sign of the turn phase changes."""
    sign = np.sign(np.where(np.abs(timeline.turn_phase) < 0.05, 0.0, timeline.turn_phase))
    known = np.flatnonzero(sign)
    change = np.flatnonzero(np.diff(sign[known]))
    return (known[change] + known[change + 1]) // 2


def turn_apexes(timeline: Timeline) -> dict[str, int]:
    """Return the indices of the apex of a left and a right turn and of the transition between them, mid-run."""
    starts = turn_starts(timeline)
    phase = np.asarray(timeline.turn_phase)
    middle = starts[len(starts) // 2] if len(starts) else len(phase) // 2
    edges = [0, *starts.tolist(), len(phase)]
    at = edges.index(middle) if middle in edges else 0
    before = slice(edges[max(at - 1, 0)], middle)
    after = slice(middle, edges[min(at + 1, len(edges) - 1)])
    found = {"transition": int(middle)}
    for part in (before, after):
        if part.stop > part.start:
            index = part.start + int(np.argmax(np.abs(phase[part])))
            # the middle of the stretch of full curvature
            full = part.start + np.flatnonzero(np.abs(phase[part]) > 0.98 * np.abs(phase[index]))
            found["left" if phase[index] > 0 else "right"] = int(full[len(full) // 2])
    return found
