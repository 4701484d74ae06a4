"""Small convex quadratic programs, with sparse matrices or between bounds, by a primal-dual interior-point method."""

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


def solve_between(cost: np.ndarray, pull: np.ndarray, low: float, high: float, softness: float) -> np.ndarray:
    """Return the x (n,) that minimises x' C x / 2 - pull' x and, as nearly as it can, lies between `low` and `high`.

    `cost` (b + 1, n) are the diagonals of the positive definite C from the outermost upper one to the main one, as for
    scipy's `solveh_banded`; `softness` as in `solve_quadratic`, with whose steps this goes, in a fraction of the time.
    """
    from scipy.linalg import solveh_banded

    def beyond(x: np.ndarray) -> np.ndarray:
        return np.stack((x - high, low - x))

    x = solveh_banded(cost, pull, check_finite=False)
    size = max(float(np.max(np.abs(beyond(x)))), 1e-6)
    slack, force = np.maximum(-beyond(x), 0.1 * size), np.full((2, len(x)), size)
    stiffened = cost.copy()
    for _ in range(_STEPS):
        target = _CENTRING * float(np.sum(slack * force)) / slack.size
        dual = _times(cost, x) - pull + force[0] - force[1]
        missing = beyond(x) - softness * force + slack
        ratio = 1.0 / (slack / force + softness)
        lead = ratio * (missing + target / force - slack)
        stiffened[-1] = cost[-1] + ratio[0] + ratio[1]
        move = solveh_banded(stiffened, lead[1] - lead[0] - dual, check_finite=False)
        force_step = ratio * np.stack((move, -move)) + lead
        slack_step = target / force - slack - slack / force * force_step
        length = min(1.0, _SHORTER * _reach(slack, slack_step), _SHORTER * _reach(force, force_step))
        x, slack, force = x + length * move, slack + length * slack_step, force + length * force_step
        if float(np.max(slack * force)) < _TOLERANCE * size**2 and float(np.max(np.abs(missing))) < 1e-10:
            break
    return x


def _times(bands: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Return the product of a symmetric matrix, by its upper diagonals `bands` (b + 1, n), and `x` (n,)."""
    out = bands[-1] * x
    for off in range(1, len(bands)):
        diagonal = bands[-1 - off, off:]
        out[:-off] += diagonal * x[off:]
        out[off:] += diagonal * x[:-off]
    return out


def _reach(value: np.ndarray, step: np.ndarray) -> float:
    """Return how many steps keep positive values positive."""
    shrinking = step < 0.0
    return float(np.min(-value[shrinking] / step[shrinking])) if shrinking.any() else np.inf
