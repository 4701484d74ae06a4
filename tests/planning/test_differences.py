"""Differences over uneven moments against parabolas, numpy's own, and the equations written out."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.planning.differences import Differences

TIME = np.sort(np.random.default_rng(0).uniform(0.0, 1.0, 40))


def test_derivatives_are_exact_for_parabolas_on_uneven_time():
    differences = Differences(TIME)
    np.testing.assert_allclose(differences.first(3 * TIME**2 - TIME), 6 * TIME - 1, atol=1e-10)
    np.testing.assert_allclose(differences.second(3 * TIME**2 - TIME), 6.0, atol=1e-6)


def test_the_first_derivative_is_numpys():
    values = np.random.default_rng(1).normal(size=len(TIME))
    expected = np.gradient(values, TIME, edge_order=2)
    np.testing.assert_allclose(Differences(TIME).first(values), expected, rtol=1e-9)


def test_the_bounded_solution_solves_its_equation_and_is_steady_at_both_ends():
    rng = np.random.default_rng(2)
    stiffness, forcing = rng.uniform(5.0, 50.0, len(TIME)), rng.normal(size=len(TIME))
    kept, differences = stiffness.copy(), Differences(TIME)
    solution = differences.bounded_solution(stiffness, forcing)
    left_hand = differences.second(solution) - stiffness * solution
    np.testing.assert_allclose(left_hand[1:-1], forcing[1:-1], atol=1e-6)
    np.testing.assert_allclose(solution[[0, -1]], (-forcing / stiffness)[[0, -1]], rtol=1e-12)
    np.testing.assert_array_equal(stiffness, kept)


def test_a_bounded_solution_decays_from_a_push_as_the_pendulum_does():
    """y'' = y / T^2 outside of the push falls by e in each T."""
    time = np.linspace(0.0, 8.0, 1601)
    push = np.where(np.abs(time - 4.0) < 0.05, 1.0, 0.0)
    solution = Differences(time).bounded_solution(np.full_like(time, 4.0), push)
    later = np.searchsorted(time, [4.5, 5.0, 5.5])
    np.testing.assert_allclose(solution[later[1:]] / solution[later[:-1]], np.exp(-1.0), rtol=1e-3)


def test_equations_that_nothing_solves_are_refused():
    with pytest.raises(np.linalg.LinAlgError):
        Differences(TIME).bounded_solution(np.zeros_like(TIME), np.ones_like(TIME))
