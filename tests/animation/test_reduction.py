"""Fewer keys, and rotation modes: what is shown stays within the tolerance, and means what it meant."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from ski_addon.animation.reduction import kept_numbers, kept_places, kept_rotations
from ski_addon.animation.rotation_modes import EULER_ORDERS, from_mode, rotation_path, to_mode
from ski_addon.errors import SpecError
from ski_addon.frames import continuous_quaternions, matrix_from_quaternion, quaternion_from_matrix, rotation_about

MODES = ("QUATERNION", "AXIS_ANGLE", *EULER_ORDERS)
FRAME = np.arange(400) / 2.0 + 1.0


def tumbling() -> np.ndarray:
    t = FRAME / 24.0
    turn = (
        rotation_about("z", 1.3 * t) @ rotation_about("y", 1.4 * np.sin(t)) @ rotation_about("x", 0.7 * np.sin(2 * t))
    )
    return continuous_quaternions(quaternion_from_matrix(turn))


def between(values: np.ndarray, kept: np.ndarray) -> np.ndarray:
    return np.stack([np.interp(FRAME, FRAME[kept], column[kept]) for column in values.T], axis=1)


@pytest.mark.parametrize("mode", MODES)
def test_every_rotation_mode_says_the_same(mode: str) -> None:
    quaternion = tumbling()
    values = to_mode(quaternion, mode)
    matrix = matrix_from_quaternion(from_mode(values, mode))
    np.testing.assert_allclose(matrix, matrix_from_quaternion(quaternion), atol=1e-9)
    assert np.abs(np.diff(values, axis=0)).max() < 1.0  # no jumps by half or whole turns


def test_euler_angles_mean_what_they_mean_in_blender() -> None:
    for order in itertools.permutations("XYZ"):
        angles = np.array([[0.3, -0.5, 1.1]])
        want = np.eye(3)
        for letter in order:
            want = rotation_about(letter.lower(), angles[0, "XYZ".index(letter)]) @ want
        np.testing.assert_allclose(matrix_from_quaternion(from_mode(angles, "".join(order)))[0], want, atol=1e-12)
    assert rotation_path("XYZ") == "rotation_euler"
    assert rotation_path("QUATERNION") == "rotation_quaternion"


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("degrees", [0.1, 2.0])
def test_rotations_between_kept_keys_are_near(mode: str, degrees: float) -> None:
    values = to_mode(tumbling(), mode)
    kept = kept_rotations(FRAME, values, mode, degrees)
    assert len(kept) < 0.6 * len(FRAME)
    shown = matrix_from_quaternion(from_mode(between(values, kept), mode))
    error = np.swapaxes(shown, -1, -2) @ matrix_from_quaternion(tumbling())
    cosine = np.clip(0.5 * (np.trace(error, axis1=1, axis2=2) - 1.0), -1.0, 1.0)
    assert np.degrees(np.arccos(cosine)).max() < degrees + 1e-4


def test_places_between_kept_keys_are_near() -> None:
    values = np.stack((6.0 * FRAME, np.sin(0.1 * FRAME), np.maximum(FRAME - 50.0, 0.0)), axis=1)
    kept = kept_places(FRAME, values, 0.005)
    assert {0, len(FRAME) - 1} <= set(kept)
    assert np.linalg.norm(between(values, kept) - values, axis=1).max() <= 0.005
    assert len(kept) < 0.4 * len(FRAME)


def test_what_is_straight_needs_two_keys() -> None:
    values = np.stack((FRAME, 2.0 * FRAME, 0.0 * FRAME), axis=1)
    assert kept_places(FRAME, values, 1e-6).tolist() == [0, len(FRAME) - 1]


def test_without_tolerance_every_key_is_kept() -> None:
    assert len(kept_rotations(FRAME, tumbling(), "QUATERNION", 0.0)) == len(FRAME)


def test_one_key_stays_one() -> None:
    assert kept_places(np.array([1.0]), np.zeros((1, 3)), 0.1).tolist() == [0]


def test_a_negative_tolerance_is_refused() -> None:
    with pytest.raises(SpecError, match=r"reduction\.tolerance = -1"):
        kept_places(FRAME, np.zeros((len(FRAME), 3)), -1.0)


def test_many_keys_are_reduced_quickly() -> None:
    import time

    frame = np.arange(20000.0)
    values = np.stack([np.sin(frame / period) for period in (17.0, 29.0, 43.0)], axis=1)
    started = time.perf_counter()
    kept_places(frame, values, 0.005)
    assert time.perf_counter() - started < 2.0


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e4])
def test_numbers_come_as_near_as_a_share_of_their_range_in_any_unit(unit: float) -> None:
    values = unit * (np.sin(0.1 * FRAME) + 0.2 * np.cos(0.31 * FRAME))
    kept = kept_numbers(FRAME, values, 0.02)
    error = np.abs(np.interp(FRAME, FRAME[kept], values[kept]) - values).max()
    assert error <= 0.02 * np.ptp(values)
    assert len(kept) < 0.6 * len(FRAME)


def test_numbers_that_never_change_need_two_keys() -> None:
    assert kept_numbers(FRAME, np.full(len(FRAME), 7.0), 0.01).tolist() == [0, len(FRAME) - 1]
    assert len(kept_numbers(FRAME, np.sin(FRAME), 0.0)) == len(FRAME), "without tolerance every key is kept"
