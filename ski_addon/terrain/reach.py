"""Whether legs can take up bumps or moguls, and what would work where they cannot."""

from __future__ import annotations

import dataclasses
import math

from ..errors import SpecError
from ..gravity import STANDARD_GRAVITY
from ..spec import SlopeSpec
from .build import build_relief
from .bumps import bump_angle

STEEPEST_SIDE = math.radians(40.0)
"""Nobody stands over sides that are steeper than this against the slope [rad]."""
_LOWEST = 2  # centimetres
_SIDES = {"bumps": "arcs meet at", "moguls": "sides stand at"}


def check_bumps(slope: SlopeSpec, leg_travel: float, speed: float | None = None, absorption: float = 1.0) -> None:
    """Raise `SpecError` if the bumps or moguls of `slope` are more than a skier can take; other ground is fine.

    `leg_travel` [m] is the way from the most bent to the longest leg, `speed` [m/s] the fastest over the bumps (None
    if it is not known), `absorption` (0..1) the share of the ground's rise and fall that the legs take up; the body
    keeps the rest. The legs must reach, no crest may throw the skier off, and the sides must not be too steep to stand
    over. The line says what the ground asks and which height, or speed where that is the trouble, would work.
    """
    if slope.kind not in _SIDES or _share(slope, leg_travel, speed, absorption) <= 1.0:
        return
    radius, side, rise = _shape(slope)
    problem = (
        f"is more than a skier can take: {_SIDES[slope.kind]} {math.degrees(side):.1f} degrees, crests throw stiff "
        f"legs off the snow above {_take_off(slope, radius, 0.0):.1f} m/s, and the ground rises {rise:.2f} m where "
        f"legs take up {leg_travel:.2f} m"
    )
    works = _heights_that_work(slope, leg_travel, speed, absorption)
    if _share(slope, leg_travel, None, absorption) <= 1.0:
        works.append(f"a speed of {math.floor(10.0 * _take_off(slope, radius, absorption)) / 10.0:g} m/s")
    hint = f"{' or '.join(works)} would work" if works else "make them wider"
    raise SpecError(f"slope.{_key(slope)}", getattr(slope, _key(slope)), problem=problem, hint=hint)


def _key(slope: SlopeSpec) -> str:
    return {"bumps": "bump_height", "moguls": "mogul_height"}[slope.kind]


def _shape(slope: SlopeSpec) -> tuple[float, float, float]:
    """Return the radius of the crests [m], the steepest side [rad] and the rise from trough to crest [m]."""
    relief = build_relief(slope)
    if slope.kind == "bumps":
        return relief.radius, bump_angle(slope.bump_height, slope.bump_width), 2.0 * relief.reach
    return relief.radius, math.atan(relief.steepest), 2.0 * relief.reach


def _take_off(slope: SlopeSpec, radius: float, absorption: float) -> float:
    """Return the speed [m/s] above which gravity does not hold the body on its way over a crest of `radius` [m]."""
    held = STANDARD_GRAVITY * math.cos(math.radians(slope.angle_deg)) * radius
    return math.sqrt(held / (1.0 - absorption)) if absorption < 1.0 else math.inf


def _share(slope: SlopeSpec, leg_travel: float, speed: float | None, absorption: float) -> float:
    """Return what the ground asks as a share of what a skier can do: the largest of legs, take-off and sides."""
    radius, side, rise = _shape(slope)
    asked = absorption * rise
    legs = asked / leg_travel if leg_travel > 0.0 else math.inf if asked else 0.0
    thrown = ((speed or 0.0) / _take_off(slope, radius, absorption)) ** 2
    return max(legs, thrown, math.tan(side) / math.tan(STEEPEST_SIDE))


def _with_height(slope: SlopeSpec, height: float) -> SlopeSpec:
    if slope.kind == "bumps":
        return dataclasses.replace(slope, bump_height=height)
    return dataclasses.replace(slope, mogul_height=height)


def _heights_that_work(slope: SlopeSpec, leg_travel: float, speed: float | None, absorption: float) -> list[str]:
    """Return the largest height that would work, in whole centimetres, or nothing if the lowest does not."""

    def works(centimetres: int) -> bool:
        return _share(_with_height(slope, 0.01 * centimetres), leg_travel, speed, absorption) <= 1.0

    low, high = _LOWEST, math.ceil(100.0 * getattr(slope, _key(slope)))  # what is asked does not work
    if not works(low):
        return []
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if works(middle) else (low, middle)
    return [f"a height of {0.01 * low:g} m"]
