"""Collects a run step by step, in arrays that grow by doubling."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from .recording import COUNTS, SHAPES, Recording


class Recorder:
    """Append-only store of steps: `add` what a step has at hand, `fill` in what is worked out for many at once."""

    def __init__(self, expected: int, numbers: Iterable[str] = (), arrays: Iterable[str] = ()) -> None:
        """Reserve room for about `expected` steps, whose `add` brings the values called `numbers` and `arrays`."""
        widths = [int(np.prod(shape, dtype=int)) for shape in SHAPES.values()]
        edges = np.concatenate(([0], np.cumsum(widths)))
        self._slices = {name: slice(int(a), int(b)) for name, a, b in zip(SHAPES, edges, edges[1:], strict=False)}
        self._numbers = [self._slices[name].start for name in numbers]
        self._arrays = [self._slices[name] for name in arrays]
        self._reals = np.zeros((max(expected, 64), int(edges[-1])))
        self._counts = np.zeros((max(expected, 64), len(COUNTS)), dtype=np.int32)
        self.count = 0

    def add(self, numbers: tuple[float, ...], arrays: tuple[np.ndarray, ...], counts: tuple[int, ...]) -> None:
        """Append one step: its numbers, its arrays, each of any shape, and its `COUNTS`."""
        if self.count == len(self._reals):
            self._reals = np.concatenate((self._reals, np.zeros_like(self._reals)))
            self._counts = np.concatenate((self._counts, np.zeros_like(self._counts)))
        row = self._reals[self.count]
        for column, number in zip(self._numbers, numbers, strict=True):
            row[column] = number
        for place, array in zip(self._arrays, arrays, strict=True):
            row[place] = array if array.ndim == 1 else array.reshape(-1)
        self._counts[self.count] = counts
        self.count += 1

    def fill(self, begin: int, columns: Mapping[str, np.ndarray]) -> None:
        """Set more columns (n, ...) of the n steps from `begin` on."""
        for name, values in columns.items():
            if name in COUNTS:
                self._counts[begin : begin + len(values), list(COUNTS).index(name)] = values
            else:
                self._reals[begin : begin + len(values), self._slices[name]] = values.reshape(len(values), -1)

    def rows(self, name: str, begin: int) -> np.ndarray:
        """Return a view of the real numbers recorded under `name` from step `begin` on, (n, ...)."""
        place = self._slices[name]
        return self._reals[begin : self.count, place].reshape(self.count - begin, *SHAPES[name])

    def refill(self, recording: Recording, count: int) -> None:
        """Begin with the first `count` steps of `recording`."""
        self._make_room(count)
        self.fill(0, {name: getattr(recording, name)[:count] for name in (*SHAPES, *COUNTS)})
        self.count = count

    def table(self) -> tuple[np.ndarray, np.ndarray]:
        """Return views of everything recorded: real numbers (count, width) and whole ones (count, len(COUNTS))."""
        return self._reals[: self.count], self._counts[: self.count]

    def set_table(self, reals: np.ndarray, counts: np.ndarray) -> None:
        """Begin with what `table` of another recorder gave; raises `ValueError` if it is none."""
        shapes = (len(reals), self._reals.shape[1]), (len(reals), len(COUNTS))
        if (reals.shape, counts.shape) != shapes or reals.dtype != float or counts.dtype != np.int32:
            raise ValueError(f"steps are {reals.dtype} {reals.shape} and {counts.dtype} {counts.shape}")
        self._make_room(len(reals))
        self.count = len(reals)
        self._reals[: self.count], self._counts[: self.count] = reals, counts

    def _make_room(self, count: int) -> None:
        """Have new arrays if `count` steps do not fit into the present ones."""
        if count > len(self._reals):
            self._reals = np.zeros((2 * count, self._reals.shape[1]))
            self._counts = np.zeros((2 * count, len(COUNTS)), dtype=np.int32)

    def column(self, name: str) -> np.ndarray:
        """Return what has been recorded under `name`, (count, ...)."""
        if name in COUNTS:
            return self._counts[: self.count, list(COUNTS).index(name)].astype(COUNTS[name])
        return self.rows(name, 0).copy()

    def recording(self, header: dict[str, Any]) -> Recording:
        """Return everything recorded so far under `header`."""
        return Recording(header, **{name: self.column(name) for name in (*SHAPES, *COUNTS)})
