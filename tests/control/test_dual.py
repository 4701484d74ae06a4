"""Newton's method for the six multipliers: its answers are zeros, and their forces cost least."""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import minimize

from ski_addon.control.dual import MOST_STEPS, DualNewton


@dataclass(frozen=True)
class Problem:
    """k + K z - B clip(-B'z / r, lower, upper) = 0."""

    K: np.ndarray
    k: np.ndarray
    B: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    weight: float

    def solve(self, z: np.ndarray):
        newton = DualNewton(len(self.lower), self.weight)
        return newton.solve(self.K, self.k, self.B, self.lower, self.upper, z)

    def error(self, z: np.ndarray) -> np.ndarray:
        forces = np.clip(-self.B.T @ z / self.weight, self.lower, self.upper)
        return self.k + self.K @ z - self.B @ forces

    def cost(self, forces: np.ndarray) -> float:
        """The primal, 1/2 r f'f + 1/2 (B f - k)' K^-1 (B f - k), whose multipliers are z = K^-1 (B f - k)."""
        rest = self.B @ forces - self.k
        return float(0.5 * self.weight * forces @ forces + 0.5 * rest @ np.linalg.solve(self.K, rest))


@functools.cache
def problem(seed: int, weight: float = 0.1, count: int = 40) -> Problem:
    """Random, as stiff as the skier's: K over five orders of magnitude, a third of the forces bounded to nothing."""
    rng = np.random.default_rng(seed)
    turn, _ = np.linalg.qr(rng.normal(size=(6, 6)))
    K = turn @ np.diag(10.0 ** rng.uniform(-3, 2, 6)) @ turn.T
    B = rng.normal(size=(6, count)) * 10.0 ** rng.uniform(0, 2, (6, 1))
    upper = rng.uniform(0.0, 5.0, count) * (rng.uniform(size=count) > 1 / 3)
    lower = -upper * (rng.uniform(size=count) > 0.5)
    return Problem(K, 50.0 * rng.normal(size=6), B, lower, upper, weight)


@pytest.mark.parametrize("seed", range(12))
def test_forces_cost_no_more_than_any_others(seed):
    """A bounded search by another method (L-BFGS-B), from the answer and from nothing, finds none that cost less."""
    given = problem(seed)
    answer = given.solve(np.zeros(6))
    assert answer.converged and np.all(answer.forces >= given.lower) and np.all(answer.forces <= given.upper)
    assert np.sum((answer.forces > given.lower) & (answer.forces < given.upper)) > 0, "every force is at a bound"
    least = given.cost(answer.forces)
    bounds = list(zip(given.lower, given.upper, strict=True))

    def slope(forces: np.ndarray) -> np.ndarray:
        return given.weight * forces + given.B.T @ np.linalg.solve(given.K, given.B @ forces - given.k)

    for start in (answer.forces, np.zeros(len(bounds))):
        found = minimize(given.cost, start, jac=slope, bounds=bounds, method="L-BFGS-B", options={"maxiter": 5000})
        assert found.fun >= least * (1.0 - 1e-9)
    assert given.cost(np.zeros(len(bounds))) > 1.01 * least


@pytest.mark.parametrize("seed", range(200))
def test_it_converges_from_anywhere(seed):
    """Even from multipliers that saturate every force, where Newton's full steps would go on for ever."""
    given = problem(seed, weight=10.0 ** (-3 + seed % 4))
    rng = np.random.default_rng(seed)
    for start in (np.zeros(6), 1e4 * rng.normal(size=6)):
        answer = given.solve(start)
        assert answer.converged and answer.steps < MOST_STEPS
        size = max(np.abs(given.B @ answer.forces).max(), 1.0)
        assert np.abs(given.error(answer.z)).max() <= 1e-8 * size


def test_full_steps_alone_would_not_do(monkeypatch):
    """Else the line search would be for nothing."""
    monkeypatch.setattr("ski_addon.control.dual._turning_point", lambda *_: 1.0)
    stuck = [seed for seed in range(200) if not problem(seed, 10.0 ** (-3 + seed % 4)).solve(np.zeros(6)).converged]
    assert stuck


def test_from_the_answer_itself_no_step_is_needed():
    given = problem(1)
    z = given.solve(np.zeros(6)).z
    assert given.solve(z).steps == 0


def test_no_snow_at_all():
    """In the air every force is bounded to nothing: what is left is linear."""
    given = problem(2)
    nothing = np.zeros_like(given.lower)
    answer = DualNewton(len(nothing), 1e-3).solve(given.K, given.k, given.B, nothing, nothing, np.ones(6))
    assert answer.converged and not answer.forces.any()
    np.testing.assert_allclose(answer.z, -np.linalg.solve(given.K, given.k), rtol=1e-6)


@pytest.mark.parametrize("place", range(6))
def test_what_is_no_number_does_not_converge(place):
    given = problem(3)
    broken = given.k.copy()
    broken[place] = np.nan
    newton = DualNewton(len(given.lower), given.weight)
    assert not newton.solve(given.K, broken, given.B, given.lower, given.upper, np.zeros(6)).converged
