"""Mixed corrections against plain ones, and against what is known of them for linear problems."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.planning.mixing import Mixing, dot


def solved(matrix: np.ndarray, offset: np.ndarray, rounds: int) -> np.ndarray:
    """What `rounds` of mixed steps make of x = matrix x + offset."""
    x, mixing = np.zeros_like(offset), Mixing()
    for _ in range(rounds):
        x = x + mixing.step(matrix @ x + offset - x)
    return x


def test_two_unknowns_of_a_linear_problem_are_found_after_two_answers():
    matrix, offset = np.array([[0.3, 0.5], [-0.4, 0.6]]), np.array([[1.0], [2.0]])
    np.testing.assert_allclose(solved(matrix, offset, 4), np.linalg.solve(np.eye(2) - matrix, offset), atol=1e-10)


def test_it_finds_what_plain_steps_would_leave_for_ever():
    """A fixed point from which plain steps run away."""
    np.testing.assert_allclose(solved(np.array([[-3.0]]), np.array([[4.0]]), 4), 1.0, atol=1e-12)


def test_each_column_is_a_problem_of_its_own():
    changes = np.random.default_rng(0).normal(size=(5, 3, 4))
    together, apart = Mixing(), [Mixing() for _ in range(4)]
    for change in changes:
        alone = [mixing.step(change[:, i : i + 1]) for i, mixing in enumerate(apart)]
        np.testing.assert_allclose(together.step(change), np.hstack(alone), atol=1e-12)


@pytest.mark.parametrize("change", [0.0, 1.0])
def test_answers_that_say_the_same_or_nothing_do_no_harm(change):
    mixing = Mixing()
    for _ in range(5):
        assert np.all(np.isfinite(mixing.step(np.full((2, 3), change))))


def test_dot_is_over_components():
    np.testing.assert_array_equal(dot(np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([[5.0, 6.0], [7.0, 8.0]])), (26, 44))
