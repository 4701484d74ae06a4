"""Where snow can push the skis, and how hard: contact points, directions, bounds, and what forces add up to.

All points of an edge lie on a line, so that of the unknowns of one ski and one direction only three sums count: the
force, and its moments along and across the ski.
"""

from __future__ import annotations

import numpy as np

from ..body import SkierModel
from ..gravity import STANDARD_GRAVITY
from ..snow import Snow, contact_points, edge_bearing
from .dynamics import Dynamics
from .gains import EDGE_SHEAR_RATIO, FORCE_LIMIT_WEIGHTS, FORCE_UNIT, LIFTING_EDGE_WEIGHTS


class ForceBounds:
    """Bounds of the forces in units of `FORCE_UNIT`, by edge angle: `set` fills `lower`, `upper` (2, 2, 2, segments) by
    ski, normal or side, left or right edge.
    """

    def __init__(self, model: SkierModel, snow: Snow, segments: int, lower: np.ndarray, upper: np.ndarray) -> None:
        """Bind to the arrays to be filled."""
        self._lower, self._upper = (bound.reshape(2, 2, 2, segments) for bound in (lower, upper))
        weight = model.mass * STANDARD_GRAVITY / FORCE_UNIT
        self._normal_cap = FORCE_LIMIT_WEIGHTS * weight
        self._shear_cap = EDGE_SHEAR_RATIO * weight
        self._grip = snow.shear_limit / FORCE_UNIT / segments
        self._lifting_cap = LIFTING_EDGE_WEIGHTS * weight / segments
        self._last = [(-1.0, -1.0), (-1.0, -1.0)]

    def set(self, edge_angle: np.ndarray) -> None:
        """Set the bounds for skis at `edge_angle` (2,) [rad]."""
        for ski, angle in enumerate(edge_angle.tolist()):
            bearing = edge_bearing(angle)
            if bearing == self._last[ski]:
                continue
            self._last[ski] = bearing
            normal_left, normal_right, push_left, push_right, slight = self._values(*bearing)
            lower, upper = self._lower[ski], self._upper[ski]
            upper[0, 0], upper[0, 1] = normal_left, normal_right
            upper[1, 0], upper[1, 1] = push_left, slight
            lower[1, 0], lower[1, 1] = -slight, -push_right

    def _values(self, left: float, right: float) -> list[float]:
        """Return the greatest normal forces, the side forces of each edge from its outer side, and the inner one."""
        lifted = min(left, right)
        # the ski's grip is shared by its edges; an edge is pushed across the ski from its outer side only, but
        # while the other edge still bears the ski is flat and can be pushed both ways
        grip = self._grip / (1.0 + lifted)
        most = min(self._shear_cap, grip)
        slight = most if lifted == 1.0 else min(self._lifting_cap, grip) * lifted
        normal = [self._normal_cap if bears == 1.0 else bears * self._lifting_cap for bears in (left, right)]
        side = [most if bears == 1.0 else slight for bears in (left, right)]
        return [*normal, *side, slight]


class SnowPatch:
    """Snow under both skis at one state, for the unknown forces in units of `FORCE_UNIT`.

    Order of the `count` unknowns: ski, normal or side force, left or right edge, segment. After `place`, `wrenches`
    (6, count) are what one unit of each puts on the skier: force [N, world] and moment about the centre of mass [N m];
    after `set_bounds`, `lower` and `upper` (count,).
    """

    def __init__(self, model: SkierModel, snow: Snow, segments: int) -> None:
        """Lay out `segments` points on each of the four edges."""
        self._snow, self.segments = snow, segments
        self.count = 8 * segments
        self.lower, self.upper = np.zeros(self.count), np.zeros(self.count)
        self._bounds = ForceBounds(model, snow, segments, self.lower, self.upper)
        skeleton = model.skeleton
        points = contact_points(skeleton.ski_length, skeleton.ski_width, segments).reshape(-1, 3)
        places = np.vstack((np.ones(len(points)), points[:, :2].T))  # of one ski and one direction: 1, along, left
        self._sums = FORCE_UNIT * np.kron(np.eye(4), places)  # (12, count)
        self._edges = FORCE_UNIT * np.kron(np.eye(8), np.ones(segments))  # (8, count)
        self._columns = np.zeros((12, 6))  # of each sum: its force, and its moment about the centre of mass
        self._frames = np.zeros((2, 6, 6))  # the same about each ski's own middle
        self.wrenches = np.zeros((6, self.count))

    def place(self, dynamics: Dynamics, normal: np.ndarray) -> None:
        """Take the skis' present places and velocities on snow of unit `normal` (3,)."""
        nx, ny, nz = normal.tolist()
        com = dynamics.com.tolist()
        rows: list[list[float]] = []
        for ski in range(2):
            (fx, lx, _), (fy, ly, _), (fz, lz, _) = dynamics.ski_rotation(ski).tolist()
            x, y, z = dynamics.ski_position(ski).tolist()
            fore, left, middle = (fx, fy, fz), (lx, ly, lz), (x - com[0], y - com[1], z - com[2])
            ax, ay, az = ny * fz - nz * fy, nz * fx - nx * fz, nx * fy - ny * fx
            size = (ax * ax + ay * ay + az * az) ** 0.5
            side = (ax / size, ay / size, az / size)
            vx, vy, vz = dynamics.ski_velocity[ski, :3].tolist()
            into = vx * nx + vy * ny + vz * nz
            vx, vy, vz = vx - into * nx, vy - into * ny, vz - into * nz
            speed = (vx * vx + vy * vy + vz * vz) ** 0.5
            drag = float(self._snow.friction_coefficient(speed)) / max(speed, 1e-6)  # against the travel
            push = (nx - drag * vx, ny - drag * vy, nz - drag * vz)
            for direction in (push, side):
                along, across = _cross(fore, direction), _cross(left, direction)
                rows += [[*direction, *_cross(middle, direction)], [0.0, 0.0, 0.0, *along], [0.0, 0.0, 0.0, *across]]
        self._columns[:] = rows
        np.dot(self._columns.T, self._sums, out=self.wrenches)

    def set_bounds(self, edge_angle: np.ndarray) -> None:
        """Set `lower` and `upper` for skis at `edge_angle` (2,) [rad]."""
        self._bounds.set(edge_angle)

    def ski_wrenches(self, forces: np.ndarray) -> np.ndarray:
        """Return force [N] and moment about the ski's middle [N m] of the snow on each ski (2, 6), world axes."""
        frames = self._frames
        frames[:] = self._columns.reshape(2, 6, 6)
        frames[:, ::3, 3:] = 0.0
        sums = (self._sums @ forces).reshape(2, 1, 6)
        return np.matmul(sums, frames)[:, 0]

    def edge_forces(self, forces: np.ndarray) -> np.ndarray:
        """Return the sum of `forces` (count,) on each ski, by normal or side force and edge (2, 2, 2) [N]."""
        return (self._edges @ forces).reshape(2, 2, 2)

    def load_moments(self, dynamics: Dynamics, forces: np.ndarray) -> np.ndarray:
        """Return, for each ski, its normal forces times their places from the ski's middle (2, 3) [N m, world]."""
        sums = (self._sums @ forces).reshape(2, 6, 1)
        return np.matmul(dynamics.ski_rotations[:, :, :2], sums[:, 1:3])[..., 0]


def _cross(a: tuple[float, float, float], b: tuple[float, float, float]) -> tuple[float, float, float]:
    ax, ay, az = a
    bx, by, bz = b
    return ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
