"""The ground: height, slope and normal at any horizontal position, batched."""

from __future__ import annotations

from .build import build_terrain, mogul_crests, mogul_troughs
from .bumps import BumpTrain, bump_angle, bump_radius
from .moguls import MogulField
from .plane import PlaneTerrain
from .reach import check_bumps
from .relief import ReliefTerrain
from .terrain import Terrain

__all__ = [
    "BumpTrain",
    "MogulField",
    "PlaneTerrain",
    "ReliefTerrain",
    "Terrain",
    "build_terrain",
    "bump_angle",
    "bump_radius",
    "check_bumps",
    "mogul_crests",
    "mogul_troughs",
]
