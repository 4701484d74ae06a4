"""Rotations and quaternions: identities, and MuJoCo's as a second opinion."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest

from ski_addon import frames


def random_quaternions(count: int = 200) -> np.ndarray:
    q = np.random.default_rng(1).normal(size=(count, 4))
    return q / np.linalg.norm(q, axis=1, keepdims=True)


def same_rotation(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return 1.0 - np.abs(np.sum(a * b, axis=-1))


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_rotation_about_a_coordinate_axis_is_right_handed(axis):
    k = np.eye(3)["xyz".index(axis)]
    angles = np.linspace(-4, 4, 9).reshape(3, 3)
    got = frames.rotation_about(axis, angles)
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    for angle, matrix in zip(angles.ravel(), got.reshape(-1, 3, 3), strict=True):
        rodrigues = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
        np.testing.assert_allclose(matrix, rodrigues, atol=1e-15)


def test_matrix_and_product_agree_with_mujoco():
    a, b = random_quaternions(), random_quaternions()[::-1]
    product, matrix = np.empty(4), np.empty(9)
    for p, q in zip(a, b, strict=True):
        mujoco.mju_mulQuat(product, p, q)
        np.testing.assert_allclose(frames.quaternion_multiply(p, q), product, atol=1e-15)
        mujoco.mju_quat2Mat(matrix, p)
        np.testing.assert_allclose(frames.matrix_from_quaternion(p), matrix.reshape(3, 3), atol=1e-15)


def test_quaternion_of_a_matrix_is_the_way_back_for_every_branch():
    q = random_quaternions()
    half_turns = np.concatenate((np.eye(4), np.array([[0, 0.6, 0.8, 0], [0, 0, 0.6, 0.8], [1e-9, -0.6, 0, 0.8]])))
    q = np.concatenate((q, half_turns))
    back = frames.quaternion_from_matrix(frames.matrix_from_quaternion(q))
    assert same_rotation(q, back).max() < 1e-14
    np.testing.assert_allclose(np.linalg.norm(back, axis=-1), 1.0, atol=1e-14)


def test_quaternion_of_a_matrix_keeps_any_leading_shape():
    q = random_quaternions(24).reshape(2, 3, 4, 4)
    assert same_rotation(frames.quaternion_from_matrix(frames.matrix_from_quaternion(q)), q).max() < 1e-14


def test_rotating_is_the_sandwich_product_and_the_conjugate_undoes_it():
    q, v = random_quaternions(), np.random.default_rng(2).normal(size=(200, 3))
    pure = np.concatenate((np.zeros((200, 1)), v), axis=1)
    sandwich = frames.quaternion_multiply(frames.quaternion_multiply(q, pure), frames.quaternion_conjugate(q))
    np.testing.assert_allclose(frames.rotate(q, v), sandwich[:, 1:], atol=1e-14)
    np.testing.assert_allclose(frames.rotate(frames.quaternion_conjugate(q), frames.rotate(q, v)), v, atol=1e-14)


def test_continuous_quaternions_only_change_signs():
    angle = np.linspace(0, 12, 300)
    smooth = np.stack((np.cos(angle / 2), 0 * angle, np.sin(angle / 2), 0 * angle), axis=1)
    signs = np.where(np.random.default_rng(3).random(300) < 0.5, -1.0, 1.0)
    signs[0] = 1.0
    pair = np.stack((smooth * signs[:, None], -smooth), axis=1)
    got = frames.continuous_quaternions(pair)
    np.testing.assert_allclose(got[:, 0], smooth)
    np.testing.assert_allclose(got[:, 1], -smooth)


def test_continuous_quaternions_survive_a_half_turn_between_neighbours():
    q = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [-1.0, 0, 0, 0]])
    assert np.all(np.abs(np.linalg.norm(frames.continuous_quaternions(q), axis=1) - 1) < 1e-15)


def test_mirroring_a_rotation_mirrors_what_it_does():
    q, v = random_quaternions(), np.random.default_rng(4).normal(size=(200, 3))
    mirrored = frames.rotate(frames.mirror_quaternion(q), frames.mirror_vector(v))
    np.testing.assert_allclose(mirrored, frames.mirror_vector(frames.rotate(q, v)), atol=1e-14)
    np.testing.assert_array_equal(frames.mirror_quaternion(frames.mirror_quaternion(q)), q)


def test_axes_become_columns_and_are_normalised():
    x, y, z = np.eye(3)
    np.testing.assert_array_equal(frames.matrix_from_columns(y, z, x), np.array([[0, 0, 1], [1, 0, 0], [0, 1, 0.0]]))
    np.testing.assert_allclose(
        frames.normalized(np.array([[3.0, 4.0, 0.0], [0.0, 0.0, 2.0]]))[:, 1:], [[0.8, 0], [0, 1]]
    )


def test_cross_products_of_components_are_numpys():
    a, b = np.random.default_rng(3).normal(size=(2, 5, 3))
    np.testing.assert_allclose(frames.cross(a.T, b.T), np.cross(a, b).T, atol=1e-15)


def test_affine_maps_are_inverted_as_numpy_does_it():
    matrix = np.tile(np.eye(4), (6, 1, 1))
    matrix[:, :3] = np.random.default_rng(4).normal(size=(6, 3, 4))
    np.testing.assert_allclose(frames.affine_inverse(matrix), np.linalg.inv(matrix), rtol=1e-9, atol=1e-12)
