"""What a rhythm cannot be: ellipses beyond the bounds, directions that are never reached, speed that is used up."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from .body import TurningBody
from .pace import Pace
from .steering import FELL, RUNNING, HalfSwing, Steered

OFF_COURSE = math.radians(6.0)
"""A half swing that misses its direction by more than this [rad] counts as off course."""
PATIENCE = 8
"""So many half swings may be off course one after the other: a great change of direction is spread over them."""
NEAR = 1.02
"""Share of a bound that an ellipse may exceed it by."""


@dataclass(frozen=True)
class Verdict:
    """From the moment `index` on a rhythm cannot be made, for this `reason`."""

    index: int
    reason: str


def peak_curvature(body: TurningBody, pace: Pace, frequency: float, sharpness: float, speed: float) -> float:
    """Return the greatest curvature [1/m] of a swing, which it has at its greatest lean."""
    acceleration = np.array(-frequency * frequency * sharpness)
    return float(body.curvature_for(np.array(sharpness), acceleration, speed, pace.gravity_normal))


def first_trouble(body: TurningBody, pace: Pace, run: Steered) -> Verdict | None:
    """Return the first thing that cannot be in the run of one body, or None."""
    off = 0
    for turn in run.turns:
        verdict = _beyond_bounds(body, pace, turn)
        if verdict is not None:
            return verdict
        off = off + 1 if abs(turn.missed[0]) > OFF_COURSE else 0
        if off > PATIENCE:
            return _off_course(turn)
    if run.ended[0] == RUNNING:
        return None
    return _ended(run)


def _beyond_bounds(body: TurningBody, pace: Pace, turn: HalfSwing) -> Verdict | None:
    """Return what is wrong with the ellipse that is asked for, as it would be if beta were 1."""
    w, a, speed = float(turn.frequency[0]), float(turn.sharpness[0]), float(turn.speed[0])
    bend, most = peak_curvature(body, pace, w, a, speed), float(body.curvature_bound)
    change, quickest = bend * w, float(body.curvature_rate_bound)
    asked = f"a lean of {math.degrees(a):.1f} degrees in swings of {2.0 * math.pi / w:.2f} s at {speed:.1f} m/s"
    if bend > NEAR * most:
        works = _less(lambda share: peak_curvature(body, pace, w, share * a, speed) <= most)
        reason = (
            f"{asked} needs turns of {1.0 / bend:.2f} m radius, tighter than course.tightest_radius = {1.0 / most:g} m"
        )
    elif change > NEAR * quickest:
        works = _less(lambda share: peak_curvature(body, pace, w, share * a, speed) * w <= quickest)
        bound = f"more than course.steering_rate = {quickest:g}"
        reason = f"{asked} needs the curvature to change by {change:.2f} 1/m/s, {bound}"
    else:
        return None
    lean = math.floor(math.degrees(works * a) * 10.0) / 10.0
    return Verdict(turn.index, f"{reason} (lean {lean:.1f} degrees, swing more slowly or ski faster)")


def _less(works: Callable[[float], bool]) -> float:
    """Return the largest share up to 1 that works."""
    low, high = 0.0, 1.0
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if works(middle) else (low, middle)
    return low


def _off_course(turn: HalfSwing) -> Verdict:
    missed = math.degrees(float(turn.missed[0] * turn.side[0]))
    side = "left" if missed > 0.0 else "right"
    reason = (
        f"the direction is still {abs(missed):.0f} degrees off to reach the heading further {side}, after {PATIENCE} "
        "turns that were changed as much as they can be (change the heading less or over more time, or lean more)"
    )
    return Verdict(turn.index, reason)


def _ended(run: Steered) -> Verdict:
    index = int(run.last[0])
    speed = float(run.speed[index, 0])
    if run.ended[0] == FELL:
        reason = (
            f"the body leans past 75 degrees at {speed:.1f} m/s, for the track cannot turn under it fast enough (lean "
            "less, swing more slowly, ski faster, or allow a smaller course.tightest_radius)"
        )
        return Verdict(index, reason)
    hint = "make the slope steeper, lower snow.friction, start faster, head more down the fall line, or hold the pace"
    return Verdict(index, f"only {speed:.1f} m/s are left, too slow to steer: {hint}")
