"""Phase in a second pass: where in its turn a body is, from a motion that is already known [VP93 sec. 6.2].

Between two crossings of the axes of the phase diagram (lean, lean rate) the motion is taken for a quarter of an
ellipse whose half axes are what it has at the crossings.
"""

from __future__ import annotations

import numpy as np

LEAST = 1e-3
"""Crossings nearer to the origin than this share of the farthest one are noise of a body that goes straight on."""


def estimate_phase(time: np.ndarray, lean: np.ndarray, lean_rate: np.ndarray) -> np.ndarray:
    """Return the phase (n,) [rad] in [0, 2 pi) of a motion with `lean` (n,) [rad] and `lean_rate` (n,) [rad/s].

    0 where the body comes upright on its way to the left, pi / 2 at the greatest lean to the left, as in
    `TurningMotion`. A quarter that the motion leaves by the axis it came from has no crossing of the other axis; it
    takes the nearest one.
    """
    sharpness = _axis(time, lean, lean_rate)
    swing = _axis(time, lean_rate, lean)
    if sharpness is None or swing is None:  # less than half a turn: the other half axis is the largest value seen
        sharpness = np.full_like(lean, max(np.max(np.abs(lean)), 1e-12)) if sharpness is None else sharpness
        swing = np.full_like(lean, max(np.max(np.abs(lean_rate)), 1e-12)) if swing is None else swing
    return phase_of(lean, lean_rate, sharpness, swing)


def estimate_ellipse(
    time: np.ndarray, lean: np.ndarray, lean_rate: np.ndarray
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """Return the half axes (n,) of the motion's ellipses: greatest lean [rad] and greatest lean rate [rad/s]; their
    ratio is the frequency [rad/s]. None for an axis that is never crossed.
    """
    return _axis(time, lean, lean_rate), _axis(time, lean_rate, lean)


def phase_of(lean: np.ndarray, lean_rate: np.ndarray, sharpness: np.ndarray, swing: np.ndarray) -> np.ndarray:
    """Return the phase [rad] in [0, 2 pi) on the ellipse with half axes `sharpness` [rad] and `swing` [rad/s]."""
    angle = np.arctan2(lean * swing, lean_rate * sharpness)
    return np.where(angle < 0.0, np.minimum(angle + 2.0 * np.pi, np.nextafter(2.0 * np.pi, 0.0)), angle)


def _axis(time: np.ndarray, along: np.ndarray, other: np.ndarray) -> np.ndarray | None:
    """Return the half axis (n,) of `along`: its size where `other` crosses zero, held over the quarters beside it.

    From the crossing of one axis to that of the other a quarter has one size; where several crossings of this axis
    follow each other, the change from one to the next is even.
    """
    at, size = _crossings(time, along, other)
    if not len(at):
        return None
    zero_at, _ = _crossings(time, other, along)
    edges, index = _holds(at, zero_at)
    return np.interp(time, edges, size[index])


def _crossings(time: np.ndarray, along: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return when (k,) `other` crosses zero and how large `along` is there (k,)."""
    sign = np.where(other >= 0.0, 1, -1)
    before = np.flatnonzero(np.diff(sign))
    share = other[before] / (other[before] - other[before + 1])
    at = time[before] + share * (time[before + 1] - time[before])
    size = np.abs(along[before] + share * (along[before + 1] - along[before]))
    kept = size > LEAST * np.max(np.abs(along), initial=1e-12)
    return at[kept], size[kept]


def _holds(at: np.ndarray, zero_at: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return knots (k,) and which crossing's size to have there: it changes where the value itself is zero, at once."""
    quarter = np.searchsorted(zero_at, at)
    knots, index = [at[0]], [0]
    for i in range(1, len(at)):
        if quarter[i] > quarter[i - 1]:
            knots += [zero_at[quarter[i] - 1]] * 2
            index += [i - 1, i]
        knots.append(at[i])
        index.append(i)
    return np.array(knots), np.array(index)
