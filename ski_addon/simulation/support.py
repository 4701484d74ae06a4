"""Where the skis stand and where the snow carries them: zero-moment point, support and distances from the plan.

Everything here is of n steps at once: what is only looked at is worked out after the steps were made.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..body import Skeleton
from ..frames import quaternion_conjugate, quaternion_multiply
from ..snow import edge_bearings


@dataclass(frozen=True)
class SkiStates:
    """The skis at n steps: `place` (n, 2, 3) [m, world] of their middles, `rotation` (n, 2, 3, 3) and `quaternion`
    (n, 2, 4), world from ski.
    """

    place: np.ndarray
    rotation: np.ndarray
    quaternion: np.ndarray


class SkiGauge:
    """Measures skis against references and their support."""

    def __init__(self, skeleton: Skeleton, columns: dict[str, slice]) -> None:
        """Take the skis' size, and the `columns` of reference values."""
        self._columns = columns
        self._half_length, self._half_width = 0.5 * skeleton.ski_length, 0.5 * skeleton.ski_width
        ends = (self._half_length, -self._half_length)
        edges = (self._half_width, -self._half_width)
        self._corners = np.array([(x, y, 0.0) for x in ends for y in edges]).T.copy()

    def corner_error(self, rotation: np.ndarray, offset: np.ndarray, turn: np.ndarray) -> np.ndarray:
        """Return the largest distance (n,) [m] of a ski corner from where it should be, for skis of `rotation`
        (n, 2, 3, 3) that are `offset` (n, 2, 3) [m] and `turn` (n, 2, 3) [rad, world] from there.
        """
        corners = np.swapaxes(rotation @ self._corners, -1, -2)  # (n, 2, 4, 3)
        error = offset[..., None, :] + np.cross(turn[..., None, :], corners)
        return np.sqrt(np.sum(error * error, axis=-1).max(axis=(1, 2)))

    def planned_error(self, value: np.ndarray, skis: SkiStates) -> np.ndarray:
        """Return the largest distance (n,) [m] of a ski corner from the plan, whose reference is `value` (n, width)."""
        columns = self._columns
        offset = value[:, columns["ski_position"]].reshape(-1, 2, 3) - skis.place
        planned = value[:, columns["quaternion"]].reshape(-1, 3, 4)[:, :2]
        turn = quaternion_multiply(planned, quaternion_conjugate(skis.quaternion))
        turn = np.where(turn[..., :1] < 0.0, -turn, turn)
        sine = np.sqrt(np.sum(turn[..., 1:] ** 2, axis=-1))
        safe = np.maximum(sine, 1e-9)
        factor = np.where(sine > 1e-9, 2.0 * np.arctan2(sine, turn[..., 0]) / safe, 2.0 / turn[..., 0])
        return self.corner_error(skis.rotation, offset, factor[..., None] * turn[..., 1:])

    def track_offset(self, value: np.ndarray, place: np.ndarray, com: np.ndarray) -> np.ndarray:
        """Return how far (n, 2) [m] to the left of the plan `value` (n, width) the middle of skis at `place` (n, 2, 3)
        and the centre of mass `com` (n, 3) are, across the track.
        """
        columns = self._columns
        left = np.cross(value[:, columns["normal"]], value[:, columns["tangent"]])
        planned = value[:, columns["ski_position"]].reshape(-1, 2, 3)
        skis = 0.5 * np.sum(place - planned, axis=1)
        return np.stack((_dots(left, skis), _dots(left, com - value[:, columns["com"]])), axis=1)

    def zero_moment_point(
        self, skis: SkiStates, load: np.ndarray, load_moment: np.ndarray, edge_angle: np.ndarray, normal: np.ndarray
    ) -> np.ndarray:
        """Return where the load acts, along and to the left of the skis from their middle [m], and how far that is from
        the border of the edges that bear (n, 3). Zeros where no snow carries the skier.

        `load` (n, 2) [N] and `load_moment` (n, 2, 3) [N m, world] of each ski, as in `Effort`; `edge_angle` (n, 2)
        [rad]; `normal` (n, 3) of the snow.
        """
        total = np.sum(load, axis=1)
        carried = total >= 1e-6
        heading = np.sum(skis.rotation[..., 0], axis=1)
        left = np.cross(normal, heading)
        left /= np.sqrt(_dots(left, left))[:, None]
        along = np.cross(left, normal)
        half = 0.5 * (skis.place[:, 0] - skis.place[:, 1])
        moment = half * (load[:, :1] - load[:, 1:]) + np.sum(load_moment, axis=1)
        place = moment / np.where(carried, total, 1.0)[:, None]
        x, y = _dots(along, place), _dots(left, place)
        border = self._border(x, y, _dots(along, half), _dots(left, half), edge_angle)
        return np.where(carried[:, None], np.stack((x, y, border), axis=1), 0.0)

    def _border(
        self, x: np.ndarray, y: np.ndarray, apart_x: np.ndarray, apart_y: np.ndarray, edge_angle: np.ndarray
    ) -> np.ndarray:
        """Return the distance (n,) [m] of a point from the border of the bearing edges; the left ski is at `apart_x`,
        `apart_y` (n,), the right one opposite.
        """
        middle = np.stack((apart_y, -apart_y), axis=1)
        reach = self._half_width * np.cos(edge_angle)[..., None] * (2.0 * edge_bearings(edge_angle) - 1.0)
        left, right = np.max(middle + reach[..., 0], axis=1), np.min(middle - reach[..., 1], axis=1)
        front = self._half_length + np.abs(apart_x)
        return np.minimum(np.minimum(left - y, y - right), front - np.abs(x))


def _dots(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return the scalar products (n,) of vectors (n, 3)."""
    return np.einsum("ni,ni->n", a, b)
