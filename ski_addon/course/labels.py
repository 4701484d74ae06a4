"""Naming the parts of a curve: turns to the left and right, transitions between them, and their numbers."""

from __future__ import annotations

import numpy as np

SHARE = 0.5
"""Within a turn curvature is at least this share of its tightest."""


def label_turns(curvature: np.ndarray, least: float) -> tuple[np.ndarray, np.ndarray]:
    """Return `phase` (n,) int8 and `turn` (n,) of a curve with `curvature` (n,) [1/m], as in `Track`.

    A stretch that bends to one side is a turn if it somewhere bends by at least `least` [1/m]; slighter bends are part
    of the transition. The turn lasts from the first to the last place that has half of its tightest curvature.
    """
    sign = np.sign(curvature)
    bounds = np.concatenate(([0], np.flatnonzero(np.diff(sign)) + 1, [len(sign)]))
    phase, number = np.zeros(len(sign), dtype=np.int8), np.zeros(len(sign), dtype=int)
    count, side = 0, 0.0
    for begin, end in zip(bounds, bounds[1:], strict=False):
        bend = np.abs(curvature[begin:end])
        if bend.max() < least:
            continue
        inside = begin + np.flatnonzero(bend >= SHARE * bend.max())[[0, -1]]
        again = sign[begin] == side  # the same turn goes on after a slight bend to the other side
        count, side = count + (not again), sign[begin]
        phase[inside[0] : inside[1] + 1] = int(side)
        number[inside[0]] = count
    return phase, np.maximum(np.maximum.accumulate(number), 1)
