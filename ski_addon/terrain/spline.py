"""A bicubic spline through evenly spaced samples: C2, exact at the samples and for every cubic.

The spline is kept as coefficients of uniform cubic B-splines (one more on every side than there are samples), so that
a value needs the sixteen coefficients around it and no search. Its ends are "not a knot", as usual for interpolation.
"""

from __future__ import annotations

import math

import numpy as np

from .terrain import One

Weights = tuple[One, One, One, One]


def spline_coefficients(samples: np.ndarray) -> np.ndarray:
    """Return the coefficients (nx + 2, ny + 2) of the spline through `samples` (nx, ny), at least 4 x 4."""
    return _along_rows(_along_rows(samples).T).T.copy()


def value_weights(t: One) -> Weights:
    """Return the weights of four neighbouring coefficients at `t` (0..1) between the middle two."""
    u = 1.0 - t
    return (
        u * u * u / 6.0,
        (4.0 - 3.0 * t * t * (1.0 + u)) / 6.0,
        (4.0 - 3.0 * u * u * (1.0 + t)) / 6.0,
        t * t * t / 6.0,
    )


def slope_weights(t: One) -> Weights:
    """Return the weights for the derivative to `t`."""
    u = 1.0 - t
    return -0.5 * u * u, 0.5 * t * (3.0 * t - 4.0), -0.5 * u * (3.0 * u - 4.0), 0.5 * t * t


def evaluate_at(coefficients: np.ndarray, i: float, j: float) -> tuple[float, float, float]:
    """Return the value and its derivatives to `i` and `j` at one place, in samples from the first."""
    row = min(max(math.floor(i), 0), coefficients.shape[0] - 4)
    column = min(max(math.floor(j), 0), coefficients.shape[1] - 4)
    across, across_slope = value_weights(j - column), slope_weights(j - column)
    patch = coefficients[row : row + 4, column : column + 4].tolist()
    value = along = aside = 0.0
    for (a, b, c, d), weight, slope in zip(patch, value_weights(i - row), slope_weights(i - row), strict=True):
        line = a * across[0] + b * across[1] + c * across[2] + d * across[3]
        value += weight * line
        along += slope * line
        aside += weight * (a * across_slope[0] + b * across_slope[1] + c * across_slope[2] + d * across_slope[3])
    return value, along, aside


def evaluate(coefficients: np.ndarray, i: np.ndarray, j: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the same at many places; `i` and `j` have one shape. A little beyond the ends the last cubic goes on."""
    row = np.clip(np.floor(i), 0, coefficients.shape[0] - 4)
    column = np.clip(np.floor(j), 0, coefficients.shape[1] - 4)
    along_weights, along_slopes = value_weights(i - row), slope_weights(i - row)
    across_weights, across_slopes = value_weights(j - column), slope_weights(j - column)
    flat, width = coefficients.ravel(), coefficients.shape[1]
    first = row.astype(np.intp) * width + column.astype(np.intp)
    value, along, aside = np.zeros_like(i), np.zeros_like(i), np.zeros_like(i)
    for a in range(4):
        line, line_slope = np.zeros_like(i), np.zeros_like(i)
        for b in range(4):
            c = flat[first + (a * width + b)]
            line += c * across_weights[b]
            line_slope += c * across_slopes[b]
        value += along_weights[a] * line
        along += along_slopes[a] * line
        aside += along_weights[a] * line_slope
    return value, along, aside


def _along_rows(samples: np.ndarray) -> np.ndarray:
    """Return the coefficients (n + 2, m) of cubic splines down each column of `samples` (n, m).

    Between the samples' equations (c[i-1] + 4 c[i] + c[i+1] = 6 z[i]) the two ends have the same cubic in their first
    two cells; together these give the second and the last but one coefficient, and the rest are a tridiagonal system.
    """
    from scipy.linalg import solve_banded

    z = np.asarray(samples, dtype=float)
    n = len(z)
    c = np.empty((n + 2, *z.shape[1:]))  # c[1 + i] belongs to sample i
    c[2] = (8.0 * z[1] - z[0] - z[2]) / 6.0
    c[n - 1] = (8.0 * z[n - 2] - z[n - 1] - z[n - 3]) / 6.0
    if n > 4:
        right = 6.0 * z[2 : n - 2]
        right[0] -= c[2]
        right[-1] -= c[n - 1]
        if n > 5:
            bands = np.ones((3, n - 4))
            bands[1] = 4.0
            c[3 : n - 1] = solve_banded((1, 1), bands, right, overwrite_b=True, check_finite=False)
        else:
            c[3] = 0.25 * right[0]
    for end, sign in ((1, 1), (n, -1)):
        neighbour = z[1] if sign == 1 else z[n - 2]
        c[end] = 6.0 * neighbour - 4.0 * c[end + sign] - c[end + 2 * sign]
        c[end - sign] = 6.0 * z[end - 1] - 4.0 * c[end] - c[end + sign]
    return c
