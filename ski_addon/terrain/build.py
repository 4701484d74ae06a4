"""From the `[slope]` section of a run document to a terrain."""

from __future__ import annotations

import math

import numpy as np

from ..errors import SpecError
from ..spec import SlopeSpec
from .bumps import BumpTrain
from .moguls import MogulField
from .plane import PlaneTerrain
from .relief import STEEPEST, ReliefTerrain
from .terrain import Terrain


def build_terrain(slope: SlopeSpec) -> Terrain:
    """Return the terrain that `slope` asks for; raises `SpecError` for a shape that cannot be."""
    angle = math.radians(slope.angle_deg)
    if slope.kind == "plane":
        return PlaneTerrain(angle)
    relief = build_relief(slope)
    _check_overhang(relief, slope)
    return ReliefTerrain(angle, relief)


def build_relief(slope: SlopeSpec) -> BumpTrain | MogulField:
    """Return the bumps or moguls that `slope` describes, without its plane."""
    return _bumps(slope) if slope.kind == "bumps" else _moguls(slope)


def mogul_crests(slope: SlopeSpec, half_width: float = 10.0) -> np.ndarray:
    """Return where the crests of a mogul field lie, (m, 2) (down the slope, left) [m] in the slope's plane.

    Those within `half_width` [m] of the middle, column after column from the right, each from the top.
    """
    return _moguls(slope).crests(half_width)


def mogul_troughs(slope: SlopeSpec, half_width: float = 10.0) -> np.ndarray:
    """Return where its troughs lie; see `mogul_crests`."""
    return _moguls(slope).troughs(half_width)


def _moguls(slope: SlopeSpec) -> MogulField:
    across = slope.mogul_spacing if isinstance(slope.mogul_across, str) else slope.mogul_across
    return MogulField(slope.mogul_count, slope.mogul_height, slope.mogul_spacing, across, slope.bump_start)


def _bumps(slope: SlopeSpec) -> BumpTrain:
    most = 0.5 * slope.bump_width
    if slope.bump_height >= most:
        wide = 2.0 * slope.bump_height
        hint = f"an arc is at most half a circle: make bumps lower than {most:g} m or wider than {wide:g} m"
        raise SpecError("slope.bump_height", slope.bump_height, f"0.02..{most:g} m", hint)
    return BumpTrain(slope.bump_count, slope.bump_height, slope.bump_width, slope.bump_start, slope.bump_fillet)


def _check_overhang(relief: BumpTrain | MogulField, slope: SlopeSpec) -> None:
    """Raise `SpecError` if sides of `relief` would overhang on the slope, or nearly."""
    side = math.atan(relief.steepest)
    if side + math.radians(slope.angle_deg) <= STEEPEST:
        return
    key = f"{slope.kind[:-1]}_height"  # bump_height, mogul_height
    room = STEEPEST - math.radians(slope.angle_deg)
    problem = (
        f"makes sides of {math.degrees(side):.0f} degrees, which overhang on a slope of {slope.angle_deg:g} degrees"
    )
    works = [f"a height of {_rounded_down(0.9 * relief.height * math.tan(room) / relief.steepest):g} m"]
    if side < STEEPEST:
        works.append(f"a slope under {math.degrees(STEEPEST - side):.0f} degrees")
    raise SpecError(f"slope.{key}", relief.height, problem=problem, hint=f"{' or '.join(works)} would work")


def _rounded_down(value: float) -> float:
    return math.floor(100.0 * value) / 100.0
