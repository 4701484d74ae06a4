"""From the `[slope]` section of a run document to a terrain."""

from __future__ import annotations

import math

from ..errors import SpecError
from ..spec import SlopeSpec
from .bumps import BumpTrain
from .plane import PlaneTerrain
from .relief import STEEPEST, Relief, ReliefTerrain
from .terrain import Terrain


def build_terrain(slope: SlopeSpec) -> Terrain:
    """Return the terrain that `slope` asks for; raises `SpecError` for a shape that cannot be."""
    angle = math.radians(slope.angle_deg)
    if slope.kind == "bumps":
        return ReliefTerrain(angle, _checked(bump_train(slope), slope, "bump_height", slope.bump_height))
    return PlaneTerrain(angle)


def bump_train(slope: SlopeSpec) -> BumpTrain:
    """Return the bumps that `slope` describes, without its plane."""
    most = 0.5 * slope.bump_width
    if slope.bump_height >= most:
        wide = 2.0 * slope.bump_height
        hint = f"an arc is at most half a circle: make bumps lower than {most:g} m or wider than {wide:g} m"
        raise SpecError("slope.bump_height", slope.bump_height, f"0.02..{most:g} m", hint)
    return BumpTrain(slope.bump_count, slope.bump_height, slope.bump_width, slope.bump_start, slope.bump_fillet)


def _checked(relief: Relief, slope: SlopeSpec, key: str, height: float) -> Relief:
    """Return `relief`, whose slopes grow with its `height` [m]; raises `SpecError` where it would overhang."""
    side = math.atan(relief.steepest)
    if side + math.radians(slope.angle_deg) <= STEEPEST:
        return relief
    room = STEEPEST - math.radians(slope.angle_deg)
    problem = (
        f"makes sides of {math.degrees(side):.0f} degrees, which overhang on a slope of {slope.angle_deg:g} degrees"
    )
    works = math.floor(100.0 * height * 0.9 * math.tan(room) / relief.steepest) / 100.0
    hint = f"a height of {works:g} m or a slope under {math.degrees(STEEPEST - side):.0f} degrees would work"
    raise SpecError(f"slope.{key}", height, problem=problem, hint=hint)
