"""The ground: height, slope and normal at any horizontal position, batched."""

from __future__ import annotations

from .build import build_terrain
from .bumps import BumpTrain, bump_angle, bump_radius
from .plane import PlaneTerrain
from .relief import ReliefTerrain
from .terrain import Terrain

__all__ = [
    "BumpTrain",
    "PlaneTerrain",
    "ReliefTerrain",
    "Terrain",
    "build_terrain",
    "bump_angle",
    "bump_radius",
]
