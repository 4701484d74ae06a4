"""How far the cranks have turned: by the way on the straights, held with the inside pedal up in sharp turns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .vectors import Array

SHARP = np.deg2rad(13.0)
"""Tilt of a steady turn from which the inside pedal is held up."""
SHORTEST, RAMP = 0.6, 1.2
"""Turns shorter than this [m] are pedalled through, gaps as short are no gaps; way [m] in which the cranks speed up."""
QUICKEST = 2.5
"""The cranks turn this much faster than usual at most, from a turn to one to the other side that follows closely."""
LEFT_UP = -0.5 * np.pi
"""Angle of the cranks at which the left pedal is up; half a turn later it is the right one."""


@dataclass(frozen=True)
class _Turn:
    """A sharp turn between two places of the way [m]; `left` says to which side."""

    start: float
    end: float
    left: bool


def crank_angle(way: Array, knots: Array, tilt: Array, development: float, coasting: bool) -> Array:
    """Return the angle (...) [rad] of the cranks after `way` (...) [m]: 0 with the left arm ahead, forward positive.

    `tilt` (n,) [rad] is that of a steady turn at `knots` (n,) [m] of the way; `development` [m] the way of a whole turn
    of the cranks. A cyclist who is `coasting` holds the inside pedal up in sharp turns, and in between pedals a little
    faster or slower than the development says, never backward.
    """
    usual = 2.0 * np.pi / development
    turns = _apart(_sharp_turns(knots, tilt), development / QUICKEST) if coasting else []
    if not turns:
        return usual * (way - knots[0])
    held = _held(turns, usual * (turns[0].start - float(knots[0])), usual)
    out = held[0] - usual * _started(turns[0].start - way)
    for index, turn in enumerate(turns):
        if index:
            before, rise = turns[index - 1].end, held[index] - held[index - 1]
            out = np.where(way > before, held[index - 1] + rise * _eased(way, before, turn.start), out)
        out = np.where(way >= turn.start, held[index], out)
    return np.where(way > turns[-1].end, held[-1] + usual * _started(way - turns[-1].end), out)


def _apart(turns: list[_Turn], gap: float) -> list[_Turn]:
    """Return `turns` held so much shorter that there is a `gap` [m] to pedal in between them; too short ones go."""
    kept: list[_Turn] = []
    for index, turn in enumerate(turns):
        before = turn.start - turns[index - 1].end if index else gap
        after = turns[index + 1].start - turn.end if index + 1 < len(turns) else gap
        start = turn.start + 0.5 * max(gap - before, 0.0)
        end = turn.end - 0.5 * max(gap - after, 0.0)
        if end - start > 0.5 * SHORTEST:
            kept.append(_Turn(start, end, turn.left))
    return kept


def _held(turns: list[_Turn], first: float, usual: float) -> list[float]:
    """Return the angles [rad] held in `turns`: the nearest to what is pedalled between them, never backward."""
    held: list[float] = []
    for index, turn in enumerate(turns):
        wanted = first if not index else held[-1] + usual * (turn.start - turns[index - 1].end)
        inside = LEFT_UP + (0.0 if turn.left else np.pi)
        angle = inside + 2.0 * np.pi * round((wanted - inside) / (2.0 * np.pi))
        held.append(angle + 2.0 * np.pi if held and angle < held[-1] - 1e-9 else angle)
    return held


def _started(way: Array) -> Array:
    """Return the `way` (...) [m] less what the cranks are behind after they started to turn at 0."""
    way = np.maximum(way, 0.0)
    return np.where(way < RAMP, np.square(way) / (2.0 * RAMP), way - 0.5 * RAMP)


def _sharp_turns(knots: Array, tilt: Array) -> list[_Turn]:
    """Return the sharp turns in order; those that follow closely to the same side are one."""
    found: list[_Turn] = []
    for left in (True, False):
        sharp = np.concatenate(([False], (tilt if left else -tilt) > SHARP, [False]))
        edges = np.flatnonzero(np.diff(sharp.astype(int)))
        spans = [(float(knots[a]), float(knots[b - 1])) for a, b in zip(edges[::2], edges[1::2], strict=True)]
        joined: list[tuple[float, float]] = []
        for start, end in spans:
            if joined and start - joined[-1][1] < SHORTEST:
                joined[-1] = (joined[-1][0], end)
            else:
                joined.append((start, end))
        found += [_Turn(start, end, left) for start, end in joined if end - start > SHORTEST]
    return sorted(found, key=lambda turn: turn.start)


def _eased(way: Array, start: float, end: float) -> Array:
    """Return 0 at `start` and 1 at `end` [m] of the `way`, with an even rise between ramps."""
    length = max(end - start, 1e-9)
    ramp = min(0.5, RAMP / length)
    u = np.clip((way - start) / length, 0.0, 1.0)
    rise = np.where(u < ramp, np.square(u) / (2.0 * ramp), u - 0.5 * ramp)
    rise = np.where(u > 1.0 - ramp, (1.0 - ramp) - np.square(1.0 - u) / (2.0 * ramp), rise)
    return rise / (1.0 - ramp)
