"""The plan as smooth functions of planned time, with their first and second derivatives.

One cubic spline runs through every channel of the plan. It is not looked up by the clock but by the skier's progress:
the planned second whose place the skier has reached. A look-up gives values and derivatives that belong together, so
that velocity is `derivative * rate` and acceleration `second derivative * rate^2`, with `rate` the planned seconds that
pass in a second: 1 for a skier who is as fast as planned. Unlike distance, planned time also orders what a skier does
who stands still. Rotations are carried as unit quaternions together with their rotation vector per second.
"""

from __future__ import annotations

import numpy as np

from ..body import SkierModel
from ..frames import continuous_quaternions, quaternion_conjugate, quaternion_from_matrix, quaternion_multiply
from .plan import MotionPlan


class Reference:
    """Spline table over a plan.

    `at(t)` returns (3, width): values, first and second derivatives by planned time. Columns: `com` (3),
    `ski_position` (2 x 3), `joints` (31), `turning` (left ski, right ski, pelvis: world rotation vector per second),
    `along`, `across`, `normal` (3 each: the skis' direction, their left, and up from the snow), `tangent` (3) of the
    track, `quaternion` (as `turning`, x 4), `inclination`, `edge_angle` (2), `curvature`, `speed`, `turn_phase`,
    `steering`, `arc_length`, `load`, `track_position` (3).
    """

    def __init__(self, plan: MotionPlan, model: SkierModel) -> None:
        """Fit the splines through `plan` for the actuated hinges of `model`."""
        from scipy.interpolate import CubicSpline

        self.knots = plan.time
        self.end = plan.duration
        quaternions, turning = _rotations(plan)
        channels = {
            "com": plan.com,
            "ski_position": plan.ski_position.reshape(-1, 6),
            "joints": plan.pose[:, model.actuated_qpos],
            "turning": turning,
            "along": plan.ski_frame[..., 0],
            "across": plan.ski_frame[..., 1],
            "normal": plan.surface_normal,
            "tangent": plan.tangent,
            "quaternion": quaternions,
            "inclination": plan.inclination[:, None],
            "edge_angle": plan.edge_angle,
            "curvature": plan.curvature[:, None],
            "speed": plan.speed[:, None],
            "turn_phase": plan.turn_phase[:, None],
            "steering": plan.steering[:, None],
            "arc_length": plan.arc_length[:, None],
            "load": plan.load[:, None],
            "track_position": plan.position,
        }
        table = np.hstack(list(channels.values()))
        edges = np.concatenate(([0], np.cumsum([block.shape[1] for block in channels.values()])))
        self.columns = {name: slice(int(a), int(b)) for name, a, b in zip(channels, edges, edges[1:], strict=False)}
        self.width = table.shape[1]
        spline = CubicSpline(self.knots, table)
        self._coefficients = np.ascontiguousarray(spline.c.transpose(1, 0, 2))  # (n - 1, 4, width), cubic first
        self._starts = self.knots.tolist()
        self._basis = np.zeros((3, 4))
        self._basis[0, 3] = self._basis[1, 2] = 1.0
        self._basis[2, 1] = 2.0
        self._index = 0

    def table(self) -> np.ndarray:
        """Return the splines' coefficients (intervals, 4, width), cubic first."""
        return self._coefficients

    def interval(self, progress: float) -> int:
        """Return the spline interval of `progress` [s, planned]; quick when it is near that of the last call."""
        starts, i, last = self._starts, self._index, len(self._starts) - 2
        while i < last and progress >= starts[i + 1]:
            i += 1
        while i > 0 and progress < starts[i]:
            i -= 1
        self._index = i
        return i

    def at(self, progress: float) -> np.ndarray:
        """Return values, first and second derivatives (3, width) at `progress` [s, planned]."""
        i = self.interval(progress)
        x = progress - self._starts[i]
        basis = self._basis
        basis[0, 0], basis[0, 1], basis[0, 2] = x * x * x, x * x, x
        basis[1, 0], basis[1, 1] = 3.0 * x * x, 2.0 * x
        basis[2, 0] = 6.0 * x
        return basis @ self._coefficients[i]


def _rotations(plan: MotionPlan) -> tuple[np.ndarray, np.ndarray]:
    """Return quaternions (n, 12) and rotation vectors per second (n, 9) of skis and pelvis, world axes."""
    from scipy.interpolate import CubicSpline

    stacked = np.stack(
        (
            quaternion_from_matrix(plan.ski_rotation[:, 0]),
            quaternion_from_matrix(plan.ski_rotation[:, 1]),
            plan.pose[:, 3:7],
        ),
        axis=1,
    )
    quaternions = continuous_quaternions(stacked)
    slope = CubicSpline(plan.time, quaternions)(plan.time, 1)
    turning = 2.0 * quaternion_multiply(slope, quaternion_conjugate(quaternions))[..., 1:]
    return quaternions.reshape(-1, 12), turning.reshape(-1, 9)
