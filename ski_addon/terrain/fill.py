"""Heights for samples that have none: a skin stretched over the holes from the heights round them."""

from __future__ import annotations

import numpy as np

_SWEEPS = 12


def filled(values: np.ndarray, known: np.ndarray) -> np.ndarray:
    """Return `values` (nx, ny) with those that are not `known` made up from the known ones, which stay as they are.

    What is made up lies between the least and the greatest known value and goes on smoothly from its neighbours: the
    mean of the four round it, nearly. At least one value has to be known.
    """
    if np.all(known):
        return np.array(values, dtype=float)
    out = np.where(known, values, 0.0)
    if known.size == 1:
        return out
    # Half as fine first, and so on down to a few samples: sweeps alone would take as many as the hole is wide.
    coarse, there = _halved(out, known)
    rough = np.repeat(np.repeat(filled(coarse, there), 2, axis=0), 2, axis=1)[: known.shape[0], : known.shape[1]]
    out = np.where(known, out, rough)
    for _ in range(_SWEEPS):
        out = np.where(known, out, _mean_of_neighbours(out))
    return out


def _halved(values: np.ndarray, known: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the means of the known values in blocks of two by two, and which blocks have any."""
    pad = [(0, size % 2) for size in values.shape]
    weight = np.pad(known.astype(float), pad)
    blocks = (weight.shape[0] // 2, 2, weight.shape[1] // 2, 2)
    count = weight.reshape(blocks).sum(axis=(1, 3))
    total = np.pad(np.where(known, values, 0.0), pad).reshape(blocks).sum(axis=(1, 3))
    return total / np.maximum(count, 1.0), count > 0.0


def _mean_of_neighbours(values: np.ndarray) -> np.ndarray:
    round_it = np.pad(values, 1, mode="edge")
    return 0.25 * (round_it[:-2, 1:-1] + round_it[2:, 1:-1] + round_it[1:-1, :-2] + round_it[1:-1, 2:])
