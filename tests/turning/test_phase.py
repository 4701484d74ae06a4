"""Phase and ellipse of a motion found afterwards [VP93 sec. 6.2]."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.turning.phase import estimate_ellipse, estimate_phase, phase_of


def swing(period: float, sharpness: float, duration: float = 9.0, delay: float = 0.3) -> tuple[np.ndarray, ...]:
    """A sine of lean: time, lean, its rate, and its phase."""
    time = np.arange(0.0, duration, 0.01)
    phase = 2.0 * np.pi / period * (time - delay)
    return time, sharpness * np.sin(phase), 2.0 * np.pi / period * sharpness * np.cos(phase), phase % (2.0 * np.pi)


def apart(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Difference of angles, the short way round."""
    return np.abs((a - b + np.pi) % (2.0 * np.pi) - np.pi)


@pytest.mark.parametrize("period", [1.5, 2.0, 3.0])
@pytest.mark.parametrize("sharpness_deg", [7.0, 23.0])
def test_claim_14_a_known_sine_is_found_within_one_percent(period, sharpness_deg):
    time, lean, rate, phase = swing(period, np.deg2rad(sharpness_deg))
    widest, fastest = estimate_ellipse(time, lean, rate)
    np.testing.assert_allclose(widest, np.deg2rad(sharpness_deg), rtol=0.01)
    np.testing.assert_allclose(fastest / widest, 2.0 * np.pi / period, rtol=0.01)
    assert apart(estimate_phase(time, lean, rate), phase).max() < 0.01


def test_claim_14_growing_swings_are_followed_quarter_by_quarter():
    time = np.arange(0.0, 12.0, 0.01)
    size, angle = 0.1 + 0.02 * time, 3.0 * time
    lean = size * np.sin(angle)
    widest, _ = estimate_ellipse(time, lean, np.gradient(lean, time))
    peaks = np.abs(np.cos(angle)) < 0.02
    np.testing.assert_allclose(widest[peaks], size[peaks], rtol=0.01)


def test_phase_is_zero_where_the_body_comes_upright_on_its_way_to_the_left():
    assert phase_of(np.array([0.0, 0.2, 0.0, -0.2]), np.array([0.5, 0.0, -0.5, 0.0]), 0.2, 0.5) == pytest.approx(
        [0.0, 0.5 * np.pi, np.pi, 1.5 * np.pi]
    )


def test_phase_goes_on_without_jumps_and_stays_in_its_range():
    """Swings that grow and quicken: the quarters' ellipses differ, the phase meets where they do."""
    time = np.arange(0.0, 12.0, 0.005)
    lean = (0.1 + 0.02 * time) * np.sin(2.0 * time + 0.05 * time**2)
    phase = estimate_phase(time, lean, np.gradient(lean, time))
    assert phase.min() >= 0.0 and phase.max() < 2.0 * np.pi
    steps = np.diff(np.unwrap(phase))
    assert steps.min() > 0.0 and steps.max() < 0.05


@pytest.mark.parametrize(
    "lean", [np.zeros(50), np.full(50, 0.2), np.linspace(0.0, 0.3, 50), 0.3 * np.sin(np.linspace(0.2, 1.2, 50))]
)
def test_less_than_a_turn_has_a_phase_too(lean):
    time = 0.01 * np.arange(50)
    assert np.isfinite(estimate_phase(time, lean, np.gradient(lean, time))).all()


def test_noise_of_a_straight_run_is_no_turn():
    time, lean, rate, phase = swing(2.0, 0.3, duration=6.0)
    straight = 1e-6 * np.random.default_rng(3).normal(size=300)
    lean, rate = np.concatenate((lean, straight)), np.concatenate((rate, straight))
    widest, _ = estimate_ellipse(0.01 * np.arange(len(lean)), lean, rate)
    np.testing.assert_allclose(widest, 0.3, rtol=0.01)
    assert apart(estimate_phase(0.01 * np.arange(len(lean)), lean, rate)[:550], phase[:550]).max() < 0.02
