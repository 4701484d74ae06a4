"""The cranks: by the way, or held with the inside pedal up where the turn is sharp."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.turning.figures.pedalling import LEFT_UP, RAMP, SHARP, crank_angle

DEVELOPMENT = 4.5
KNOTS = np.linspace(-0.4, 120.0, 2000)
WAY = np.linspace(-0.4, 119.0, 5000)


def weaving(length: float, tilt: float = 2.0 * SHARP) -> np.ndarray:
    return tilt * np.sin(2.0 * np.pi * KNOTS / length)


def test_without_coasting_a_turn_of_the_cranks_is_the_development():
    angle = crank_angle(WAY, KNOTS, weaving(20.0), DEVELOPMENT, False)
    np.testing.assert_allclose(np.diff(angle), 2.0 * np.pi * np.diff(WAY) / DEVELOPMENT)


def test_gentle_turns_are_pedalled_through():
    gentle = weaving(20.0, 0.9 * SHARP)
    np.testing.assert_array_equal(
        crank_angle(WAY, KNOTS, gentle, DEVELOPMENT, True), crank_angle(WAY, KNOTS, gentle, DEVELOPMENT, False)
    )


@pytest.mark.parametrize("length", [6.0, 14.0, 20.0, 45.0])
def test_the_inside_pedal_is_up_in_sharp_turns(length):
    tilt = weaving(length)
    angle = crank_angle(WAY, KNOTS, tilt, DEVELOPMENT, True)
    now = np.interp(WAY, KNOTS, tilt)
    for left in (True, False):
        deep = (now if left else -now) > (1.2 if length > 10.0 else 1.85) * SHARP
        assert deep.sum() > 50
        up = np.sin(angle[deep] - (LEFT_UP if left else LEFT_UP + np.pi))
        assert np.abs(up).max() < 1e-6 and np.cos(angle[deep] - (LEFT_UP if left else LEFT_UP + np.pi)).min() > 0.99


@pytest.mark.parametrize("length", [6.0, 14.0, 20.0, 45.0])
def test_nobody_pedals_backward_and_the_cranks_start_and_stop_smoothly(length):
    angle = crank_angle(WAY, KNOTS, weaving(length), DEVELOPMENT, True)
    rate = np.diff(angle) / np.diff(WAY)
    assert rate.min() > -1e-9
    assert rate.max() < 2.6 * 2.0 * np.pi / DEVELOPMENT
    assert np.abs(np.diff(rate)).max() < 12.0 * np.diff(WAY).max() / RAMP * rate.max()


def test_on_the_straight_after_the_last_turn_the_development_holds_again():
    tilt = np.where(KNOTS < 40.0, weaving(20.0), 0.0)
    angle = crank_angle(WAY, KNOTS, tilt, DEVELOPMENT, True)
    straight = WAY > 45.0
    np.testing.assert_allclose(np.diff(angle[straight]), 2.0 * np.pi * np.diff(WAY[straight]) / DEVELOPMENT)
