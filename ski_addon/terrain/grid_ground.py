"""From the keys `slope.grid_...` to a ground: find the file, read it, turn it downhill and put it under the start."""

from __future__ import annotations

import math

import numpy as np

from ..errors import SpecError
from ..spec import SlopeSpec, find_ground
from .grid import HeightGrid
from .grid_checks import check_holes
from .grid_files import GridData, Pair, read_grid

QUARTER_TURNS = {"bottom": 0, "left": 1, "top": 2, "right": 3}
"""Turns to the left, seen from above, that bring the side of the file which lies downhill to the bottom."""
START_MARGIN = 5.0
"""How far [m] into the grid a run starts if neither the file nor the document says where."""


def build_grid(slope: SlopeSpec) -> HeightGrid:
    """Return the ground of `slope.grid_file`; raises `SpecError`, `MissingInputError` or `TerrainError`."""
    if not slope.grid_file:
        hint = 'name a file of heights, or a shipped ground such as "rolling_hill"'
        raise SpecError("slope.grid_file", problem='is needed for slope.kind = "grid"', hint=hint)
    path = find_ground(slope.grid_file)
    name = f"slope.grid_file {path.name}"
    data = read_grid(path, name)
    check_holes(data.heights, name)  # before it is turned, so that the index is that of the file
    heights = data.heights * slope.grid_height if data.is_image else data.heights
    spacing = _spacing(data, slope, path.name)
    heights, spacing, origin = _turned(heights, spacing, data.origin, QUARTER_TURNS[slope.grid_downhill])
    return HeightGrid(
        heights,
        spacing,
        _origin(slope, heights.shape, spacing, origin),
        angle=math.radians(slope.angle_deg),
        smoothing=slope.grid_smoothing,
        name=name,
    )


def _spacing(data: GridData, slope: SlopeSpec, name: str) -> Pair:
    if not isinstance(slope.grid_spacing, str):
        return slope.grid_spacing, slope.grid_spacing
    if data.spacing is None:
        hint = "write the metres between samples, for instance grid_spacing = 1.0 under [slope]"
        raise SpecError("slope.grid_spacing", "auto", problem=f"is not enough: {name} does not say it", hint=hint)
    return data.spacing


def _turned(
    heights: np.ndarray, spacing: Pair, origin: Pair | None, turns: int
) -> tuple[np.ndarray, Pair, Pair | None]:
    """Return the grid after `turns` quarter turns to the left about the world's origin, seen from above."""
    for _ in range(turns):
        if origin is not None:
            origin = -(origin[1] + (heights.shape[1] - 1) * spacing[1]), origin[0]
        heights, spacing = np.rot90(heights), (spacing[1], spacing[0])
    return heights, spacing, origin


def _origin(slope: SlopeSpec, shape: tuple[int, ...], spacing: Pair, origin: Pair | None) -> Pair:
    """Return where the first sample lies so that the run starts where it should; raises `SpecError` off the grid."""
    size = (shape[0] - 1) * spacing[0], (shape[1] - 1) * spacing[1]
    start = (min(START_MARGIN, 0.25 * size[0]), 0.5 * size[1]) if origin is None else (-origin[0], -origin[1])
    keys = ("grid_start_down", "grid_start_across")
    asked = (slope.grid_start_down, slope.grid_start_across)
    place = [known if isinstance(word, str) else word for word, known in zip(asked, start, strict=True)]
    for key, value, most in zip(keys, place, size, strict=True):
        if not 0.0 <= value <= most:
            raise SpecError(f"slope.{key}", value, f"0..{most:g} m", "the run has to start on the grid")
    return -place[0], -place[1]
