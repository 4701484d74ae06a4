"""The ground: height and normal at any horizontal position, batched."""

from __future__ import annotations

from ..spec import SlopeSpec
from .plane import PlaneTerrain, Terrain

__all__ = ["PlaneTerrain", "Terrain", "build_terrain"]


def build_terrain(slope: SlopeSpec) -> Terrain:
    """Return the terrain that `slope` asks for."""
    import math

    return PlaneTerrain(math.radians(slope.angle_deg))
