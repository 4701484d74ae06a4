"""Look up samples between samples: linear for vectors, slerp for rotations."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..frames import Array


@dataclass(frozen=True)
class Bracket:
    """Where query times fall among sample times: between samples `low` and `high`, `share` (0..1) of the way."""

    low: Array  # (m,) int
    high: Array  # (m,) int
    share: Array  # (m,)


def bracket(sample_time: Array, query: Array) -> Bracket:
    """Locate `query` (m,) [s] in the rising `sample_time` (n,) [s]; queries outside are held at the ends."""
    sample_time = np.asarray(sample_time, dtype=float)
    query = np.clip(np.asarray(query, dtype=float), sample_time[0], sample_time[-1])
    if len(sample_time) == 1:
        zero = np.zeros(len(query), dtype=int)
        return Bracket(zero, zero, np.zeros(len(query)))
    high = np.clip(np.searchsorted(sample_time, query, side="right"), 1, len(sample_time) - 1)
    low = high - 1
    share = (query - sample_time[low]) / (sample_time[high] - sample_time[low])
    return Bracket(low, high, share)


def linear(values: Array, where: Bracket) -> Array:
    """Interpolate `values` (n, ...) linearly at `where`; returns (m, ...)."""
    values = np.asarray(values, dtype=float)
    share = where.share.reshape((-1,) + (1,) * (values.ndim - 1))
    return values[where.low] * (1.0 - share) + values[where.high] * share


def slerp(a: Array, b: Array, share: Array) -> Array:
    """Return the rotation `share` (...) of the shorter way from unit quaternions `a` to `b` (..., 4)."""
    dot = np.sum(a * b, axis=-1, keepdims=True)
    b = np.where(dot < 0.0, -b, b)
    angle = np.arccos(np.clip(np.abs(dot), 0.0, 1.0))
    share = np.asarray(share)[..., None]
    near = angle < 1e-4
    sine = np.where(near, 1.0, np.sin(angle))
    weight_a = np.where(near, 1.0 - share, np.sin((1.0 - share) * angle) / sine)
    weight_b = np.where(near, share, np.sin(share * angle) / sine)
    mixed = weight_a * a + weight_b * b
    return mixed / np.linalg.norm(mixed, axis=-1, keepdims=True)
