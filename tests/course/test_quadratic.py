"""The small quadratic program: optimality, equalities, inequalities."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import sparse

from ski_addon.course.quadratic import solve_between, solve_quadratic


def problem(seed: int, inequalities: int):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(12, 12))
    return (
        sparse.csr_matrix(root.T @ root + 0.1 * np.eye(12)),
        rng.normal(size=12),
        sparse.csr_matrix(rng.normal(size=(3, 12))),
        rng.normal(size=3),
        sparse.csr_matrix(rng.normal(size=(inequalities, 12))),
    )


@pytest.mark.parametrize("seed", range(6))
def test_without_inequalities_the_gradient_is_a_combination_of_the_rows(seed):
    cost, pull, rows, values, below = problem(seed, 0)
    x = solve_quadratic(cost, pull, rows, values, below, 1e-6)
    np.testing.assert_allclose(rows @ x, values, atol=1e-10)
    combination, *_ = np.linalg.lstsq(rows.T.toarray(), cost @ x - pull, rcond=None)
    np.testing.assert_allclose(rows.T @ combination, cost @ x - pull, atol=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_inequalities_hold_and_forces_act_only_where_they_bind(seed):
    """Karush, Kuhn and Tucker: gradient = rows' nu - below' lambda with lambda >= 0 only on binding rows."""
    cost, pull, rows, values, below = problem(seed, 6)
    x = solve_quadratic(cost, pull, rows, values, below, 1e-9)
    np.testing.assert_allclose(rows @ x, values, atol=1e-9)
    assert (below @ x).max() < 1e-6
    binding = np.flatnonzero(below @ x > -1e-6)
    forces = np.vstack((rows.toarray(), below.toarray()[binding])).T
    weights, *_ = np.linalg.lstsq(forces, -(cost @ x - pull), rcond=None)
    np.testing.assert_allclose(forces @ weights, -(cost @ x - pull), atol=1e-5)
    assert weights[3:].min(initial=0.0) > -1e-5


def test_contradicting_inequalities_are_met_half_way():
    """x <= -1 and -x <= -1 cannot both hold; softness shares out what is left over."""
    cost, below = sparse.identity(2, format="csr"), sparse.csr_matrix([[1.0, 1.0], [-1.0, 1.0]])
    rows = sparse.csr_matrix([[0.0, 1.0]])
    x = solve_quadratic(cost, np.zeros(2), rows, np.ones(1), below, 1e-4)
    np.testing.assert_allclose(x, (0.0, 1.0), atol=1e-8)


@pytest.mark.parametrize("seed", range(4))
def test_between_bounds_it_is_the_same_as_with_matrices(seed):
    rng = np.random.default_rng(seed)
    bands = rng.normal(size=(3, 30))
    bands[-1] = 5.0 + np.abs(bands).sum(axis=0)
    pull, low, high = 10.0 * rng.normal(size=30), -0.4, 0.7
    below = sparse.diags(bands[1, 1:], 1) + sparse.diags(bands[0, 2:], 2)
    cost = sparse.block_diag((below + below.T + sparse.diags(bands[2]), sparse.csr_matrix((1, 1))))
    one = sparse.csr_matrix(([1.0], ([0], [30])), shape=(1, 31))
    ends = sparse.csr_matrix(np.repeat([[-high], [low]], 30, axis=0))
    limits = sparse.hstack((sparse.vstack((sparse.identity(30), -sparse.identity(30))), ends)).tocsr()
    expected = solve_quadratic(cost, np.append(pull, 0.0), one, np.ones(1), limits, 1e-9)[:30]
    x = solve_between(bands, pull, low, high, 1e-9)
    np.testing.assert_allclose(x, expected, atol=1e-10)
    assert np.any(x > high - 1e-6) and np.any(x < low + 1e-6) and np.any((x > low + 0.01) & (x < high - 0.01))
