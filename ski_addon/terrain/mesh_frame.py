"""Which way a mesh falls, how large it is along that way, and how finely it is to be sampled."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..errors import SpecError
from ..frames import rotation_about

SIZE_LEAST, WIDTH_LEAST, SIZE_MOST = 20.0, 4.0, 10_000.0
"""Bounds of a mesh's length down the fall line, width across it, and both [m]."""
FLATTEST, STEEPEST = math.radians(0.5), math.radians(45.0)
"""A mesh that falls by less has no fall line; one that falls by more is no slope to ski on [rad]."""
SAMPLES_MOST, ASKED_MOST = 1_000_000, 4_000_000
"""How many samples a ground gets by itself, and if a spacing is asked for."""
FINEST, COARSEST = 0.25, 2.0
"""Bounds of the spacing [m] that fits the faces of a mesh."""
SPREAD = 15.0
"""How far round a given start [m] (the standard deviation of a Gaussian) a mesh says which way it falls."""
_UPRIGHT = 0.02
"""Cosine of the tilt from which on a face is a wall, and no ground."""


@dataclass(frozen=True)
class Faces:
    """Triangles (n, 3, 3) [m] that look up and down, walls left out, and their areas (n,) [m^2] as seen from above."""

    up: np.ndarray
    down: np.ndarray
    up_area: np.ndarray
    down_area: np.ndarray

    @property
    def ground(self) -> tuple[np.ndarray, np.ndarray]:
        """The triangles that tell the fall line, and their areas: those that look up, or all if most are flipped."""
        if self.up_area.sum() >= self.down_area.sum():  # a solid has as much of both
            return self.up, self.up_area
        return np.concatenate((self.up, self.down)), np.concatenate((self.up_area, self.down_area))


def checked_faces(triangles: np.ndarray, name: str) -> Faces:
    """Return the `triangles` (n, 3, 3) [m, world] by what they look at.

    Raises `SpecError` if there are none, if they are not finite, or if all stand upright.
    """
    if len(triangles) == 0:
        raise SpecError(f"{name} faces", 0, "at least 1", "choose a mesh with faces, or make instances real")
    broken = ~np.isfinite(triangles).all(axis=(1, 2))
    if np.any(broken):
        problem = f"are not numbers in {np.count_nonzero(broken)} of {len(triangles)} triangles"
        raise SpecError(
            f"{name} places of vertices", None, "", "delete these vertices, or mend the modifier", problem=problem
        )
    normal = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    lies = np.abs(normal[:, 2]) > _UPRIGHT * np.linalg.norm(normal, axis=1)
    up, down = lies & (normal[:, 2] > 0.0), lies & (normal[:, 2] < 0.0)
    if not np.any(up | down):
        raise SpecError(
            name, None, "", "choose a mesh that lies like ground, or turn it", problem="has no face that looks up"
        )
    return Faces(triangles[up], triangles[down], 0.5 * np.abs(normal[up, 2]), 0.5 * np.abs(normal[down, 2]))


def fall_heading(faces: Faces, name: str, start: np.ndarray | None, heading: float | None) -> float:
    """Return the direction [rad, from the world's x axis to the left] in which the ground falls, or `heading` if given.

    That is the steepest way down the plane that fits all faces best, each weighted by its area as seen from above; with
    a `start` (2,) [m, world], of the faces round it, unless these are flat. Raises `SpecError` for a mesh that is
    flat, unless `heading` is given, or steeper than 45 degrees.
    """
    triangles, area = faces.ground
    middles = 0.5 * (triangles + np.roll(triangles, 1, axis=1)).reshape(-1, 3)  # exact for squares, with a third each
    weight = np.repeat(area / 3.0, 3)
    gradient = _gradient(middles, weight)
    if start is not None:
        away = np.sum(np.square(middles[:, :2] - start), axis=1) / SPREAD**2
        nearby = _gradient(middles, weight * np.exp(-0.5 * away))
        if math.atan(math.hypot(*nearby)) >= FLATTEST:
            gradient = nearby
    tilt = math.atan(math.hypot(*gradient))
    degrees = round(math.degrees(tilt), 1)
    if tilt > STEEPEST:
        allowed = f"{math.degrees(FLATTEST):g}..{math.degrees(STEEPEST):g} degrees"
        raise SpecError(f"{name} steepness", degrees, allowed, "turn it so that it lies like ground")
    if heading is not None:
        return heading
    if tilt < FLATTEST:
        allowed = f"{math.degrees(FLATTEST):g}..{math.degrees(STEEPEST):g} degrees"
        hint = "tilt it, or give a start on the side to ski down, or a heading"
        raise SpecError(f"{name} steepness", degrees, allowed, hint)
    return math.atan2(-gradient[1], -gradient[0])


def _gradient(points: np.ndarray, weight: np.ndarray) -> tuple[float, float]:
    """Return dz/dx and dz/dy of the plane that fits `points` (n, 3) best; 0, 0 if they do not tell."""
    if not weight.sum() > 1e-200:
        return 0.0, 0.0
    over = points - np.average(points, axis=0, weights=weight)
    square = np.einsum("n,ni,nj->ij", weight, over, over)
    if np.linalg.det(square[:2, :2]) <= 1e-12 * np.trace(square[:2, :2]) ** 2:
        return 0.0, 0.0
    slope = np.linalg.solve(square[:2, :2], square[:2, 2])
    return float(slope[0]), float(slope[1])


def turned(points: np.ndarray, heading: float) -> np.ndarray:
    """Return `points` (..., 2 or 3) of the world in axes whose x points along `heading` [rad], of one origin."""
    size = points.shape[-1]
    return np.asarray(points @ rotation_about("z", heading)[:size, :size])


def check_size(length: float, width: float, name: str, *, from_start: bool) -> None:
    """Raise `SpecError` unless a ground of `length` down the fall line and `width` [m] is large and small enough."""
    for what, value, least in (("length", length, SIZE_LEAST), ("width", width, WIDTH_LEAST)):
        if value > SIZE_MOST:
            hint = "scale it to its real size in metres, or cut out the part to ski on"
        elif value < least:
            what = f"{what} below the start" if from_start and what == "length" else what
            hint = "start further up or choose a larger mesh" if from_start else "scale it to its real size in metres"
        else:
            continue
        raise SpecError(f"{name} {what}", round(value, 2), f"{least:g}..{SIZE_MOST:g} m", hint)


def chosen_resolution(length: float, width: float, area: np.ndarray, asked: float | None, name: str) -> float:
    """Return the spacing of samples [m]: `asked`, or half of what the faces of `area` (n,) [m^2] typically measure.

    What is chosen keeps within `FINEST`..`COARSEST` and, whatever that takes, within `SAMPLES_MOST`. Raises `SpecError`
    if `asked` would make too many samples, or too few.
    """
    if asked is not None:
        least, most = _rounded_up(math.sqrt(length * width / ASKED_MOST)), min(length, width) / 4.0
        if not least <= asked <= most:
            allowed = f"{least:g}..{most:.3g} m"
            raise SpecError(f"{name} resolution", asked, allowed, f"the ground is {length:.0f} m by {width:.0f} m")
        return float(asked)
    face = math.sqrt(2.0 * float(np.median(area)))
    fitting = min(max(0.5 * face, FINEST), COARSEST, min(length, width) / 8.0)
    return _rounded_up(max(fitting, math.sqrt(length * width / SAMPLES_MOST)))


def _rounded_up(value: float) -> float:
    """Return `value` rounded up to two digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 1)
    return float(f"{math.ceil(value / digit - 1e-9) * digit:.2g}")
