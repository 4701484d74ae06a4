"""Meshes as triangles, for tests of what samples them."""

from __future__ import annotations

import numpy as np


def hill(x, y):
    """A smooth slope of 14 degrees with soft waves; 1 m high, 50 m long."""
    return 100.0 - 0.25 * x + np.sin(x / 8) * np.cos(y / 9)


def sheet(height, length=120.0, width=60.0, face=1.0, keep=None) -> np.ndarray:
    """Triangles (n, 3, 3) of squares over 0..length, -width/2..width/2 that look up; `keep(x, y)` says which stay."""
    x, y = np.arange(0.0, length + 0.5 * face, face), np.arange(-0.5 * width, 0.5 * width + 0.5 * face, face)
    x, y = np.meshgrid(x, y, indexing="ij")
    points = np.stack((x, y, height(x, y)), axis=-1)
    a, b, c, d = points[:-1, :-1], points[1:, :-1], points[1:, 1:], points[:-1, 1:]
    middle = 0.5 * (a + c).reshape(-1, 3)
    there = np.ones(len(middle), dtype=bool) if keep is None else keep(middle[:, 0], middle[:, 1])
    halves = [np.stack(corners, axis=-2).reshape(-1, 3, 3)[there] for corners in ((a, b, c), (a, c, d))]
    return np.concatenate(halves)


def moved(triangles: np.ndarray, turn: float, shift: tuple[float, float, float]) -> np.ndarray:
    """Triangles turned about z by `turn` [rad] and shifted."""
    c, s = np.cos(turn), np.sin(turn)
    return triangles @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) + shift
