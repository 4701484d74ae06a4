"""Where snow touches the skis: contact points along both edges, force directions, and which edges bear.

Each ski has `segments` points on its left and on its right edge. A point pushes along the snow's normal, drags
against its velocity in proportion (friction), and shears across the ski within the surface [SG19 Eq. 25-27].
The paper switches edges at 0.016 degrees, which would chatter; here the edge that leaves the snow fades out between
two small angles.
"""

from __future__ import annotations

import math

import numpy as np

FADE_FROM, FADE_TO = np.deg2rad(0.5), np.deg2rad(8.0)
"""Edge angles [rad] between which the lifted edge stops bearing."""
SOFT = 0.05
"""Sine of the edge angle below which a ski's lift is rounded."""


def contact_points(length: float, width: float, segments: int) -> np.ndarray:
    """Return the contact points (2, segments, 3) [m, ski frame] at segment centres: left edge, then right edge."""
    along = (np.arange(segments) + 0.5) * (length / segments) - 0.5 * length
    points = np.zeros((2, segments, 3))
    points[:, :, 0] = along
    points[0, :, 1] = 0.5 * width
    points[1, :, 1] = -0.5 * width
    return points


def edge_bearing(edge_angle: float) -> tuple[float, float]:
    """Return how far (0..1) the left and the right edge may bear at `edge_angle` [rad], positive when leaning left.

    Both bear on a flat ski; the left one alone past `FADE_TO` to the left [SG19 Eq. 27 without its chatter].
    """
    x = (abs(edge_angle) - FADE_FROM) / (FADE_TO - FADE_FROM)
    x = 0.0 if x < 0.0 else 1.0 if x > 1.0 else x
    lifted = 1.0 - x * x * (3.0 - 2.0 * x)
    return (1.0, lifted) if edge_angle > 0.0 else (lifted, 1.0)


def edge_bearings(edge_angle: np.ndarray) -> np.ndarray:
    """Return `edge_bearing` of many angles (...) [rad]: (..., 2), left then right."""
    x = np.clip((np.abs(edge_angle) - FADE_FROM) / (FADE_TO - FADE_FROM), 0.0, 1.0)
    lifted = 1.0 - x * x * (3.0 - 2.0 * x)
    to_left = edge_angle > 0.0
    return np.stack((np.where(to_left, 1.0, lifted), np.where(to_left, lifted, 1.0)), axis=-1)


def lift_slope(edge_angle: float, width: float) -> tuple[float, float]:
    """Return `edge_lift` [m] of one angle [rad] and its derivative [m/rad]."""
    sine = math.sin(edge_angle)
    root = math.sqrt(sine * sine + SOFT * SOFT)
    return 0.5 * width * (root - SOFT), 0.5 * width * sine * math.cos(edge_angle) / root


def edge_lift(edge_angle: np.ndarray, width: float) -> np.ndarray:
    """Return how far [m] the middle of a ski's base rises when it stands on one edge; smooth through flat."""
    sine = np.sin(np.array(edge_angle, dtype=float, order="C"))
    return 0.5 * width * (np.sqrt(sine**2 + SOFT**2) - SOFT)
