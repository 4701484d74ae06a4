"""Solves the controller's quadratic program with OSQP: set up once, then updated and warm started.

Settings are deterministic: nothing depends on wall time. The rows are scaled by the formulation, so OSQP's own
scaling, which would be redone at every update, stays off.
"""

from __future__ import annotations

import math

import numpy as np

from .effort import Solution
from .formulation import Formulation, Problem

INFEASIBLE = (3, 4, 5, 6)
"""OSQP's status values for programs it holds to be infeasible: what it returns then is no point."""
NOT_A_NUMBER = -99
"""Our status for a program that holds something else than finite numbers."""
SOLVED = 1
"""OSQP's status value for a solution within tolerance."""
POLISHED = 1
"""OSQP's status value for an answer made exact by solving the equations of the limits that bind."""
TOLERANCE = 1e-5
FINER_TOLERANCES = (1e-5, 1e-6, 1e-7)
"""Tolerances from which an answer at limits is tried to be made exact, one after the other."""
STEP_SIZE = 0.1
"""OSQP's rho: right while no torque or hinge limit binds; steps on which one does adapt it and then return to it."""
MOST_ITERATIONS = 4000
HARD_ITERATIONS = 40000
"""Iterations of further attempts, from a cold start."""
UNBOUNDED = 1e6
"""A bound [rad/s^2] that never binds; OSQP's early stopping dislikes infinities."""


class OsqpSolver:
    """One OSQP workspace with the sparsity of a formulation.

    What it remembers from one program to the next are the unknowns and multipliers of the last solution alone.
    """

    STATE = ("_unknowns", "_multipliers")

    def __init__(self, formulation: Formulation) -> None:
        """Set up with placeholder numbers; the first `solve` brings the real ones."""
        import osqp
        from scipy import sparse

        hessian = sparse.csc_matrix(formulation.hessian_pattern, copy=True)
        hessian.data[:] = 1e-9  # keeps the pattern; overwritten before the first solve
        rows = formulation.rows
        self._osqp = osqp.OSQP()
        self._osqp.setup(
            hessian,
            np.zeros(formulation.unknowns),
            formulation.constraint_pattern.copy(),
            np.full(rows, -1.0),
            np.full(rows, 1.0),
            verbose=False,
            scaling=0,
            rho=STEP_SIZE,
            sigma=1e-6,
            alpha=1.6,
            adaptive_rho=1,  # by iterations, never by time
            adaptive_rho_interval=50,
            check_termination=5,
            eps_abs=TOLERANCE,
            eps_rel=TOLERANCE,
            max_iter=MOST_ITERATIONS,
            check_dualgap=False,
            polishing=False,
            warm_starting=True,
        )
        # the public update() and solve() copy everything into caches for derivatives: 70 microseconds a step
        self._solver = self._osqp._solver
        self._zero = (np.zeros(formulation.unknowns), np.zeros(rows))
        self._unknowns, self._multipliers = np.zeros(formulation.unknowns), np.zeros(rows)
        self._hinge_rows, self._torque_rows = formulation.hinge_rows, formulation.torque_rows

    def solve(self, problem: Problem) -> Solution:
        """Solve `problem`, warm from the last solution.

        When that fails it is tried again from cold with more iterations and, if it still fails, without the rows that
        keep hinges in range: they can contradict the torque limits when a fall has begun. Never raises: a program that
        did not converge comes back with its status.
        """
        solver = self._solver
        solver.update_data_mat(P_x=problem.hessian, P_i=None, A_x=problem.constraints, A_i=None)
        # said each time, for OSQP itself would go on from a third vector too, which it does not give away
        solver.warm_start(self._unknowns, self._multipliers)
        solution = self._attempt(problem.gradient, problem.lower, problem.upper, 1)
        if solution.status == 0:
            return solution
        self._change(max_iter=HARD_ITERATIONS)
        solver.warm_start(*self._zero)
        solution = self._attempt(problem.gradient, problem.lower, problem.upper, 2)
        if solution.status != 0:
            lower, upper = problem.lower.copy(), problem.upper.copy()
            lower[self._hinge_rows], upper[self._hinge_rows] = -UNBOUNDED, UNBOUNDED
            lower[self._torque_rows] += problem.end_stops[0]  # with no ranges there are no ends to lean on
            upper[self._torque_rows] -= problem.end_stops[1]
            solver.warm_start(*self._zero)
            solution = self._attempt(problem.gradient, lower, upper, 3)
        self._change(max_iter=MOST_ITERATIONS)
        return solution

    def _attempt(self, gradient: np.ndarray, lower: np.ndarray, upper: np.ndarray, attempt: int) -> Solution:
        solver = self._solver
        solver.update_data_vec(q=gradient, l=lower, u=upper)
        solver.solve()
        info = solver.info
        status, iterations = int(info.status_val), int(info.iter)
        if status == SOLVED:
            iterations += self._refine()
        if info.rho_updates:
            solver.update_rho(STEP_SIZE)
        status = 0 if status == SOLVED else status
        unknowns, multipliers = np.array(solver.solution.x), np.array(solver.solution.y)
        if not math.isfinite(float(unknowns.sum()) + float(gradient.sum())) or status in INFEASIBLE:
            # OSQP gives no point when it finds infeasibility, and calls a program without numbers solved
            unknowns, multipliers = self._zero[0].copy(), self._zero[1]
            status = status or NOT_A_NUMBER
        self._unknowns[:], self._multipliers[:] = unknowns, multipliers
        return Solution(unknowns, iterations, status, attempt)

    def _refine(self) -> int:
        """Go on until the equations of the limits that bind can be solved; return the iterations that took."""
        iterations = 0
        for tolerance in FINER_TOLERANCES:
            self._change(polishing=1, eps_abs=tolerance, eps_rel=tolerance)
            self._solver.solve()
            iterations += int(self._solver.info.iter)
            if self._solver.info.status_polish == POLISHED:
                break
        self._change(polishing=0, eps_abs=TOLERANCE, eps_rel=TOLERANCE)
        return iterations

    def _change(self, **settings: float) -> None:
        changed = self._solver.get_settings()
        for name, value in settings.items():
            setattr(changed, name, value)
        self._solver.update_settings(changed)
