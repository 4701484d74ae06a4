"""The path that is to be followed, as the samples that distances are measured to [VP93 sec. 6, Fig. 12]."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...frames import Array

SAMPLES_PER_SEGMENT = 12
"""Samples of each segment of the path, as in the paper."""
CLOSEST, FURTHEST = 0.2, 0.5
"""Least and most distance between samples [m]: segments much shorter or longer than the paper's get fewer or more."""
_FINE = 16


@dataclass(frozen=True)
class DesiredPath:
    """Samples of the desired path and of its straight continuation; read-only arrays in the plan view.

    `places` (m, 2) [m]; `heading` (m,) [rad], positive to the left of x, without jumps of 2 pi; `along` (m,) [m] from
    the start; the path itself ends with sample `last`, what comes after continues it straight on so that plans may
    look beyond its end.
    """

    places: Array
    heading: Array
    along: Array
    last: int

    def __post_init__(self) -> None:
        for value in (self.places, self.heading, self.along):
            value.setflags(write=False)

    @property
    def length(self) -> float:
        """Length of the path itself [m]."""
        return float(self.along[self.last])


def polyline_path(points: Array, beyond: float = 60.0) -> DesiredPath:
    """Return the path along straight segments between `points` (n, 2) [m], continued for `beyond` [m]."""
    points = _distinct(points)
    return _sampled([points[k : k + 2] for k in range(len(points) - 1)], beyond)


def hermite_path(points: Array, tangents: Array | None = None, beyond: float = 60.0) -> DesiredPath:
    """Return the path along cubic Hermite segments through `points` (n, 2) [m] with `tangents` (n, 2) at them.

    A tangent is the derivative by the segment's parameter, which runs from 0 to 1. Without any, they are made from
    neighbouring points so that the curve is round where these are unevenly spaced.
    """
    if tangents is not None:
        pieces = list(zip(points, points[1:], tangents, tangents[1:], strict=False))
    else:
        points = _distinct(points)
        slope, gap = _slopes(points)
        pieces = [(points[k], points[k + 1], slope[k] * gap[k], slope[k + 1] * gap[k]) for k in range(len(points) - 1)]
    return _sampled([_hermite(*piece) for piece in pieces], beyond)


def _slopes(points: Array) -> tuple[Array, Array]:
    """Return derivatives (n, 2) by arc length at `points`, and the distances (n-1,) between them."""
    gap = np.linalg.norm(np.diff(points, axis=0), axis=1)
    chord = np.diff(points, axis=0) / gap[:, None]
    slope = np.concatenate((chord[:1], np.zeros((len(points) - 2, 2)), chord[-1:]))
    share = gap[:-1] / (gap[:-1] + gap[1:])
    slope[1:-1] = chord[:-1] * (1.0 - share)[:, None] + chord[1:] * share[:, None]
    return slope, gap


def _hermite(begin: Array, end: Array, leave: Array, arrive: Array) -> Array:
    reach = float(np.linalg.norm(end - begin)) + float(np.linalg.norm(leave)) + float(np.linalg.norm(arrive))
    u = np.linspace(0.0, 1.0, max(_FINE, int(reach / CLOSEST)) + 1)[:, None]
    place = (2 * u**3 - 3 * u**2 + 1) * begin + (3 * u**2 - 2 * u**3) * end
    return place + (u**3 - 2 * u**2 + u) * leave + (u**3 - u**2) * arrive


def _sampled(segments: list[Array], beyond: float) -> DesiredPath:
    """Return samples of `segments`, polylines (k, 2) of which each begins where the one before it ends."""
    places = [segments[0][:1]]
    for fine in segments:
        arc = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(fine, axis=0), axis=1))))
        cells = int(np.clip(SAMPLES_PER_SEGMENT, np.ceil(arc[-1] / FURTHEST), max(np.floor(arc[-1] / CLOSEST), 1.0)))
        even = np.linspace(0.0, arc[-1], cells + 1)[1:]
        places.append(np.column_stack([np.interp(even, arc, fine[:, axis]) for axis in (0, 1)]))
    place = np.concatenate(places)
    last = len(place) - 1
    onward = segments[-1][-1] - segments[-1][-2]
    onward = onward / np.linalg.norm(onward)
    steps = np.arange(1, int(np.ceil(beyond / FURTHEST)) + 1)[:, None] * FURTHEST
    place = np.concatenate((place, place[-1] + steps * onward))
    step = np.diff(place, axis=0)
    heading = np.unwrap(np.arctan2(step[:, 1], step[:, 0]))
    along = np.concatenate(([0.0], np.cumsum(np.hypot(step[:, 0], step[:, 1]))))
    return DesiredPath(place, np.append(heading, heading[-1]), along, last)


def _distinct(points: Array) -> Array:
    """Return `points` (n, 2) without repetitions of the one before."""
    points = np.asarray(points, dtype=float).reshape(-1, 2)
    kept = np.concatenate(([True], np.linalg.norm(np.diff(points, axis=0), axis=1) > 1e-9))
    return np.asarray(points[kept])
