"""Fixed points found sooner: corrections that learn from how the two before were answered (Anderson's mixing)."""

from __future__ import annotations

import numpy as np

Array = np.ndarray


class Mixing:
    """Steps (k, n) towards where a change (k, n) vanishes; each of the n columns is a problem of its own.

    A plain iteration steps by the change itself. Here that part of the change is left out which the last two steps say
    will be answered: with changes f_i at x_i, the step is f - sum a_j (df_j + dx_j) for the a that make |f - sum a_j
    df_j| least [Walker & Ni 2011, Anderson acceleration for fixed-point iterations].
    """

    def __init__(self) -> None:
        """Begin with a plain step."""
        self._change: Array | None = None
        self._step = np.zeros(0)
        self._answers: list[tuple[Array, Array]] = []

    def step(self, change: Array) -> Array:
        """Return the next step (k, n) from where the `change` (k, n) was found."""
        step = change
        if self._change is not None:
            answer = change - self._change
            self._answers = [(answer, answer + self._step), *self._answers[:1]]
            step = self._mixed(change)
        self._change, self._step = change, step
        return step

    def _mixed(self, change: Array) -> Array:
        (last, moved), *older = self._answers
        own, along = dot(last, last), dot(last, change)
        share = along / np.maximum(own, 1e-300)
        if not older:
            return change - share * moved
        ((other, moved_before),) = older
        square, across, aside = dot(other, other), dot(last, other), dot(other, change)
        area = own * square - across * across
        apart = area > 1e-9 * own * square  # else both say the same, and the last one is enough
        area = np.where(apart, area, 1.0)
        share = np.where(apart, (square * along - across * aside) / area, share)
        return change - share * moved - np.where(apart, (own * aside - across * along) / area, 0.0) * moved_before


def dot(a: Array, b: Array) -> Array:
    """Return the dot products (...) of vectors by their components (k, ...)."""
    return np.einsum("i...,i...->...", a, b)
