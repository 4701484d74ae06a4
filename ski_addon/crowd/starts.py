"""When everybody starts, and on which line: so that no two of the planned ways come nearer than they should."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from .crowd_spec import CrowdSpec
from .members import wanted_offsets, wanted_start
from .tracks import STEP, Way, least_distance, on_clock

DELAY_STEP = 0.2
"""About how much later [s] a start is tried next."""


@dataclass(frozen=True)
class Nearest:
    """How near somebody comes to another: `distance` [m], to the member `index`, at `time` [s] of the crowd."""

    distance: float
    index: int
    time: float


@dataclass(frozen=True)
class Start:
    """When a member starts [s], by how much that is later than wanted [s], and on which line [m to the left]."""

    time: float
    delay: float
    offset: float


@dataclass(frozen=True)
class NoRoom:
    """A member for whom there is no start: `nearest` is the best that could be had of all of them."""

    nearest: Nearest


class Slope:
    """Who is where on the slope so far, on the crowd's clock."""

    def __init__(self, linger: float) -> None:
        self._linger = linger
        self._there: dict[int, tuple[int, np.ndarray]] = {}

    def add(self, index: int, way: Way, start: Start) -> None:
        """Put the member `index` on the slope."""
        first, place = on_clock(way, start.time, self._linger)
        self._there[index] = first, place + (0.0, start.offset, 0.0)

    def nearest(self, way: Way, time: float, offsets: np.ndarray, but: int | None = None) -> list[Nearest | None]:
        """Return how near somebody on `way` who starts at `time` [s] would come to the others, for lines (k,) [m].

        None where nobody else is on the slope meanwhile; the member `but` is not counted.
        """
        first, place = on_clock(way, time, self._linger)
        there = [index for index, (at, other) in self._there.items() if index != but and _meet(first, place, at, other)]
        if not there:
            return [None] * len(offsets)
        others = np.full((len(there), len(place), 3), np.nan)
        for row, index in enumerate(there):
            at, other = self._there[index]
            begin, end = max(at, first), min(at + len(other), first + len(place))
            others[row, begin - first : end - first] = other[begin - at : end - at]
        found: list[Nearest | None] = []
        for offset in offsets:
            length, step = least_distance(place + (0.0, offset, 0.0) - others)
            row = int(np.argmin(length))
            found.append(Nearest(float(length[row]), there[row], (first + int(step[row])) * STEP))
        return found


def find_starts(crowd: CrowdSpec, ways: Mapping[int, Way], frame_rate: float) -> dict[int, Start | NoRoom]:
    """Return the start of every member with a way: the first one, in turn, that keeps it apart from those before it.

    Starts are whole frames at `frame_rate` [1/s]. That of a member depends on those before it only.
    """
    slope, found = Slope(crowd.crowd.linger), dict[int, Start | NoRoom]()
    for index in sorted(ways):
        made = _find_start(crowd, index, ways[index], slope, frame_rate)
        if isinstance(made, Start):
            slope.add(index, ways[index], made)
        found[index] = made
    return found


def real_nearest(ways: Mapping[int, Way], starts: Mapping[int, Start], linger: float) -> dict[int, Nearest | None]:
    """Return for every member how near it comes to another, from the ways that were skied."""
    slope = Slope(linger)
    for index, way in ways.items():
        slope.add(index, way, starts[index])
    return {
        index: slope.nearest(way, starts[index].time, np.array([starts[index].offset]), but=index)[0]
        for index, way in ways.items()
    }


def least(found: Sequence[Nearest | None]) -> Nearest | None:
    """Return the nearest of all, or None if nobody meets anybody."""
    return min((one for one in found if one is not None), key=lambda one: one.distance, default=None)


def _find_start(crowd: CrowdSpec, index: int, way: Way, slope: Slope, frame_rate: float) -> Start | NoRoom:
    first = round(wanted_start(crowd, index) * frame_rate)
    step = max(round(DELAY_STEP * frame_rate), 1)
    offsets, best = wanted_offsets(crowd, index), None
    for delay in range(0, math.floor(crowd.crowd.delay_max * frame_rate) + 1, step):
        time = (first + delay) / frame_rate
        met = slope.nearest(way, time, offsets)
        for offset, nearest in zip(offsets, met, strict=True):
            if nearest is None or nearest.distance >= crowd.crowd.apart:
                return Start(time, delay / frame_rate, float(offset))
            best = nearest if best is None or nearest.distance > best.distance else best
    if best is None:  # no delay was tried at all, which a range from 0 never is
        return Start(first / frame_rate, 0.0, float(offsets[0]))
    return NoRoom(best)


def _meet(first: int, place: np.ndarray, at: int, other: np.ndarray) -> bool:
    return at < first + len(place) and first < at + len(other)
