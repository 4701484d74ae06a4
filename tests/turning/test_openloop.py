"""Swings without feedback, with the numbers of Figs. 5 and 6 [VP93 sec. 4]."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.gravity import STANDARD_GRAVITY as G
from ski_addon.turning.body import TurningBody
from ski_addon.turning.openloop import Swing, swing_open_loop

PERIODS, SHARPNESS = np.array([2.0, 3.0, 2.0]), np.deg2rad([23.0, 23.0, 7.0])
"""The three ellipses of Fig. 6."""
STEP = 0.002


def swung(speed: float, periods=PERIODS, sharpness=SHARPNESS, duration: float = 6.0, step: float = STEP) -> Swing:
    return swing_open_loop(TurningBody(), 2.0 * np.pi / periods, sharpness, speed, duration, step)


def forces(period: float, sharpness_deg: float, speed: float = 8.0) -> tuple[float, float]:
    force = swung(speed, np.array([period]), np.deg2rad([sharpness_deg])).leg_force
    return float(force.min()), float(force.max())


@pytest.mark.parametrize(("step", "drift"), [(0.01, 0.02), (0.002, 0.002)])
def test_claim_3_the_lean_stays_a_sine_under_eulers_steps(step, drift):
    swing = swung(8.0, duration=20.0, step=step)
    w = 2.0 * np.pi / PERIODS
    expected = SHARPNESS * np.sin(w * swing.time[:, None])
    assert np.abs(swing.lean - expected).max() < drift * SHARPNESS.max()
    np.testing.assert_allclose(swing.lean_rate.max(axis=0), w * SHARPNESS, rtol=2 * drift)


def test_claim_3_lean_and_curvature_are_in_phase_and_curvature_is_nearly_a_sine():
    swing = swung(8.0)
    for lean, curvature in zip(swing.lean.T, swing.curvature.T, strict=True):
        assert np.corrcoef(lean, curvature)[0, 1] > 0.999
    one = slice(0, round(2.0 / STEP))
    curvature, sine = swing.curvature[one, 0], np.sin(np.pi * swing.time[one])
    amplitude = 2.0 * np.mean(curvature * sine)
    assert np.abs(curvature - amplitude * sine).max() <= 0.02 * amplitude


@pytest.mark.parametrize(
    ("period", "sharpness_deg", "exact", "approximate"),
    [(2.0, 23.0, 0.126, 0.123), (3.0, 23.0, 0.092, 0.089), (2.0, 7.0, 0.038, 0.038)],
)
def test_claim_4_greatest_curvature_by_equation_9(period, sharpness_deg, exact, approximate):
    w, sharpness = 2.0 * np.pi / period, np.deg2rad(sharpness_deg)
    swing = swung(8.0, np.array([period]), np.array([sharpness]))
    assert swing.curvature.max() == pytest.approx(exact, abs=6e-4)
    assert sharpness / 8.0**2 * (G + w**2 * TurningBody().effective_length) == pytest.approx(approximate, abs=6e-4)


def test_claim_5_tracks_of_the_three_ellipses():
    swing = swung(8.0)
    for body, (period, length, size, radius, turn) in enumerate(
        [(2.0, 16.0, 0.85, 7.9, 38.0), (3.0, 23.7, 1.36, 10.9, 41.0), (2.0, 16.0, 0.24, 26.6, 11.0)]
    ):
        one = slice(0, round(period / STEP) + 1)
        assert swing.x[one, body][-1] == pytest.approx(length, abs=0.05)
        assert 0.5 * np.ptp(swing.y[one, body]) == pytest.approx(size, abs=0.006)
        assert 1.0 / swing.curvature[:, body].max() == pytest.approx(radius, abs=0.06)
        assert np.rad2deg(np.ptp(swing.course[:, body])) == pytest.approx(turn, abs=0.5)


def test_claim_5_size_of_a_swing_does_not_depend_on_the_speed():
    sizes = np.array([0.5 * np.ptp(swung(speed).y, axis=0) for speed in (5.0, 8.0, 12.0)])
    np.testing.assert_allclose(sizes, np.broadcast_to([0.85, 1.36, 0.24], (3, 3)), atol=0.011)
    assert np.all(sizes[:, 1] > sizes[:, 0]) and np.all(sizes[:, 0] > sizes[:, 2])


@pytest.mark.parametrize("speed", [8.0, 12.0])
def test_claim_5_a_swing_is_as_long_as_speed_times_period(speed):
    swing = swung(speed)
    for body, period in enumerate(PERIODS):
        assert swing.x[round(period / STEP), body] == pytest.approx(speed * period, rel=0.015)


@pytest.mark.parametrize(
    ("period", "sharpness_deg", "least", "most"),
    [(2, 23, 0.84, 1.26), (2, 25, 0.81, 1.31), (2, 30, 0.72, 1.46), (3, 23, 0.93, 1.16), (2, 7, 0.98, 1.02)],
)
def test_claim_6_leg_force_of_typical_turns(period, sharpness_deg, least, most):
    assert forces(period, sharpness_deg) == pytest.approx((least, most), abs=0.006)


def test_claim_6_leg_force_does_not_depend_on_the_speed_and_peaks_in_the_turns():
    slow, fast = swung(5.0), swung(12.0)
    np.testing.assert_allclose(slow.leg_force, fast.leg_force, atol=1e-9)
    phase = np.rad2deg(np.pi * slow.time) % 360.0
    force = slow.leg_force[:, 0]
    peaks = np.flatnonzero((force[1:-1] > force[:-2]) & (force[1:-1] > force[2:])) + 1
    dips = np.flatnonzero((force[1:-1] < force[:-2]) & (force[1:-1] < force[2:])) + 1
    assert np.abs((phase[peaks] % 180.0) - 90.0).max() < 2.0
    assert np.abs(((phase[dips] + 90.0) % 180.0) - 90.0).max() < 2.0
