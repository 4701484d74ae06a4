"""The desired path with all that the ground does along it: speed and gravity by the nearest sample."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from ...errors import SpecError
from ...frames import Array
from ...gravity import STANDARD_GRAVITY
from .desired_path import FURTHEST, DesiredPath

SPEED_MIN, SPEED_MAX = 1.0, 60.0
"""Speeds [m/s] at which a lean can be kept up by steering."""
_BACK, _AHEAD = 2.5, 2.0
"""How far back and ahead of where it is expected the nearest sample is looked for [m]."""
Speed = float | Array | Callable[[Array], Array]


@dataclass(frozen=True)
class Lane:
    """A desired path and, at its samples, `speed` (m,) [m/s], gravity into the ground `normal` (m,) and along it
    `pull` (m, 2) [m/s^2], in the plan view's axes.

    A body beside the path has the speed and the ground of the sample it is nearest to.
    """

    path: DesiredPath
    speed: Array
    normal: Array
    pull: Array

    @cached_property
    def tilted(self) -> bool:
        """Whether gravity pulls along the ground anywhere."""
        return bool(np.any(self.pull))

    @cached_property
    def samples_per_second(self) -> Array:
        """How many samples (m,) of the path a body passes in a second."""
        return np.asarray(self.speed / np.append(np.diff(self.path.along), np.inf).clip(max=FURTHEST))

    @cached_property
    def window(self) -> tuple[int, Array, Array]:
        """Samples before and windows (m, w) of x and y of the samples about each sample."""
        step = float(np.median(np.diff(self.path.along)))
        back, ahead = (int(np.ceil(reach / step)) for reach in (_BACK, _AHEAD))
        padded = np.concatenate((np.full((back, 2), 1e6), self.path.places, np.full((ahead, 2), 1e6)))
        x, y = (np.ascontiguousarray(sliding_window_view(padded[:, axis], back + ahead + 1)) for axis in (0, 1))
        return back, x, y

    def nearest(self, x: Array, y: Array, hint: Array) -> tuple[Array, Array]:
        """Return the indices (n,) of the samples nearest to `x`, `y` (n,), looked for about `hint` (n,), and the
        distances (n,) [m].
        """
        back, window_x, window_y = self.window
        off_x, off_y = window_x[hint] - x[:, None], window_y[hint] - y[:, None]
        square = off_x * off_x + off_y * off_y
        best = square.argmin(axis=1)
        return hint + best - back, np.sqrt(square[np.arange(len(best)), best])

    def nearest_of_all(self, place: Array) -> int:
        """Return the index of the path's sample nearest to `place` (2,)."""
        return int(np.argmin(np.linalg.norm(self.path.places[: self.path.last + 1] - place, axis=1)))


def lane_on_flat(path: DesiredPath, speed: Speed) -> Lane:
    """Return `path` on flat ground with `speed` [m/s]: one number, one for each sample, or a function of places (m, 2).

    Raises `SpecError` for a speed at which nobody can balance by steering.
    """
    values = speed(path.places) if callable(speed) else speed
    normal = np.full(len(path.along), STANDARD_GRAVITY)
    return lane_with(path, values, normal, np.zeros((len(path.along), 2)))


def lane_with(path: DesiredPath, speed: Array | float, normal: Array, pull: Array) -> Lane:
    """Return the lane of checked `speed` and the given gravity; see `Lane`."""
    speed = np.broadcast_to(np.asarray(speed, dtype=float), path.along.shape).copy()
    wrong = np.flatnonzero(~((speed >= SPEED_MIN) & (speed <= SPEED_MAX)))
    if len(wrong):
        x, y = path.places[wrong[0]]
        hint = f"at x = {x:.1f}, y = {y:.1f}: balance by steering needs some speed"
        raise SpecError("speed", float(speed[wrong[0]]), f"{SPEED_MIN:g}..{SPEED_MAX:g} m/s", hint)
    return Lane(path, speed, normal, pull)
