"""The ground: height, slope and normal at any horizontal position, batched."""

from __future__ import annotations

from .build import build_terrain, mogul_crests, mogul_troughs
from .bumps import BumpTrain, bump_angle, bump_radius
from .grid import HeightGrid
from .mesh_ground import mesh_ground
from .moguls import MogulField
from .plane import PlaneTerrain
from .reach import check_bumps
from .relief import ReliefTerrain
from .sampled_ground import MeshGround, read_ground, write_ground
from .samples import grid_from_samples
from .terrain import Terrain

__all__ = [
    "BumpTrain",
    "HeightGrid",
    "MeshGround",
    "MogulField",
    "PlaneTerrain",
    "ReliefTerrain",
    "Terrain",
    "build_terrain",
    "bump_angle",
    "bump_radius",
    "check_bumps",
    "grid_from_samples",
    "mesh_ground",
    "mogul_crests",
    "mogul_troughs",
    "read_ground",
    "write_ground",
]
