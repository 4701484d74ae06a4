"""Where the skis stand and where the snow carries them: zero-moment point, support and distances from the plan."""

from __future__ import annotations

import math

import numpy as np

from ..control import Command, Dynamics, rotation_error
from ..planning import Reference
from ..snow import edge_bearing


class SkiGauge:
    """Measures skis against references and their support."""

    def __init__(self, dynamics: Dynamics, reference: Reference) -> None:
        """Bind to the skier and the original plan."""
        self._dynamics, self._columns = dynamics, reference.columns
        skeleton = dynamics.model.skeleton
        self._half_length, self._half_width = 0.5 * skeleton.ski_length, 0.5 * skeleton.ski_width
        ends = (self._half_length, -self._half_length)
        edges = (self._half_width, -self._half_width)
        self._corners = np.array([(x, y, 0.0) for x in ends for y in edges]).T.copy()

    def corner_error(self, offset: np.ndarray, turn: np.ndarray) -> float:
        """Return the largest distance [m] of a ski corner from where it should be, for skis that are `offset` (2, 3)
        [m] and `turn` (2, 3) [rad, world] from there.
        """
        worst = 0.0
        for ski in range(2):
            x, y, z = turn[ski].tolist()
            cross = np.array(((0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)))
            error = offset[ski][:, None] + cross @ (self._dynamics.ski_rotation(ski) @ self._corners)
            worst = max(worst, float((error * error).sum(axis=0).max()))
        return math.sqrt(worst)

    def planned_error(self, value: np.ndarray) -> float:
        """Return the largest distance [m] of a ski corner from the plan, whose reference is `value` (width,)."""
        dynamics, columns = self._dynamics, self._columns
        offset = value[columns["ski_position"]].reshape(2, 3) - self._middles()
        quaternions = value[columns["quaternion"]].tolist()
        turn = [
            rotation_error(quaternions[4 * ski : 4 * ski + 4], dynamics.xquat[dynamics.model.ski_body[ski]].tolist())
            for ski in range(2)
        ]
        return self.corner_error(offset, np.array(turn))

    def track_offset(self, value: np.ndarray) -> tuple[float, float]:
        """Return how far [m] to the left of the plan `value` (width,) the middle of the skis and the centre of mass
        are, across the track.
        """
        columns = self._columns
        left = _cross(value[columns["normal"]], value[columns["tangent"]])
        planned = value[columns["ski_position"]]
        skis = self._middles().sum(axis=0) - planned[:3] - planned[3:]
        return 0.5 * float(left @ skis), float(left @ (self._dynamics.com - value[columns["com"]]))

    def zero_moment_point(self, command: Command, normal: np.ndarray) -> tuple[float, float, float]:
        """Return where the load acts, along and to the left of the skis from their middle [m], and how far that is from
        the border of the edges that bear. Zeros when no snow carries the skier.
        """
        load = command.edge_normal.sum(axis=1)
        total = float(load.sum())
        if total < 1e-6:
            return 0.0, 0.0, 0.0
        dynamics = self._dynamics
        heading = dynamics.ski_rotation(0)[:, 0] + dynamics.ski_rotation(1)[:, 0]
        left = _cross(normal, heading)
        left = left / math.sqrt(left @ left)
        axes = np.stack((_cross(left, normal), left))
        middles = self._middles()
        half = 0.5 * (middles[0] - middles[1])
        place = (half * (float(load[0]) - float(load[1])) + command.load_moment.sum(axis=0)) / total
        x, y = (axes @ place).tolist()
        apart_x, apart_y = (axes @ half).tolist()
        return x, y, self._border(x, y, apart_x, apart_y, command.edge_angle)

    def _border(self, x: float, y: float, apart_x: float, apart_y: float, edge_angle: np.ndarray) -> float:
        """Return the distance [m] of a point from the border of the bearing edges; the left ski is at `apart_x`,
        `apart_y`, the right one opposite.
        """
        left, right, front = [], [], self._half_length + abs(apart_x)
        for side, angle in zip((1.0, -1.0), edge_angle.tolist(), strict=True):
            half = self._half_width * math.cos(angle)
            bears_left, bears_right = edge_bearing(angle)
            left.append(side * apart_y + half * (2.0 * bears_left - 1.0))
            right.append(side * apart_y - half * (2.0 * bears_right - 1.0))
        return min(max(left) - y, y - min(right), front - abs(x))

    def _middles(self) -> np.ndarray:
        return np.stack((self._dynamics.ski_position(0), self._dynamics.ski_position(1)))


def _cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    ax, ay, az = a.tolist()
    bx, by, bz = b.tolist()
    return np.array((ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx))
