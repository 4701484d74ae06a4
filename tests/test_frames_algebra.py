"""Rotations as a group: axioms, mirror images, half turns, and the same numbers wherever arrays lie in memory."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon import frames

IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


@pytest.fixture
def rng() -> np.random.Generator:
    return np.random.default_rng(20260)


@pytest.fixture
def quaternions(rng):
    return lambda count=300: unit(rng.normal(size=(count, 4)))


def unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector, axis=-1, keepdims=True)


def about(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    """Unit quaternions of turns by `angle` (n,) about unit axes (n, 3)."""
    return np.concatenate((np.cos(angle / 2)[:, None], np.sin(angle / 2)[:, None] * axis), axis=1)


def assert_same_rotation(a: np.ndarray, b: np.ndarray, atol: float = 1e-14) -> None:
    """q and -q are one rotation; each pair is brought to one sign, so that the tolerance is on the angle itself."""
    sign = np.sign(np.sum(a * b, axis=-1, keepdims=True))
    np.testing.assert_allclose(a, sign * b, atol=atol)


def test_product_has_a_neutral_element_and_inverses(quaternions):
    q = quaternions()
    np.testing.assert_array_equal(frames.quaternion_multiply(q, IDENTITY), q)
    np.testing.assert_array_equal(frames.quaternion_multiply(IDENTITY, q), q)
    for product in (
        frames.quaternion_multiply(q, frames.quaternion_conjugate(q)),
        frames.quaternion_multiply(frames.quaternion_conjugate(q), q),
    ):
        np.testing.assert_allclose(product, np.broadcast_to(IDENTITY, q.shape), atol=1e-15)


def test_product_is_associative_and_keeps_length_one(quaternions):
    a, b, c = quaternions(), quaternions(), quaternions()
    left = frames.quaternion_multiply(frames.quaternion_multiply(a, b), c)
    right = frames.quaternion_multiply(a, frames.quaternion_multiply(b, c))
    np.testing.assert_allclose(left, right, atol=1e-15)
    np.testing.assert_allclose(np.linalg.norm(left, axis=1), 1.0, atol=1e-14)


def test_inverse_of_a_product_is_the_product_of_inverses_the_other_way_round(quaternions):
    a, b = quaternions(), quaternions()
    inverse = frames.quaternion_multiply(frames.quaternion_conjugate(b), frames.quaternion_conjugate(a))
    np.testing.assert_allclose(frames.quaternion_conjugate(frames.quaternion_multiply(a, b)), inverse, atol=1e-15)


def test_turning_by_a_product_is_turning_twice_second_factor_first(rng, quaternions):
    a, b, v = quaternions(), quaternions(), rng.normal(size=(300, 3))
    twice = frames.rotate(a, frames.rotate(b, v))
    np.testing.assert_allclose(frames.rotate(frames.quaternion_multiply(a, b), v), twice, atol=1e-14)
    matrices = frames.matrix_from_quaternion(a) @ frames.matrix_from_quaternion(b)
    np.testing.assert_allclose(frames.matrix_from_quaternion(frames.quaternion_multiply(a, b)), matrices, atol=1e-14)


def test_both_signs_are_one_rotation(quaternions):
    q = quaternions()
    np.testing.assert_array_equal(frames.matrix_from_quaternion(q), frames.matrix_from_quaternion(-q))


def test_matrices_are_rotations_and_transposing_inverts_them(quaternions):
    q = quaternions()
    m = frames.matrix_from_quaternion(q)
    np.testing.assert_allclose(np.linalg.det(m), 1.0, atol=1e-14)
    np.testing.assert_allclose(np.swapaxes(m, -1, -2) @ m, np.broadcast_to(np.eye(3), m.shape), atol=1e-14)
    np.testing.assert_allclose(
        frames.matrix_from_quaternion(frames.quaternion_conjugate(q)), np.swapaxes(m, -1, -2), atol=1e-15
    )


@pytest.mark.parametrize("short_of_half", [0.0, 1e-15, 1e-12, 1e-8, 1e-6, 1e-3])
def test_round_trip_keeps_half_turns_to_the_last_digits(rng, short_of_half):
    """Near 180 degrees w vanishes: the branch from the trace would lose half of the digits."""
    axis = unit(np.concatenate((rng.normal(size=(200, 3)), np.eye(3), -np.eye(3), [[1, 1, 0], [0, 1, 1], [1, 1, 1]])))
    for angle in (np.pi - short_of_half, np.pi + short_of_half):
        q = about(axis, np.full(len(axis), angle))
        back = frames.quaternion_from_matrix(frames.matrix_from_quaternion(q))
        assert_same_rotation(back, q, atol=2e-15)


@pytest.mark.parametrize("angle", [0.0, 1e-160, 1e-12, 1e-8, 1e-4])
def test_round_trip_keeps_small_turns(rng, angle):
    q = about(unit(rng.normal(size=(200, 3))), np.full(200, angle))
    assert_same_rotation(frames.quaternion_from_matrix(frames.matrix_from_quaternion(q)), q, atol=1e-15)


def test_round_trip_of_matrices(quaternions):
    m = frames.matrix_from_quaternion(quaternions())
    np.testing.assert_allclose(frames.matrix_from_quaternion(frames.quaternion_from_matrix(m)), m, atol=1e-15)


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_turns_about_one_axis_add_up(rng, axis):
    a, b = rng.uniform(-7, 7, 50), rng.uniform(-7, 7, 50)
    product = frames.rotation_about(axis, a) @ frames.rotation_about(axis, b)
    np.testing.assert_allclose(frames.rotation_about(axis, a + b), product, atol=1e-14)
    np.testing.assert_array_equal(frames.rotation_about(axis, -a), np.swapaxes(frames.rotation_about(axis, a), -1, -2))
    expected = about(np.tile(np.eye(3)["xyz".index(axis)], (50, 1)), a)
    assert_same_rotation(frames.quaternion_from_matrix(frames.rotation_about(axis, a)), expected)


def test_single_angle_and_single_quaternion_need_no_batch(quaternions):
    assert frames.rotation_about("z", 0.3).shape == (3, 3)
    q = quaternions(1)[0]
    assert frames.rotate(q, [1.0, 0.0, 0.0]).shape == (3,)
    assert frames.quaternion_from_matrix(frames.matrix_from_quaternion(q)).shape == (4,)


def test_leading_axes_broadcast(rng, quaternions):
    q, v = quaternions(6).reshape(2, 3, 4), rng.normal(size=(3, 3))
    got = frames.rotate(q, v)
    for i in range(2):
        np.testing.assert_array_equal(got[i], frames.rotate(q[i], v))


def test_mirror_image_of_a_product_is_the_product_of_mirror_images(quaternions):
    a, b = quaternions(), quaternions()
    mirrored = frames.quaternion_multiply(frames.mirror_quaternion(a), frames.mirror_quaternion(b))
    np.testing.assert_allclose(mirrored, frames.mirror_quaternion(frames.quaternion_multiply(a, b)), atol=1e-15)
    conjugate = frames.quaternion_conjugate(frames.mirror_quaternion(a))
    np.testing.assert_array_equal(conjugate, frames.mirror_quaternion(frames.quaternion_conjugate(a)))


def test_mirror_image_of_a_matrix_is_the_flip_on_both_sides(quaternions):
    q, flip = quaternions(), np.diag([1.0, -1.0, 1.0])
    expected = flip @ frames.matrix_from_quaternion(q) @ flip
    np.testing.assert_allclose(frames.matrix_from_quaternion(frames.mirror_quaternion(q)), expected, atol=1e-15)


def test_mirroring_keeps_dot_products_and_turns_cross_products_round(rng):
    a, b = rng.normal(size=(2, 100, 3))
    ma, mb = frames.mirror_vector(a), frames.mirror_vector(b)
    np.testing.assert_array_equal(frames.mirror_vector(ma), a)
    np.testing.assert_allclose(np.sum(ma * mb, axis=1), np.sum(a * b, axis=1))
    np.testing.assert_allclose(np.cross(ma, mb), -frames.mirror_vector(np.cross(a, b)))


@pytest.mark.parametrize(("axis", "sign"), [("x", -1.0), ("y", 1.0), ("z", -1.0)])
def test_mirror_keeps_pitching_and_reverses_leaning_and_turning(axis, sign):
    q = frames.quaternion_from_matrix(frames.rotation_about(axis, 0.4))
    expected = frames.quaternion_from_matrix(frames.rotation_about(axis, sign * 0.4))
    np.testing.assert_allclose(frames.mirror_quaternion(q), expected, atol=1e-15)


def test_continuous_quaternions_keep_every_rotation_and_the_first_sign(quaternions):
    q = quaternions(200).reshape(50, 4, 4)
    got = frames.continuous_quaternions(q)
    np.testing.assert_array_equal(np.abs(got), np.abs(q))
    np.testing.assert_array_equal(got[0], q[0])
    assert np.all(np.sum(got[1:] * got[:-1], axis=-1) >= 0.0)
    np.testing.assert_array_equal(frames.continuous_quaternions(got), got)


def test_continuous_quaternions_undo_any_flipping_and_leave_their_argument_alone(rng):
    angle = np.linspace(0.0, 40.0, 500)  # many times round: the sign is continuous though the rotation returns
    smooth = about(np.tile(unit(np.array([1.0, 2.0, 3.0])), (500, 1)), angle)
    flipped = smooth * np.concatenate(([1.0], rng.choice([-1.0, 1.0], 499)))[:, None]
    before = flipped.copy()
    np.testing.assert_array_equal(frames.continuous_quaternions(flipped), smooth)
    np.testing.assert_array_equal(flipped, before)


@pytest.mark.parametrize("count", [0, 1])
def test_continuous_quaternions_of_nothing_or_one(quaternions, count):
    q = quaternions(5)[:count]
    np.testing.assert_array_equal(frames.continuous_quaternions(q), q)


def test_components_are_contiguous_copies_of_the_columns(rng):
    vector = np.asfortranarray(rng.normal(size=(40, 5, 3)))[::2]
    x, y, z = frames.components(vector)
    for k, part in enumerate((x, y, z)):
        assert part.flags.c_contiguous and part.dtype == np.float64
        np.testing.assert_array_equal(part, vector[..., k])
    assert frames.components([1, 2, 3]).tolist() == [1.0, 2.0, 3.0]


def layouts(values: np.ndarray) -> list[np.ndarray]:
    """The same numbers (n,) in different places of memory: contiguous, strided, reversed, and off the alignment."""
    strided = np.empty((len(values), 7))
    strided[:, 3] = values
    backwards = values[::-1].copy()[::-1]
    raw = np.empty(8 * len(values) + 4, dtype=np.uint8)[4:].view(np.float64)
    raw[:] = values
    shifted = np.empty(len(values) + 1)[1:]
    shifted[:] = values
    out = [values.copy(), strided[:, 3], backwards, raw, shifted]
    assert not out[1].flags.c_contiguous and not out[3].flags.aligned
    return out


@pytest.mark.parametrize("axis", ["x", "y", "z"])
def test_sines_are_the_same_to_the_last_bit_whatever_the_layout(rng, axis):
    angle = rng.uniform(-np.pi, np.pi, 3001)
    expected = frames.rotation_about(axis, angle).tobytes()
    for laid in layouts(angle):
        assert frames.rotation_about(axis, laid).tobytes() == expected


@pytest.mark.parametrize("count", [1, 2, 7])
def test_components_lie_side_by_side_also_of_one_vector(count):
    """Or numpy's arc tangent takes one of two routines by what lies behind them in memory."""
    found = frames.components(np.arange(9.0 * count).reshape(count, 9))
    assert found.strides == (8 * count, 8) and found[2, -1] == 9.0 * (count - 1) + 2.0


def test_arc_tangents_of_components_are_the_same_to_the_last_bit_whatever_the_layout(rng):
    """The results lie right behind the arguments: where numpy takes its other route if the arguments are strided."""
    count, width = 3001, 11
    vector = rng.normal(size=(count, 3))
    results = []
    for first in (0, 4, 8):
        memory = np.empty(count * width + count)
        laid, behind = memory[: count * width].reshape(count, width)[:, first : first + 3], memory[count * width :]
        laid[:] = vector
        x, y, _ = frames.components(laid)
        results.append(np.arctan2(y, x, out=behind).tobytes())
    for laid in (vector, np.asfortranarray(vector), vector[::-1].copy()[::-1]):
        x, y, _ = frames.components(laid)
        results.append(np.arctan2(y, x).tobytes())
    assert len(set(results)) == 1
