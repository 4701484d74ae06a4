"""Derivatives over moments that are not quite even, and the three-banded equations that come from them."""

from __future__ import annotations

import numpy as np


class Differences:
    """Second-order differences over n moments [s]; what they need of the moments is worked out once."""

    def __init__(self, time: np.ndarray) -> None:
        """Take the moments (n,) [s], which rise."""
        gaps = np.diff(time)
        before, after = gaps[:-1], gaps[1:]
        both = before + after
        self.step = float(gaps[0])
        self._gaps, self._half = gaps, 0.5 * both
        self._inner = -after / (before * both), (after - before) / (before * after), before / (after * both)
        a, b = gaps[0], gaps[1]
        self._begin = -(2.0 * a + b) / (a * (a + b)), (a + b) / (a * b), -a / (b * (a + b))
        a, b = gaps[-2], gaps[-1]
        self._end = b / (a * (a + b)), -(b + a) / (a * b), (2.0 * b + a) / (b * (a + b))
        self._lower, self._upper = 2.0 / (before * both), 2.0 / (after * both)
        self._middle = -(self._lower + self._upper)

    def first(self, values: np.ndarray) -> np.ndarray:
        """Return the first derivative (n,) of `values` (n,), at the ends to the second order too."""
        out = np.empty_like(values)
        a, b, c = self._inner
        np.multiply(a, values[:-2], out=out[1:-1])
        out[1:-1] += b * values[1:-1]
        out[1:-1] += c * values[2:]
        out[0] = self._begin[0] * values[0] + self._begin[1] * values[1] + self._begin[2] * values[2]
        out[-1] = self._end[0] * values[-3] + self._end[1] * values[-2] + self._end[2] * values[-1]
        return out

    def second(self, values: np.ndarray) -> np.ndarray:
        """Return the second derivative (n,) of `values` (n,); the ends repeat their neighbours."""
        out = np.empty_like(values)
        slope = np.diff(values)
        slope /= self._gaps
        np.divide(np.diff(slope), self._half, out=out[1:-1])
        out[0], out[-1] = out[1], out[-2]
        return out

    def bounded_solution(self, stiffness: np.ndarray, forcing: np.ndarray) -> np.ndarray:
        """Solve y'' - `stiffness` y = `forcing` (n,) with the steady value at both ends (three diagonals)."""
        from scipy.linalg.lapack import dgtsv

        lower, upper = np.append(self._lower, 0.0), np.concatenate(([0.0], self._upper))
        middle = -stiffness
        middle[1:-1] += self._middle
        *_, solution, info = dgtsv(lower, middle, upper, forcing, overwrite_dl=1, overwrite_d=1, overwrite_du=1)
        if info:
            raise np.linalg.LinAlgError("the pendulum's equations are singular")
        return np.asarray(solution)
