"""From the triangles of any mesh to a ground: heights down its fall line, and where they lie in the world."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..errors import SpecError, TerrainError
from ..frames import rotation_about
from .fill import filled
from .grid import mean_line
from .grid_checks import checked_steps, checked_tilt
from .mesh_frame import Faces, check_size, checked_faces, chosen_resolution, fall_heading, turned
from .mesh_start import rows_used, upper_end
from .raster import Lattice, surface_heights
from .sampled_ground import MeshGround

BEHIND = 10.0
"""How much of a mesh is kept uphill of a given start [m]."""
LAYERS = 0.10
"""Surfaces that lie over each other by more than this are two [m]; below it the upper one counts."""


@dataclass(frozen=True)
class _View:
    """The `faces` of a mesh in axes whose x points along `heading` [rad], about `middle` (2,) [m, world]."""

    faces: Faces
    middle: np.ndarray
    heading: float
    name: str

    def to_world(self, xy: np.ndarray) -> np.ndarray:
        """Return `xy` (2,) [m] of these axes in the world."""
        return turned(np.asarray(xy), -self.heading) + self.middle

    def from_world(self, xy: np.ndarray) -> np.ndarray:
        """Return `xy` (2,) [m] of the world in these axes."""
        return turned(np.asarray(xy) - self.middle, self.heading)

    def shown(self, lattice: Lattice, i: int, j: int, z: float) -> str:
        """Return the place of a sample of height `z` [m, world] for a message."""
        x, y = self.to_world(np.array(lattice.low) + lattice.step * np.array((i, j)))
        return f"({x:.1f}, {y:.1f}, {z:.1f})"


def mesh_ground(
    triangles: np.ndarray,
    name: str,
    start: Sequence[float] | np.ndarray | None = None,
    heading: float | None = None,
    resolution: float | None = None,
) -> MeshGround:
    """Return the ground that `triangles` (n, 3, 3) [m, world] make, seen from above; counter-clockwise ones look up.

    `start` is a point of the world (x and y [m] count); without it the run starts at the upper end, in the middle. With
    it the ground reaches `BEHIND` uphill of it. Beyond a valley it ends (see `rows_used`). `heading` [rad, from the
    world's x to the left] is the way downhill; without it the mesh tells (see `fall_heading`). `resolution` [m] is the
    distance between samples. `name` is what errors call the mesh. Raises `SpecError` for a mesh that makes no ground,
    with what to do.
    """
    view = _view(np.asarray(triangles, dtype=float), name, start, heading)
    begin = None if start is None else view.from_world(_checked_start(start, name))
    if begin is not None:
        _height_at(view, begin)  # a start beside the mesh is said before anything else
    lattice = _lattice(view, begin, resolution)
    z, covered = _sampled(view, lattice)
    if begin is None:
        begin = upper_end(covered, lattice, name)
    z_start = _height_at(view, begin)
    rows = rows_used(z, covered, lattice, begin)
    z, covered, lattice = z[:rows], covered[:rows], replace(lattice, shape=(rows, lattice.shape[1]))
    heights = _completed(z - z_start, covered)
    x, y = (float(low - at) for low, at in zip(lattice.low, begin, strict=True))
    altitude = _altitude(view, lattice, heights, x, z_start)
    world_from_run = np.eye(4)
    world_from_run[:3, :3] = rotation_about("z", view.heading)
    world_from_run[:3, 3] = *view.to_world(begin), z_start + altitude
    on_ground = np.array([*view.to_world(begin), z_start])
    ground = MeshGround(heights, lattice.step, (x, y), covered, world_from_run, on_ground, name)
    if not ground.covers(0.0, 0.0):
        raise _bad_start(view, begin, f"is less than {lattice.step:g} m from the edge", "move it further in")
    return ground


def _view(triangles: np.ndarray, name: str, start: Sequence[float] | np.ndarray | None, heading: float | None) -> _View:
    """Return the mesh as it looks down its fall line, or along `heading`."""
    faces = checked_faces(triangles, name)
    if heading is not None and not math.isfinite(heading):
        raise SpecError(f"{name} heading", heading, "any angle", "give a number")
    direction = fall_heading(faces, name, None if start is None else _checked_start(start, name), heading)
    middle = 0.5 * np.sum(_rectangle(faces), axis=0)  # far from the origin, angles would cost digits
    up, down = (turned(part - np.append(middle, 0.0), direction) for part in (faces.up, faces.down))
    return _View(Faces(up, down, faces.up_area, faces.down_area), middle, direction, name)


def _checked_start(start: Sequence[float] | np.ndarray, name: str) -> np.ndarray:
    place = np.asarray(start, dtype=float).ravel()
    if len(place) not in (2, 3) or not np.all(np.isfinite(place)):
        raise SpecError(f"{name} start", start, "a point", "give x, y and z in metres", problem="is not")
    return place[:2]


def _rectangle(faces: Faces) -> np.ndarray:
    """Return the lowest and the highest x and y (2, 2) [m] of all faces."""
    x, y = (np.concatenate((faces.up[..., k].ravel(), faces.down[..., k].ravel())) for k in (0, 1))
    return np.array(((x.min(), y.min()), (x.max(), y.max())))


def _lattice(view: _View, begin: np.ndarray | None, resolution: float | None) -> Lattice:
    """Return the samples: the mesh's bounding rectangle along the fall line, from shortly before a given start on."""
    low, high = _rectangle(view.faces)
    below = high[0] - (low[0] if begin is None else begin[0])
    check_size(float(below), float(high[1] - low[1]), view.name, from_start=begin is not None)
    if begin is not None:
        low[0] = max(low[0], begin[0] - BEHIND)
    length, width = (high - low).tolist()
    area = np.concatenate((view.faces.up_area, view.faces.down_area))
    step = chosen_resolution(length, width, area, resolution, view.name)
    # At least a quarter of a step within the edges, which seldom run just along the fall line.
    shape = [math.floor(size / step - 0.5) + 1 for size in (length, width)]
    spare = [0.5 * (size - (count - 1) * step) for size, count in zip((length, width), shape, strict=True)]
    return Lattice((float(low[0] + spare[0]), float(low[1] + spare[1])), step, (shape[0], shape[1]))


def _sampled(view: _View, lattice: Lattice) -> tuple[np.ndarray, np.ndarray]:
    """Return heights (nx, ny) [m, world] and where there are any; raises `SpecError` for surfaces over each other."""
    top, bottom = surface_heights(view.faces.up, lattice)
    under, _ = surface_heights(view.faces.down, lattice)
    if (place := _layered(top, bottom)) is not None:
        i, j, apart = place
        problem = f"has two surfaces over each other, {apart:.2g} m apart, at {view.shown(lattice, i, j, top[i, j])}"
        hint = "keep the upper one, and move trees, roofs and rocks to objects of their own"
        raise SpecError(view.name, None, "", hint, problem=problem)
    if (place := _layered(under, np.where(np.isfinite(under), top, np.inf))) is not None:
        i, j, _ = place
        problem = f"has a face that looks down over one that looks up, at {view.shown(lattice, i, j, under[i, j])}"
        hint = "recalculate its normals to the outside (Shift N in Edit Mode)"
        raise SpecError(view.name, None, "", hint, problem=problem)
    # A face that looks down with nothing under it is ground whose normals were never set right.
    z = np.where(np.isfinite(top), top, under)
    return z, np.isfinite(z)


def _layered(top: np.ndarray, bottom: np.ndarray) -> tuple[int, int, float] | None:
    """Return a sample where `top` lies well over `bottom`, and by how much [m]; None if there is none.

    Four samples in a square have to agree: where a step's upright wall runs along the samples, one line of them meets
    both of its ends.
    """
    known = np.isfinite(top) & np.isfinite(bottom)
    apart = np.where(known, np.where(known, top, 0.0) - np.where(known, bottom, 0.0), 0.0)
    square = np.minimum(np.minimum(apart[:-1, :-1], apart[1:, :-1]), np.minimum(apart[:-1, 1:], apart[1:, 1:]))
    i, j = (int(k) for k in np.unravel_index(int(np.argmax(square)), square.shape))
    return (i, j, float(square[i, j])) if square[i, j] > LAYERS else None


def _height_at(view: _View, place: np.ndarray) -> float:
    """Return the height [m, world] of the mesh at `place` (2,); raises `SpecError` beside it."""
    spot = Lattice((float(place[0]), float(place[1])), 1.0, (1, 1))
    for part in (view.faces.up, view.faces.down):
        z = float(surface_heights(part, spot)[0][0, 0])
        if math.isfinite(z):
            return z
    raise _bad_start(view, place, "is not on the mesh", "put it over the mesh")


def _bad_start(view: _View, place: np.ndarray, problem: str, hint: str) -> SpecError:
    x, y = (round(value, 2) + 0.0 for value in view.to_world(place).tolist())  # + 0.0: never "-0.0"
    return SpecError(f"{view.name} start", (x, y), "", hint, problem=problem)


def _completed(z: np.ndarray, covered: np.ndarray) -> np.ndarray:
    """Return `z` (nx, ny) with heights for what is not `covered`: over the mean plane, a skin stretched between."""
    if np.all(covered):
        return z
    i, j = np.nonzero(covered)
    columns = np.column_stack((i, j, np.ones(len(i)))).astype(np.float64)
    plane = np.linalg.lstsq(columns, z[covered], rcond=None)[0]
    under = plane[0] * np.arange(z.shape[0])[:, None] + plane[1] * np.arange(z.shape[1]) + plane[2]
    return filled(np.where(covered, z, 0.0) - under, covered) + under


def _altitude(view: _View, lattice: Lattice, heights: np.ndarray, x: float, z_start: float) -> float:
    """Return how far over the start the mean plane lies there [m], as a `HeightGrid` counts.

    Raises `SpecError` for a cliff, and for ground that rises.
    """
    rows = x + lattice.step * np.arange(len(heights))
    fall, altitude = mean_line(rows, heights.mean(axis=1))
    over = heights - (altitude - fall * rows)[:, None]
    try:
        checked_steps(over, (lattice.step, lattice.step), fall, 0.0, view.name)
    except TerrainError as error:
        i, j = error.index
        steep = math.degrees(math.atan(abs(error.value or 0.0) / lattice.step))
        problem = (
            f"is a cliff of {steep:.0f} degrees (at most 60) at {view.shown(lattice, i, j, heights[i, j] + z_start)}"
        )
        raise SpecError(view.name, None, "", "smooth it there, or cut it off", problem=problem) from None
    try:
        checked_tilt(math.atan(fall), view.name)
    except TerrainError:
        problem = f"rises by {math.degrees(math.atan(-fall)):.1f} degrees from the start on, where it should fall"
        hint = "turn the heading round, or cut off what rises again"
        raise SpecError(view.name, None, "", hint, problem=problem) from None
    return altitude
