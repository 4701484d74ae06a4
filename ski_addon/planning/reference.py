"""The plan as smooth functions of arc length, with their first and second derivatives.

One cubic spline runs through every channel of the plan. A look-up at the skier's own progress gives values and
derivatives that belong together, so that `rate = derivative * progress rate` and
`acceleration = second derivative * rate^2 + derivative * rate'` are exact for the motion that is tracked.
Rotations are carried as unit quaternions together with their rotation vector per metre, both as channels.
"""

from __future__ import annotations

import numpy as np

from ..body import SkierModel
from ..frames import continuous_quaternions, quaternion_conjugate, quaternion_from_matrix, quaternion_multiply
from .plan import MotionPlan


class Reference:
    """Spline table over a plan.

    `at(s)` returns (3, width): values, first and second derivatives by arc length. Columns: `com` (3), `ski_position`
    (2 x 3), `joints` (31), `turning` (left ski, right ski, pelvis: world rotation vector per metre), `tangent` (3),
    `left` (3), `normal` (3), `quaternion` (the same three x 4), `inclination`, `edge_angle` (2), `curvature`, `speed`,
    `turn_phase`, `acceleration`, `track_position` (3).
    """

    def __init__(self, plan: MotionPlan, model: SkierModel) -> None:
        """Fit the splines through `plan` for the actuated hinges of `model`."""
        from scipy.interpolate import CubicSpline

        self.knots = plan.arc_length
        self.end = plan.length
        quaternions, turning = _rotations(plan)
        channels = {
            "com": plan.com,
            "ski_position": plan.ski_position.reshape(-1, 6),
            "joints": plan.pose[:, model.actuated_qpos],
            "turning": turning,
            "tangent": plan.tangent,
            "left": np.cross(plan.surface_normal, plan.tangent),
            "normal": plan.surface_normal,
            "quaternion": quaternions,
            "inclination": plan.inclination[:, None],
            "edge_angle": plan.edge_angle,
            "curvature": plan.curvature[:, None],
            "speed": plan.speed[:, None],
            "turn_phase": plan.turn_phase[:, None],
            "acceleration": plan.acceleration[:, None],
            "track_position": plan.position,
        }
        table = np.hstack(list(channels.values()))
        edges = np.concatenate(([0], np.cumsum([block.shape[1] for block in channels.values()])))
        self.columns = {name: slice(int(a), int(b)) for name, a, b in zip(channels, edges, edges[1:], strict=False)}
        spline = CubicSpline(self.knots, table)
        self._coefficients = np.ascontiguousarray(spline.c.transpose(1, 0, 2))  # (n - 1, 4, width), cubic first
        self._starts = self.knots.tolist()
        self._basis = np.zeros((3, 4))
        self._basis[0, 3] = self._basis[1, 2] = 1.0
        self._basis[2, 1] = 2.0
        self._index = 0

    def interval(self, arc_length: float) -> int:
        """Return the spline interval of `arc_length` [m]; quick when it is near that of the last call."""
        starts, i, last = self._starts, self._index, len(self._starts) - 2
        while i < last and arc_length >= starts[i + 1]:
            i += 1
        while i > 0 and arc_length < starts[i]:
            i -= 1
        self._index = i
        return i

    def at(self, arc_length: float) -> np.ndarray:
        """Return values, first and second derivatives by arc length (3, width) at `arc_length` [m]."""
        i = self.interval(arc_length)
        x = arc_length - self._starts[i]
        basis = self._basis
        basis[0, 0], basis[0, 1], basis[0, 2] = x * x * x, x * x, x
        basis[1, 0], basis[1, 1] = 3.0 * x * x, 2.0 * x
        basis[2, 0] = 6.0 * x
        return basis @ self._coefficients[i]


def _rotations(plan: MotionPlan) -> tuple[np.ndarray, np.ndarray]:
    """Return quaternions (n, 12) and rotation vectors per metre (n, 9) of skis and pelvis, world axes."""
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
    slope = CubicSpline(plan.arc_length, quaternions)(plan.arc_length, 1)
    turning = 2.0 * quaternion_multiply(slope, quaternion_conjugate(quaternions))[..., 1:]
    return quaternions.reshape(-1, 12), turning.reshape(-1, 9)
