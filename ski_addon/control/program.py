"""The program of one step, solved the fast way where that is exact, and by OSQP where a limit binds."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from ..body import SkierModel
from ..snow import Snow
from .dynamics import Dynamics
from .effort import Effort
from .formulation import Formulation
from .gains import Gains
from .small_program import SmallProgram
from .solver import OsqpSolver
from .tasks import Desired


class Program:
    """Finds torques and snow forces for desired accelerations; `formulation` is the program as it is written down."""

    def __init__(self, model: SkierModel, snow: Snow, gains: Gains, segments: int, solver: str = "small") -> None:
        """Lay out for `segments` contact points an edge; with `solver` "osqp" only the program as written is used."""
        self.formulation = Formulation(model, snow, gains, segments)
        self.small = SmallProgram(model, snow, gains, segments) if solver == "small" else None

    @property
    def STATE(self) -> tuple[str, ...]:  # noqa: N802 - as of every class with a state
        """The solvers there are."""
        return ("osqp",) if self.small is None else ("small", "osqp")

    @cached_property
    def osqp(self) -> OsqpSolver:
        """The solver of the program as written, set up when it is first needed."""
        return OsqpSolver(self.formulation)

    def solve(
        self,
        dynamics: Dynamics,
        desired: Desired,
        edge_angle: np.ndarray,
        normal: np.ndarray,
        leg_freedom: float = 1.0,
    ) -> Effort:
        """Return muscles and snow at the present state; arguments as of `Formulation.build`. Raises nothing."""
        if self.small is not None:
            effort = self.small.solve(dynamics, desired, edge_angle, normal, leg_freedom)
            if effort is not None:
                return effort
        problem = self.formulation.build(dynamics, desired, edge_angle, normal, leg_freedom)
        return self.formulation.effort(dynamics, self.osqp.solve(problem))
