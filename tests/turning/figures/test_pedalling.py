"""Cranks: as far as the wheel lets them, held with the inside pedal up in sharp turns, never faster than the wheel."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.turning.figures.pedalling import LEANING, crank_angle, held_cranks
from tests.turning.figures.motions import turns

DEVELOPMENT = 5.5
CASES = [(2.5, 23.0, 8.0), (1.5, 20.0, 6.0), (3.0, 40.0, 12.0), (1.2, 25.0, 4.0)]


def cranks(period, lean, speed):
    motion = turns(period, lean, speed)
    held = held_cranks(motion, DEVELOPMENT)
    way = np.linspace(motion.distance[0], motion.distance[-1], 4001)
    return motion, held, way, crank_angle(held, way, DEVELOPMENT)


@pytest.mark.parametrize("case", CASES)
def test_cranks_never_turn_back_nor_faster_than_the_wheel(case):
    _, _, way, angle = cranks(*case)
    rate = np.diff(angle) / np.diff(way)
    assert rate.min() > -1e-9 and rate.max() < 2.0 * np.pi / DEVELOPMENT + 1e-6
    assert np.abs(np.diff(rate)).max() < 5.0 * (way[1] - way[0]), "no jerk [rad/m^2]"


@pytest.mark.parametrize("case", CASES[:3])
def test_the_inside_pedal_is_up_in_the_middle_of_every_sharp_turn(case):
    motion, held, _, _ = cranks(*case)
    lean = np.interp(motion.distance, motion.distance, motion.lean)
    assert len(held) >= 2 * 10 / case[0] - 2
    for stretch in held:
        middle = 0.5 * (stretch.begin + stretch.end)
        angle = crank_angle(held, np.array([middle]), DEVELOPMENT)[0]
        left_height = -np.sin(angle)  # of the left pedal over the cranks, in crank lengths
        assert left_height * np.sign(np.interp(middle, motion.distance, lean)) == pytest.approx(1.0)


def test_gentle_turns_are_pedalled_through_by_the_way():
    motion, held, way, angle = cranks(3.0, 8.0, 8.0)
    assert np.deg2rad(8.0) < LEANING and not held
    np.testing.assert_allclose(angle, 2.0 * np.pi * way / DEVELOPMENT)
    assert motion.distance[-1] > 70
