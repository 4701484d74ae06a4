"""Looking up between samples: exact where the samples are, shortest way between rotations."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.animation.interpolation import bracket, linear, slerp
from ski_addon.frames import matrix_from_quaternion, quaternion_from_matrix, rotation_about

RANDOM = np.random.default_rng(1)


def quaternions(count: int) -> np.ndarray:
    q = RANDOM.normal(size=(count, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def test_samples_are_found_again() -> None:
    time = np.cumsum(RANDOM.uniform(0.1, 1.0, 20))
    values = RANDOM.normal(size=(20, 3, 2))
    np.testing.assert_allclose(linear(values, bracket(time, time)), values, atol=1e-14)


def test_a_straight_line_stays_straight() -> None:
    time = np.sort(RANDOM.uniform(0.0, 5.0, 30))
    query = RANDOM.uniform(time[0], time[-1], 50)
    np.testing.assert_allclose(linear(3.0 * time - 1.0, bracket(time, query)), 3.0 * query - 1.0, atol=1e-12)


def test_outside_the_ends_are_held() -> None:
    time = np.array([1.0, 2.0, 3.0])
    np.testing.assert_array_equal(linear(np.array([5.0, 6.0, 7.0]), bracket(time, np.array([-9.0, 99.0]))), [5.0, 7.0])


def test_one_sample_is_held() -> None:
    np.testing.assert_array_equal(
        linear(np.array([4.0]), bracket(np.array([2.0]), np.array([0.0, 2.0, 9.0]))), [4.0] * 3
    )


def test_slerp_meets_its_ends() -> None:
    a, b = quaternions(40), quaternions(40)
    np.testing.assert_allclose(slerp(a, b, np.zeros(40)), a, atol=1e-12)
    end = slerp(a, b, np.ones(40))
    np.testing.assert_allclose(np.abs(np.sum(end * b, axis=1)), 1.0, atol=1e-12)


@pytest.mark.parametrize("angle", [1e-9, 1e-5, 1e-3, 0.5, 3.0])
def test_slerp_turns_evenly_about_one_axis(angle: float) -> None:
    share = np.linspace(0.0, 1.0, 7)
    a = np.tile(quaternion_from_matrix(rotation_about("y", np.float64(0.4))), (7, 1))
    b = np.tile(quaternion_from_matrix(rotation_about("y", np.float64(0.4 + angle))), (7, 1))
    want = rotation_about("y", 0.4 + share * angle)
    np.testing.assert_allclose(matrix_from_quaternion(slerp(a, b, share)), want, atol=1e-12)


def test_slerp_takes_the_shorter_way() -> None:
    a, b = quaternions(30), quaternions(30)
    share = RANDOM.uniform(0, 1, 30)
    np.testing.assert_allclose(slerp(a, b, share), slerp(a, -b, share), atol=1e-12)
