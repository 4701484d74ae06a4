"""Newton's method for the six multipliers of the root's equations of motion.

Snow moves the skier only through the wrench w = B f that it puts on the whole body. For multipliers z of that wrench
each force is at its best at f(z) = clip(-B'z / r, lower, upper), and what is left to solve is

    F(z) = k + K z - B f(z) = 0.

K is positive definite and -B f(z) grows with z, so that F is the gradient of a strongly convex function made of
quadratic pieces. Newton's steps with a line search therefore find its one zero in finitely many steps from anywhere.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

MOST_STEPS = 60
"""Newton's steps after which the search is given up; three are usual."""
ACCURACY = 1e-9
"""Largest error of F at the end, in units of the wrenches it is the difference of."""


@dataclass(frozen=True)
class DualAnswer:
    """Multipliers `z` (m,), the `forces` (n,) they call for, Newton's `steps`, and whether F(z) `converged` to 0."""

    z: np.ndarray
    forces: np.ndarray
    steps: int
    converged: bool


class DualNewton:
    """Solver for `n` forces; owns its work space, whose arrays the answers show until the next call."""

    def __init__(self, forces: int, weight: float) -> None:
        """Reserve room for `forces` forces, each with the cost `weight` r times half its square."""
        from scipy.linalg import lapack

        self._weight = weight
        self._solve = lapack.dposv
        self._raw, self._clipped = np.zeros(forces), np.zeros(forces)
        self._free = np.zeros(forces, dtype=bool)

    def solve(
        self, K: np.ndarray, k: np.ndarray, B: np.ndarray, lower: np.ndarray, upper: np.ndarray, z: np.ndarray
    ) -> DualAnswer:
        """Return the zero of F for `K` (m, m), `k` (m,), `B` (m, n) and bounds (n,), searched from `z` (m,)."""
        pull = B * (-1.0 / self._weight)
        error, size = self._error(K, k, B, pull, lower, upper, z)
        for step in range(MOST_STEPS):
            if _largest(error) <= ACCURACY * size:
                return DualAnswer(z, self._clipped, step, True)
            slope = K - (pull * self._free) @ B.T
            _, way, failed = self._solve(slope, -error, lower=1)
            if failed:
                break
            ahead = z + way
            new_error, size = self._error(K, k, B, pull, lower, upper, ahead)
            if float(way @ new_error) > ACCURACY * size * _largest(way):
                ahead = z + _turning_point(K, B, pull, lower, upper, z, way, float(way @ error)) * way
                new_error, size = self._error(K, k, B, pull, lower, upper, ahead)
            z, error = ahead, new_error
        return DualAnswer(z, self._clipped, MOST_STEPS, False)

    def _error(
        self,
        K: np.ndarray,
        k: np.ndarray,
        B: np.ndarray,
        pull: np.ndarray,
        lower: np.ndarray,
        upper: np.ndarray,
        z: np.ndarray,
    ) -> tuple[np.ndarray, float]:
        """Return F(z) and the size of its parts; note the forces, and which of them are between their bounds."""
        raw, clipped = self._raw, self._clipped
        np.dot(z, pull, out=raw)
        np.maximum(raw, lower, out=clipped)
        np.minimum(clipped, upper, out=clipped)
        np.equal(raw, clipped, out=self._free)
        wrench = np.dot(B, clipped)
        needed = np.dot(K, z)
        needed += k
        size = _largest(wrench) + _largest(needed) + 1.0  # a sum, for a maximum may hide what is no number
        needed -= wrench
        return needed, size


def _largest(vector: np.ndarray) -> float:
    """Return the largest absolute value of a short vector, quicker than numpy does; nan if any is no number."""
    values: list[float] = vector.tolist()
    return max(max(values), -min(values)) if math.isfinite(sum(values)) else math.nan


def _turning_point(
    K: np.ndarray,
    B: np.ndarray,
    pull: np.ndarray,
    lower: np.ndarray,
    upper: np.ndarray,
    z: np.ndarray,
    way: np.ndarray,
    slope: float,
) -> float:
    """Return where in 0..1 along `way` from `z` the convex function is least; its `slope` there, at 0, is negative.

    Its slope grows along the way and is linear between the places where a force meets a bound.
    """
    here, change = z @ pull, way @ pull
    moving = np.abs(change) > 0.0
    meet = np.concatenate(((lower - here)[moving] / change[moving], (upper - here)[moving] / change[moving]))
    places = np.concatenate(([0.0], np.sort(meet[(meet > 0.0) & (meet < 1.0)]), [1.0]))
    curvature, across = float(way @ K @ way), way @ B
    begin = float(across @ np.clip(here, lower, upper))

    def slope_at(t: float) -> float:
        return slope + t * curvature - float(across @ np.clip(here + t * change, lower, upper)) + begin

    low, high = 0, len(places) - 1
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (middle, high) if slope_at(places[middle]) <= 0.0 else (low, middle)
    before, after = slope_at(places[low]), slope_at(places[high])
    if after <= before:
        return float(places[high])
    share = min(max(-before / (after - before), 0.0), 1.0)
    return float(places[low] + share * (places[high] - places[low]))
