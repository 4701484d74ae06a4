"""Exact solutions of small quadratic programs, certified by their Karush-Kuhn-Tucker conditions.

A program with a positive definite Hessian is a search for the point of a polyhedron that is nearest to the origin
(least distance programming), which non-negative least squares answers in finitely many steps (Lawson and Hanson).
How an answer was found does not matter: a point with multipliers that meets the conditions is the answer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linprog, nnls


@dataclass(frozen=True)
class Certified:
    """A point `x`, multipliers `y` (positive at upper bounds) and how far the conditions are missed."""

    x: np.ndarray
    y: np.ndarray
    stationarity: float
    infeasibility: float
    complementarity: float

    @property
    def worst(self) -> float:
        return max(self.stationarity, self.infeasibility, self.complementarity)


def conditions(program, x: np.ndarray, y: np.ndarray) -> Certified:
    """How far `x` and `y` miss stationarity, feasibility and complementarity (the multipliers' signs included)."""
    rows = program.A @ x
    stationarity = np.abs(program.P @ x + program.q + program.A.T @ y).max()
    infeasibility = max((program.lower - rows).max(), (rows - program.upper).max(), 0.0)
    slack = np.where(y > 0, program.upper - rows, rows - program.lower)
    complementarity = np.abs(np.minimum(np.abs(y), np.abs(slack))).max()
    return Certified(x, y, float(stationarity), float(infeasibility), float(complementarity))


def nearest_point(program) -> np.ndarray:
    """The solution by least distance programming; equality rows are eliminated first."""
    equal = program.upper - program.lower < 1e-12
    _, _, right = np.linalg.svd(program.A[equal])
    start = np.linalg.lstsq(program.A[equal], program.lower[equal], rcond=None)[0]
    free = right[np.linalg.matrix_rank(program.A[equal]) :].T
    P, q = free.T @ program.P @ free, free.T @ (program.P @ start + program.q)
    A = program.A[~equal]
    G = np.vstack((A, -A)) @ free
    room = np.concatenate((program.upper[~equal] - A @ start, A @ start - program.lower[~equal]))
    half = np.linalg.cholesky(P)
    G_half, shift = np.linalg.solve(half, G.T).T, np.linalg.solve(half, q)
    system = np.vstack((-G_half.T, -(room + G_half @ shift)))
    target = np.zeros(len(system))
    target[-1] = 1.0
    weights, distance = nnls(system, target, maxiter=20000)
    assert distance > 1e-9, "the program has no solution"
    residual = system @ weights - target
    return start + free @ np.linalg.solve(half.T, -residual[:-1] / residual[-1] - shift)


def exact_solution(program) -> Certified:
    """The solution and its multipliers, which belong to the rows that hold with equality."""
    x = nearest_point(program)
    rows = program.A @ x
    at_bound = np.minimum(np.abs(rows - program.lower), np.abs(rows - program.upper)) < 1e-6
    y = np.zeros(len(rows))
    y[at_bound] = np.linalg.lstsq(program.A[at_bound].T, -(program.P @ x + program.q), rcond=None)[0]
    return conditions(program, x, y)


def is_feasible(program) -> bool:
    """Whether any point satisfies all rows, by linear programming."""
    done = linprog(
        np.zeros(program.A.shape[1]),
        A_ub=np.vstack((program.A, -program.A)),
        b_ub=np.concatenate((program.upper, -program.lower)),
        bounds=(None, None),
        method="highs",
    )
    assert done.status in (0, 2)
    return done.status == 0
