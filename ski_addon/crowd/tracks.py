"""Where a skier is when, in steps of time coarse enough to keep for a whole crowd, and how near two of them come."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

STEP = 0.1
"""Time between two places [s]; between them a skier is taken to move straight on."""


@dataclass(frozen=True)
class Way:
    """A skier's centre of mass: `place` (n, 3) [m, run frame] every `STEP` from the start, and `duration` [s]."""

    place: np.ndarray
    duration: float

    def __post_init__(self) -> None:
        self.place.setflags(write=False)


def way_of(time: np.ndarray, place: np.ndarray, duration: float) -> Way:
    """Return the way of someone who is at `place` (m, 3) at `time` (m,) [s]; a plan or a recording has both."""
    moments = np.arange(max(int(np.ceil(duration / STEP)), 1) + 1) * STEP  # the last is the end or just past it
    return Way(np.stack([np.interp(moments, time, column) for column in place.T], axis=1), float(duration))


def on_clock(way: Way, start: float, linger: float) -> tuple[int, np.ndarray]:
    """Return where someone who starts at `start` [s] is on the crowd's clock.

    A whole number i of steps, and places (m, 3) at the times i, i + 1, ... steps: from less than a step before the
    start, as if skiing already, until less than a step after `linger` [s] past the end, while the skier stands there.
    Who does not linger is taken to ski on for that rest of a step.
    """
    first = int(np.floor(start / STEP + 1e-9))
    last = max(int(np.ceil((start + way.duration + linger) / STEP - 1e-9)), first + 1)
    moments = (np.arange(first, last + 1) * STEP - start) / STEP
    own = np.arange(len(way.place))
    place = np.stack([np.interp(moments, own, column) for column in way.place.T], axis=1)
    place[0] += min(float(moments[0]), 0.0) * (way.place[1] - way.place[0])
    if linger < STEP and len(place) > 2:
        place[-1] = 2.0 * place[-2] - place[-3]
    return first, place


def least_distance(apart: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the least length (...) [m] of differences of place `apart` (..., m, 3), and the step it is nearest after.

    Between two steps the difference is taken to change evenly. Steps with NaN do not count; with none that counts the
    length is infinite.
    """
    before, change = apart[..., :-1, :], np.diff(apart, axis=-2)
    squared = np.sum(change * change, axis=-1)
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(squared > 0.0, -np.sum(before * change, axis=-1) / squared, 0.0)
    nearest = before + np.clip(share, 0.0, 1.0)[..., None] * change
    length = np.sqrt(np.sum(nearest * nearest, axis=-1))
    length = np.where(np.isnan(length), np.inf, length)
    if not length.shape[-1]:
        return np.full(length.shape[:-1], np.inf), np.zeros(length.shape[:-1], dtype=int)
    return length.min(axis=-1), length.argmin(axis=-1)
