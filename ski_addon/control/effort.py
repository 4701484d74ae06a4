"""What the controller's program is solved for: accelerations, torques and snow forces of one step."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Solution:
    """`unknowns` (n,) of a program, `iterations` used, `status` 0 when converged and the solver's own value otherwise;
    `attempts` counts solves.
    """

    unknowns: np.ndarray
    iterations: int
    status: int
    attempts: int


@dataclass(frozen=True)
class Effort:
    """Muscles and snow of one step.

    `torque` (31,) [N m] of each hinge, of which `end_stop` (31,) is more than its muscles can give: the end of its
    range gives that, and only to a hinge on its way past it; `snow` (37,) generalised snow force; `edge_normal`,
    `edge_side` (2, 2) [N] by ski and edge; `load_moment` (2, 3) normal forces times their places from the ski's
    middle [N m, world]; `ski_force` (2, 3) [N, world]; `root_residual` [N, N m] of the root's equations of motion; and
    the `solution`, whose unknowns are those of `Formulation`.
    """

    torque: np.ndarray
    end_stop: np.ndarray
    snow: np.ndarray
    edge_normal: np.ndarray
    edge_side: np.ndarray
    load_moment: np.ndarray
    ski_force: np.ndarray
    root_residual: float
    solution: Solution
