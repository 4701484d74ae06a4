"""A plan-view curve laid on the ground: lifted, measured by its true length, and given the ground's frames.

Courses draw in the coordinates of the terrain's mean plane (down the fall line, and to the left), so that on a plane
slope lengths and radii are exact. On other ground the curve keeps its plan view.
"""

from __future__ import annotations

import numpy as np

from ..frames import normalized
from ..terrain import Terrain
from .track import Track

SPACING = 0.05
"""Distance between neighbouring places of a track [m]."""
_ORDER = 5


def track_on_surface(
    terrain: Terrain,
    down: np.ndarray,
    left: np.ndarray,
    phase: np.ndarray,
    turn: np.ndarray,
    start_speed: float,
) -> Track:
    """Return the track over the plan-view curve `down`, `left` (n,) [m] in the terrain's mean plane.

    Points are dense (about a tenth of a metre) and smooth; `phase` and `turn` (n,) label them as in `Track`;
    `start_speed` [m/s]. The curve is interpolated by splines of fifth order, so that curvature and its rate are
    smooth; heights, normals and slopes are the terrain's own.
    """
    from scipy.interpolate import make_interp_spline

    x, y = np.asarray(down, dtype=float) * np.cos(terrain.mean_angle), np.asarray(left, dtype=float)
    chord = np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))))
    view = make_interp_spline(chord, np.stack((x, y), axis=1), k=_ORDER)
    parameter, arc = _even_arc(terrain, view, float(chord[-1]))
    (x, y), slope = view(parameter).T, view(parameter, 1)
    position = np.stack((x, y, terrain.height(x, y)), axis=1)
    normal = terrain.normal(x, y)
    tangent = normalized(_lifted(slope, normal))
    label = np.clip(np.searchsorted(chord, parameter, side="right") - 1, 0, len(chord) - 1)
    bend, normal_bend, torsion = surface_curvatures(arc, tangent, normal)
    return Track(
        arc_length=arc,
        position=position,
        tangent=tangent,
        surface_normal=normal,
        curvature=bend,
        normal_curvature=normal_bend,
        torsion=torsion,
        phase=np.asarray(phase)[label].astype(np.int8),
        turn=np.asarray(turn)[label],
        start_speed=start_speed,
    )


def surface_curvatures(
    arc: np.ndarray, tangent: np.ndarray, normal: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return geodesic curvature, normal curvature and torsion (n,) [1/m] of a curve on a surface (Darboux's frame).

    With t, l, n along the curve, to its left and up: t' = kg l + kn n, l' = -kg t + tg n, n' = -kn t - tg l.
    """
    from scipy.interpolate import make_interp_spline

    left = np.cross(normal, tangent)
    slopes = make_interp_spline(arc, np.hstack((tangent, normal)), k=_ORDER)(arc, 1)
    tangent_rate, normal_rate = slopes[:, :3], slopes[:, 3:]
    return (
        np.sum(tangent_rate * left, axis=1),
        np.sum(tangent_rate * normal, axis=1),
        -np.sum(normal_rate * left, axis=1),
    )


def _lifted(slope: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return plan-view directions (n, 2) as directions (n, 3) within the surface of `normal` (n, 3)."""
    rise = -(slope[:, 0] * normal[:, 0] + slope[:, 1] * normal[:, 1]) / normal[:, 2]
    return np.column_stack((slope, rise))


def _even_arc(terrain: Terrain, view: object, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Return spline parameters (n,) at even steps of the true arc length, and the arc length (n,) [m] itself."""
    from scipy.integrate import cumulative_simpson
    from scipy.interpolate import CubicSpline

    fine = np.linspace(0.0, end, max(int(np.ceil(end / (0.4 * SPACING))), 50) + 1)
    (x, y), slope = view(fine).T, view(fine, 1)  # type: ignore[operator]
    stretch = np.linalg.norm(_lifted(slope, terrain.normal(x, y)), axis=1)
    length = cumulative_simpson(stretch, x=fine, initial=0.0)
    arc = np.linspace(0.0, length[-1], max(int(np.ceil(length[-1] / SPACING)), 20) + 1)
    parameter = CubicSpline(length, fine)(arc)
    parameter[0], parameter[-1] = 0.0, end
    return parameter, arc
