"""Collects a run step by step, in arrays that grow by doubling."""

from __future__ import annotations

from typing import Any

import numpy as np

from .recording import COUNTS, SHAPES, Recording


class Recorder:
    """Append-only store of steps; `add` takes one value for every name of `SHAPES` and `COUNTS`."""

    def __init__(self, expected: int) -> None:
        """Reserve room for about `expected` steps."""
        widths = [int(np.prod(shape, dtype=int)) for shape in SHAPES.values()]
        edges = np.concatenate(([0], np.cumsum(widths)))
        self._slices = [slice(int(a), int(b)) for a, b in zip(edges, edges[1:], strict=False)]
        self._reals = np.empty((max(expected, 64), int(edges[-1])))
        self._counts = np.empty((max(expected, 64), len(COUNTS)), dtype=np.int32)
        self.count = 0

    def add(self, reals: tuple[Any, ...], counts: tuple[int, ...]) -> None:
        """Append one step: values in the order of `SHAPES` and of `COUNTS`."""
        if self.count == len(self._reals):
            self._reals = np.concatenate((self._reals, np.empty_like(self._reals)))
            self._counts = np.concatenate((self._counts, np.empty_like(self._counts)))
        row = self._reals[self.count]
        for place, value in zip(self._slices, reals, strict=True):
            row[place] = value.reshape(-1) if isinstance(value, np.ndarray) else value
        self._counts[self.count] = counts
        self.count += 1

    def refill(self, recording: Recording, count: int) -> None:
        """Begin with the first `count` steps of `recording`."""
        missing = count - len(self._reals)
        if missing > 0:
            self._reals = np.empty((2 * count, self._reals.shape[1]))
            self._counts = np.empty((2 * count, len(COUNTS)), dtype=np.int32)
        for name, place in zip(SHAPES, self._slices, strict=True):
            self._reals[:count, place] = getattr(recording, name)[:count].reshape(count, -1)
        for column, name in enumerate(COUNTS):
            self._counts[:count, column] = getattr(recording, name)[:count]
        self.count = count

    def column(self, name: str) -> np.ndarray:
        """Return what has been recorded under `name`, (count, ...)."""
        if name in COUNTS:
            return self._counts[: self.count, list(COUNTS).index(name)].astype(COUNTS[name])
        place = self._slices[list(SHAPES).index(name)]
        return self._reals[: self.count, place].reshape(self.count, *SHAPES[name]).copy()

    def recording(self, header: dict[str, Any]) -> Recording:
        """Return everything recorded so far under `header`."""
        return Recording(header, **{name: self.column(name) for name in (*SHAPES, *COUNTS)})
