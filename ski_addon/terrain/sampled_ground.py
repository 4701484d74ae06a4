"""A mesh as sampled: its heights along the fall line, what of them is real, its place in the world, and its file."""

from __future__ import annotations

import io
import tokenize
import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from .. import archive
from ..atomic import atomic_path
from ..errors import MissingInputError, OutputError, SpecError
from .grid import HeightGrid
from .terrain import Number, paired


@dataclass(frozen=True)
class MeshGround:
    """Ground sampled from a mesh, in the frame of the run: x down the fall line, y to the left, the start at x = y = 0.

    `heights` (nx, ny) [m] over the start, their first one at `origin` (x, y) [m], `spacing` [m] apart along both axes;
    `covered` (nx, ny): whether the mesh lies there, the others are made up. `world_from_run` (4, 4) turns about z and
    moves. The run's z counts from the mean plane of the ground, as in every `HeightGrid`: where the ground lies off
    that plane at the start, so does the start off the run's origin. `start` (3,) [m, world] is the start on the mesh.
    `name` is what errors call the mesh.
    """

    heights: np.ndarray
    spacing: float
    origin: tuple[float, float]
    covered: np.ndarray
    world_from_run: np.ndarray
    start: np.ndarray
    name: str

    def __post_init__(self) -> None:
        for values in (self.heights, self.covered, self.world_from_run, self.start):
            values.setflags(write=False)

    @property
    def size(self) -> tuple[float, float]:
        """Length down the fall line and width across it [m]."""
        rows, columns = self.heights.shape
        return (rows - 1) * self.spacing, (columns - 1) * self.spacing

    @property
    def summary(self) -> str:
        """The resolution in one line, such as `0.5 m, 240 x 120 samples`."""
        rows, columns = self.heights.shape
        return f"{self.spacing:g} m, {rows} x {columns} samples"

    def terrain(self) -> HeightGrid:
        """Return the ground that a run on the written file has."""
        return HeightGrid(self.heights, self.spacing, self.origin, name=self.name)

    def covers(self, x: Number, y: Number) -> np.ndarray:
        """Return whether the mesh lies at `x`, `y` [m, run], broadcast together: at all four samples round the place.

        The terrain's own `contains` is true in the whole rectangle, also where its heights are made up.
        """
        x, y = paired(x, y)
        rows, columns = self.heights.shape
        i, j = (x - self.origin[0]) / self.spacing, (y - self.origin[1]) / self.spacing
        inside = (i >= -1e-9) & (i <= rows - 1 + 1e-9) & (j >= -1e-9) & (j <= columns - 1 + 1e-9)
        i, j = (np.where(inside, at, 0.0) for at in (i, j))
        out = inside
        for row in (np.floor(i + 1e-9), np.ceil(i - 1e-9)):
            for column in (np.floor(j + 1e-9), np.ceil(j - 1e-9)):
                out = out & self.covered[row.astype(int), column.astype(int)]
        return out

    def check_track(self, track: np.ndarray) -> None:
        """Raise `SpecError` with the place if `track` (n, 2 or 3) [m, run] leaves the mesh."""
        known = np.atleast_1d(self.covers(track[:, 0], track[:, 1]))
        if np.all(known):
            return
        first = int(np.argmin(known))
        x, y = track[first, :2]
        far = float(np.hypot(*np.diff(track[: first + 1, :2], axis=0).T).sum())
        world = self.to_world(np.array((x, y, 0.0)))
        problem = f"ends {far:.0f} m along the track, at ({world[0]:.1f}, {world[1]:.1f}) of the world"
        raise SpecError(self.name, None, "", "make the run shorter or narrower, or start elsewhere", problem=problem)

    def to_world(self, points: np.ndarray) -> np.ndarray:
        """Return `points` (..., 3) [m, run] in the world [m]."""
        return np.asarray(points @ self.world_from_run[:3, :3].T + self.world_from_run[:3, 3])

    def slope_keys(self, path: str | Path) -> dict[str, float | str]:
        """Return dotted keys of a run document for a run on this ground, written to `path`."""
        return {
            "slope.kind": "grid",
            "slope.grid_file": str(path),
            "slope.angle_deg": 0.0,
            "slope.grid_spacing": "auto",
            "slope.grid_downhill": "bottom",
            "slope.grid_start_down": "auto",
            "slope.grid_start_across": "auto",
        }


def write_ground(ground: MeshGround, path: str | Path) -> Path:
    """Write `ground` to `path` (.npz), whole or not at all, as `slope.grid_file` takes it; see `MeshGround.slope_keys`.

    The file also holds what `read_ground` needs. Raises `OutputError` when it cannot be written.
    """
    target = Path(path)
    if target.suffix.lower() != ".npz":
        raise OutputError(target, "a ground's file ends in .npz")
    packed = io.BytesIO()  # an archive that fails on a full disk would fail a second time when it is thrown away
    np.savez(
        packed,
        height=ground.heights,
        spacing=np.array(ground.spacing),
        origin=np.array(ground.origin),
        covered=ground.covered,
        world_from_run=ground.world_from_run,
        start=ground.start,
        name=np.array(ground.name),
    )
    with atomic_path(target) as temporary:
        temporary.write_bytes(packed.getbuffer())
    return target


_DAMAGE = (*archive.DAMAGE, KeyError, AttributeError, TypeError, SyntaxError, tokenize.TokenError, zipfile.BadZipFile)
"""What numpy and this module raise for a file that is damaged, or something else."""


def read_ground(path: str | Path) -> MeshGround:
    """Return the ground that `write_ground` wrote to `path`; raises `MissingInputError` if there is no such file."""
    source = Path(path)
    try:
        with np.load(source, allow_pickle=False) as file:
            x, y = file["origin"].tolist()
            known = file["covered"], file["world_from_run"], file["start"]
            return MeshGround(file["height"], float(file["spacing"]), (x, y), *known, str(file["name"]))
    except FileNotFoundError:
        raise MissingInputError(source) from None
    except _DAMAGE as error:
        raise MissingInputError(source, f"it is not a ground sampled from a mesh ({error})") from None
