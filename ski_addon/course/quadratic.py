"""A small convex quadratic program with sparse matrices, by a primal-dual interior-point method."""

from __future__ import annotations

from typing import Any

import numpy as np

_STEPS = 60
_TOLERANCE = 1e-12
_CENTRING = 0.15
_SHORTER = 0.97


def solve_quadratic(
    cost: Any, pull: np.ndarray, rows: Any, values: np.ndarray, below: Any, softness: float
) -> np.ndarray:
    """Return the x that minimises x' cost x / 2 - pull' x with rows x = values and, as nearly as it can, below x <= 0.

    Matrices are scipy's sparse ones: `cost` (n, n) positive semidefinite, `rows` (m, n), `below` (k, n). What is left
    over of `below x` costs its square divided by twice the `softness`, so that there always is a solution.
    """
    from scipy import sparse
    from scipy.sparse.linalg import splu

    n, m = len(pull), len(values)

    def step(extra: Any, first: np.ndarray, second: np.ndarray) -> np.ndarray:
        upper = (cost + extra).tocsc()
        system = sparse.bmat([[upper, rows.T], [rows, None]], format="csc") if m else upper
        return splu(system).solve(np.concatenate((first, second)))

    nothing = sparse.csr_matrix((n, n))
    x = step(nothing, pull, values)[:n]
    if not below.shape[0]:
        return x
    size = max(float(np.max(np.abs(below @ x))), 1e-6)
    slack, force = np.maximum(-(below @ x), 0.1 * size), np.full(below.shape[0], size)
    multiplier = np.zeros(m)
    for _ in range(_STEPS):
        target = _CENTRING * float(slack @ force) / len(slack)
        dual = cost @ x - pull + rows.T @ multiplier + below.T @ force
        missing = below @ x - softness * force + slack
        ratio = 1.0 / (slack / force + softness)
        lead = ratio * (missing + target / force - slack)
        move = step(below.T @ sparse.diags(ratio) @ below, -dual - below.T @ lead, values - rows @ x)
        force_step = ratio * (below @ move[:n]) + lead
        slack_step = target / force - slack - slack / force * force_step
        length = min(1.0, _SHORTER * _reach(slack, slack_step), _SHORTER * _reach(force, force_step))
        x, multiplier = x + length * move[:n], multiplier + length * move[n:]
        slack, force = slack + length * slack_step, force + length * force_step
        if float(np.max(slack * force)) < _TOLERANCE * size**2 and float(np.max(np.abs(missing))) < 1e-10:
            break
    return x


def _reach(value: np.ndarray, step: np.ndarray) -> float:
    """Return how many steps keep positive values positive."""
    shrinking = step < 0.0
    return float(np.min(-value[shrinking] / step[shrinking])) if shrinking.any() else np.inf
