"""Fewer keys: those are dropped that straight lines between the kept ones come near enough to. Vectorised."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..errors import SpecError
from ..frames import Array
from .rotation_modes import from_mode


def kept_keys(frame: Array, values: Array, tolerance: float, error: Callable[[Array, Array], Array]) -> Array:
    """Return the indices (k,) of the keys to keep, first and last always.

    `frame` (m,) rises, `values` (m, c) are what the curves show there, and `error(between, values)` (m,) says how far
    values between the kept keys, on straight lines, are from the true ones; it stays at or below `tolerance`. In every
    round each gap with too large an error keeps its worst key, all gaps at once.
    """
    if not tolerance >= 0.0:
        raise SpecError("reduction.tolerance", tolerance, "0 or more", "0 keeps every key")
    count = len(frame)
    keep = np.zeros(count, dtype=bool)
    keep[[0, -1]] = True
    if tolerance == 0.0:
        return np.arange(count)
    while True:
        index = np.flatnonzero(keep)
        between = np.stack([np.interp(frame, frame[index], column[index]) for column in values.T], axis=1)
        wrong = np.where(keep, 0.0, error(between, values))
        worst = np.maximum.reduceat(wrong, index[:-1]) if len(index) > 1 else np.zeros(0)
        gap = np.clip(np.searchsorted(index, np.arange(count), side="right") - 1, 0, len(index) - 2)
        new = (wrong > tolerance) & (wrong == worst[gap]) if len(worst) else np.zeros(count, dtype=bool)
        if not new.any():
            return index
        keep |= new


def kept_rotations(frame: Array, values: Array, mode: str, degrees: float) -> Array:
    """Return the keys to keep of rotations `values` (m, c) in Blender's rotation `mode`, to within `degrees`."""
    if mode == "QUATERNION":
        return kept_keys(frame, values, degrees, lambda a, b: _angle(from_mode(a, mode), b))
    return kept_keys(frame, values, degrees, lambda a, b: _angle(from_mode(a, mode), from_mode(b, mode)))


def kept_places(frame: Array, values: Array, distance: float) -> Array:
    """Return the keys to keep of places `values` (m, 3), to within `distance` in their own unit."""
    return kept_keys(frame, values, distance, lambda a, b: np.linalg.norm(a - b, axis=1))


def kept_numbers(frame: Array, values: Array, share: float) -> Array:
    """Return the keys to keep of numbers `values` (m,), to within a `share` of the range from least to greatest."""
    if share == 0.0:
        return np.arange(len(frame))
    span = float(np.ptp(values)) if len(values) else 0.0
    tolerance = max(share * span, 1e-30)  # of numbers that never change two keys are enough
    return kept_keys(frame, np.asarray(values)[:, None], tolerance, lambda a, b: np.abs(a - b)[:, 0])


def _angle(a: Array, b: Array) -> Array:
    """Return the angle (m,) [degrees] between rotations (m, 4)."""
    b = np.where(np.sum(a * b, axis=1, keepdims=True) < 0.0, -b, b)
    return np.degrees(4.0 * np.arcsin(np.clip(0.5 * np.linalg.norm(a - b, axis=1), 0.0, 1.0)))
