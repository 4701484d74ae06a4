"""Which moments of a run a picture shows and from where, so that it shows the point of the course."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..frames import Array
from .turns import turn_starts

if TYPE_CHECKING:
    from ..spec import RunSpec
    from .ride import Timeline

TURNS_SHOWN = 2.0
"""Turns a picture of turns shows: from the apex of one to that of the next but one."""
SHORT_TURNS_SHOWN = 3.0
"""Turns round moguls and slalom gates follow each other closely."""
RHYTHM_SHOWN = 4.0
"""Swings of a rhythm are many and quick."""
WAVES_SHOWN = 1.1
"""Waves of bumps a picture shows, from trough to crest and on."""
FOLLOWED = 45.0
"""Length of a followed path that is shown [m]."""
STOP_SHOWN = 3.0
"""The last seconds of a stop that are shown [s]."""
STANDING = 0.25
"""Slower than this the skier stands [m/s]."""


@dataclass(frozen=True)
class View:
    """Moments `time` (m,) [s after the start] and the camera that shows them.

    `azimuth_deg` is where the camera stands, from the direction of the skier's way (0 is ahead, 90 is on the left),
    `height_deg` over the slope's plane along that way; `sun_deg` where the sun stands, from the same direction, and
    `sun_height_deg` over the horizon; `lens` [mm]; `headroom` [m] of what is to be seen over the highest skier; `lift`
    moves what is shown up by that share of half the picture.
    """

    time: Array
    azimuth_deg: float = -12.0
    height_deg: float = 15.0
    sun_deg: float = 100.0
    sun_height_deg: float = 24.0
    lens: float = 30.0
    headroom: float = 7.0
    lift: float = 0.0


def choose_view(timeline: Timeline, spec: RunSpec, instants: int, *, stop: bool = False) -> View:
    """Return the view of `timeline` that suits its course, with `instants` moments; with `stop` that of its end."""
    course = spec.course
    if stop:
        times = stop_times(timeline, instants)
        return View(times, 35.0, 13.0, sun_deg=120.0, lens=40.0, headroom=3.0)
    if course.kind == "bumps" and course.turn_amplitude == 0.0:
        wave = {"bumps": 2.0 * spec.slope.bump_width, "moguls": spec.slope.mogul_spacing}.get(spec.slope.kind, 15.0)
        times = middle_times(timeline, instants, WAVES_SHOWN * wave)
        return View(times, 75.0, 5.0, sun_deg=25.0, sun_height_deg=13.0, lens=50.0, headroom=0.3, lift=-0.3)
    if course.kind == "bumps":
        times = turn_times(timeline, instants, SHORT_TURNS_SHOWN)
        return View(times, 28.0, 17.0, sun_deg=95.0, sun_height_deg=14.0, lens=45.0, headroom=1.0)
    if course.kind == "rhythm":
        return View(turn_times(timeline, instants, RHYTHM_SHOWN), -22.0, 20.0, headroom=3.0)
    if course.kind == "follow":  # from above, over what is gone round
        times = middle_times(timeline, instants, FOLLOWED)
        return View(times, 24.0, 27.0, sun_deg=100.0, sun_height_deg=32.0, lens=40.0, headroom=1.5)
    if course.kind == "gates":
        turns = TURNS_SHOWN if course.gate_setting == "giant_slalom" else SHORT_TURNS_SHOWN
        times = turn_times(timeline, instants, turns, from_apex=False)  # gates are seen between skiers
        return View(times, -33.0, 14.0, sun_deg=80.0, lens=40.0, headroom=2.5)
    return View(turn_times(timeline, instants, TURNS_SHOWN))


def turn_times(timeline: Timeline, instants: int, turns: float = TURNS_SHOWN, *, from_apex: bool = True) -> Array:
    """Return `instants` times [s] evenly over about `turns` turns in the middle of `timeline`.

    They begin where a turn is half over, or where the edges change.
    """
    clock = np.asarray(timeline.time) - timeline.time[0]
    edges = np.array([0.0, *clock[turn_starts(timeline)], clock[-1]])
    shown = min(turns, len(edges) - 1.0)
    first = np.floor(0.5 * (len(edges) - 1.0 - shown)) + 0.5 * (from_apex and shown < len(edges) - 1.0)
    first = min(first, len(edges) - 1.0 - shown)
    low, high = np.interp((first, first + shown), np.arange(len(edges)), edges)
    return np.linspace(low, high, instants)


def middle_times(timeline: Timeline, instants: int, length: float) -> Array:
    """Return `instants` times [s] evenly over `length` [m] of the way in the middle of `timeline`."""
    clock = np.asarray(timeline.time) - timeline.time[0]
    travelled = np.asarray(timeline.arc_length) - timeline.arc_length[0]
    shown = min(length, float(travelled[-1]))
    low = 0.5 * (travelled[-1] - shown)
    ends = np.searchsorted(travelled, (low, low + shown)).clip(0, len(clock) - 1)
    return np.linspace(clock[ends[0]], clock[ends[1]], instants)


def stop_times(timeline: Timeline, instants: int) -> Array:
    """Return up to `instants` times [s] over the last seconds before the skier stands, spaced so as not to overlap."""
    clock = np.asarray(timeline.time) - timeline.time[0]
    moving = np.flatnonzero(np.asarray(timeline.speed) > STANDING)
    end = min(int(moving[-1]) + 1, len(clock) - 1) if len(moving) else len(clock) - 1
    begin = int(np.searchsorted(clock, clock[end] - STOP_SHOWN))
    travelled = np.asarray(timeline.arc_length)
    wanted = np.linspace(travelled[begin], travelled[end], instants)
    return np.unique(clock[np.searchsorted(travelled, wanted).clip(begin, end)])


def way(timeline: Timeline, time: Array) -> tuple[float, float]:
    """Return azimuth (0 is +x, 90 is +y) and descent [deg] of the straight line from the first to the last `time`."""
    clock = np.asarray(timeline.time) - timeline.time[0]
    first, last = (timeline.track_position[np.searchsorted(clock, t)] for t in (time[0], time[-1] - 1e-9))
    x, y, z = np.asarray(last - first)
    return float(np.degrees(np.arctan2(y, x))), float(np.degrees(np.arctan2(-z, np.hypot(x, y))))
