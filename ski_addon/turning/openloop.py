"""Swings without feedback: the paper's first way to turn, a lean that is a sine of time [VP93 sec. 4, Fig. 4]."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .body import TurningBody, support_speed


@dataclass(frozen=True)
class Swing:
    """n moments of m swings, arrays (n, m): `time` (n,) [s]; `x`, `y` [m] of the support, `course` [rad] and
    `curvature` [1/m] of its path; `lean` [rad], `lean_rate` [rad/s]; `leg_force` in body weights.
    """

    time: np.ndarray
    x: np.ndarray
    y: np.ndarray
    course: np.ndarray
    curvature: np.ndarray
    lean: np.ndarray
    lean_rate: np.ndarray
    leg_force: np.ndarray


def swing_open_loop(
    body: TurningBody,
    frequency: Any,
    sharpness: Any,
    speed: Any,
    duration: float,
    step: float = 0.01,
    gravity: float = 9.81,
) -> Swing:
    """Return what becomes of bodies (m,) whose lean is accelerated by -w^2 a sin(w t) [VP93 Eq. 5] on flat ground.

    `frequency` w [rad/s], `sharpness` a [rad] and `speed` [m/s] are numbers or (m,). The lean follows from the
    curvature by forward dynamics, as in the paper, whose integrator this is too: Euler's, the new rate moving the lean
    (the other order drives the swing). The path starts so that it goes along x.
    """
    w, a, v = (np.atleast_1d(np.asarray(value, dtype=float)) for value in (frequency, sharpness, speed))
    time = step * np.arange(round(duration / step) + 1)
    lean, rate = np.zeros_like(a * w * v), w * a * np.ones_like(v)
    course, x, y = 0.0 * lean, 0.0 * lean, 0.0 * lean
    rows = []
    for moment in time:
        curvature = body.curvature_for(lean, -w * w * a * np.sin(w * moment), v, gravity)
        force = np.hypot(*body.leg_force(lean, rate, curvature, v, gravity)) / gravity
        rows.append((x, y, course, curvature, lean, rate, force))
        support = support_speed(lean, curvature, v, body.leg_length)
        x, y = x + step * support * np.cos(course), y + step * support * np.sin(course)
        course = course + step * support * curvature
        rate = rate + step * body.lean_acceleration(lean, curvature, v, gravity)
        lean = lean + step * rate
    columns = [np.array(column) for column in zip(*rows, strict=True)]
    x, y, course = _along_x(columns[0], columns[1], columns[2], w, step)
    return Swing(time, x, y, course, *columns[3:])


def _along_x(
    x: np.ndarray, y: np.ndarray, course: np.ndarray, w: np.ndarray, step: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Turn paths (n, m) so that the chord of their whole swings lies along x."""
    period = 2.0 * np.pi / w / step
    whole = np.rint(np.floor((len(x) - 1) / period) * period).astype(int)
    last, body = np.where(whole > 0, whole, len(x) - 1), np.arange(x.shape[1])
    angle = np.arctan2(y[last, body], x[last, body])
    cosine, sine = np.cos(angle), np.sin(angle)
    return x * cosine + y * sine, y * cosine - x * sine, course - angle
