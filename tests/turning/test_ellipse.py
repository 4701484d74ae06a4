"""From any state onto the ellipse that is asked for [VP93 sec. 5.1]."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.turning.ellipse import ControlBounds, as_printed, wanted_acceleration
from ski_addon.turning.numbers import PLAIN

SHARPNESS, FREQUENCY, STEP = np.deg2rad(23.0), np.pi, 0.002
FREE = ControlBounds(origin=0.05, slowest=0.0, quickest=100.0, rounding=1e-6)
"""The paper's ellipses as they are."""
LITERAL = ControlBounds(origin=0.05, reach=1.0, margin=1e-6, rounding=1e-6)
"""alpha_max as soon as a state leaves the box."""


def driven(lean, rate, duration: float, bounds: ControlBounds | None = FREE) -> tuple[np.ndarray, ...]:
    """Lean, rate and radius (n, m), the last in shares of the target's ellipse, of states that are driven to it."""
    lean, rate = np.atleast_1d(np.asarray(lean, float)), np.atleast_1d(np.asarray(rate, float))
    rows = []
    for _ in range(round(duration / STEP)):
        rows.append((lean, rate))
        if bounds is None:
            change = as_printed(lean, rate, FREQUENCY, SHARPNESS, ControlBounds())
        else:
            change = wanted_acceleration(lean, rate, FREQUENCY, SHARPNESS, bounds)
        faster = rate + STEP * change
        lean, rate = lean + 0.5 * STEP * (rate + faster), faster
    lean, rate = (np.array(column) for column in zip(*rows, strict=True))
    return lean, rate, np.hypot(lean / SHARPNESS, rate / (FREQUENCY * SHARPNESS))


def on_circle(phase_deg, radius: float) -> tuple[np.ndarray, np.ndarray]:
    phase = np.deg2rad(phase_deg)
    return radius * SHARPNESS * np.sin(phase), radius * FREQUENCY * SHARPNESS * np.cos(phase)


@pytest.mark.parametrize("radius", [0.3, 0.5, 0.8])
@pytest.mark.parametrize("quadrant", [1, 2, 3, 4])
def test_claim_7_inside_the_box_the_target_is_met_within_a_quarter_of_phase(quadrant, radius):
    """Going out at the greatest lean, coming back when upright: the next axis of the diagram."""
    lean, rate, found = driven(*on_circle(90.0 * quadrant - np.array([75.0, 60.0, 45.0, 30.0]), radius), 10.0)
    axis = rate if quadrant % 2 else lean
    for body in range(lean.shape[1]):
        met = np.argmax(np.diff(np.sign(axis[:, body])) != 0)
        assert met > 0 and abs(found[met, body] - 1.0) < 0.02
    np.testing.assert_allclose(found[-500:], 1.0, atol=2e-3)


@pytest.mark.parametrize("phase_deg", [30.0, 120.0, 200.0, 300.0])
def test_claim_7_controlling_ellipses_are_those_of_the_text(phase_deg):
    """The wanted acceleration is that of Eq. 5 on the ellipse that shares an axis with the target."""
    lean, rate = on_circle(phase_deg, 0.7)
    if lean * rate > 0.0:  # going out: the same greatest lean
        own = rate / (SHARPNESS * np.sqrt(1.0 - (lean / SHARPNESS) ** 2))
    else:  # coming back: the same rate when upright
        own = FREQUENCY * SHARPNESS * np.sqrt(1.0 - (rate / (FREQUENCY * SHARPNESS)) ** 2) / lean
    found = wanted_acceleration(lean, rate, FREQUENCY, SHARPNESS, FREE)
    assert found == pytest.approx(-(own**2) * lean, rel=5e-3)


@pytest.mark.parametrize("bounds", [LITERAL, ControlBounds()])
def test_claim_8_from_outside_the_box_onto_the_ellipse(bounds):
    lean = np.deg2rad([30.0, -30.0, 45.0, 2.0, -5.0, 28.0, -26.0])
    rate = np.deg2rad([0.0, 20.0, 40.0, 110.0, -120.0, -85.0, -85.0])
    _, _, found = driven(lean, rate, 12.0, bounds)
    np.testing.assert_allclose(found[-500:], 1.0, atol=0.01)


def test_claim_8_outside_the_box_the_acceleration_is_constant():
    lean, rate = np.deg2rad([30.0, 40.0, -30.0, 3.0, -3.0]), np.deg2rad([10.0, -20.0, 0.0, 90.0, -90.0])
    found = wanted_acceleration(lean, rate, FREQUENCY, SHARPNESS, LITERAL)
    np.testing.assert_allclose(found, 6.0 * np.array([-1.0, -1.0, 1.0, -1.0, 1.0]))


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_claim_8_from_the_origin_onto_the_ellipse_to_the_side_asked_for(side):
    first = wanted_acceleration(np.zeros(1), np.zeros(1), FREQUENCY, SHARPNESS, ControlBounds(), side)
    assert first == pytest.approx(side * FREQUENCY**2 * SHARPNESS)
    _, _, found = driven(0.0, 0.0, 6.0, ControlBounds())
    np.testing.assert_allclose(found[-500:], 1.0, atol=3e-3)


def test_as_printed_a_body_at_rest_with_a_lean_stays_there():
    """[reading e]: and with the mended assignment of the axes it does not."""
    lean, _, _ = driven(np.deg2rad(5.0), 0.0, 6.0, None)
    assert np.ptp(lean) < 1e-9
    _, _, found = driven(np.deg2rad(5.0), 0.0, 6.0, FREE)
    np.testing.assert_allclose(found[-500:], 1.0, atol=3e-3)


def test_as_printed_a_body_that_leans_too_far_never_comes_back():
    """[reading f]: it chatters about where it was."""
    lean, _, _ = driven(np.deg2rad(30.0), np.deg2rad(-1.0), 6.0, None)
    assert np.rad2deg(lean.min()) > 28.5


def test_acceleration_is_continuous_along_the_ellipse():
    found = wanted_acceleration(*on_circle(np.linspace(0.0, 360.0, 2000), 1.0), FREQUENCY, SHARPNESS, ControlBounds())
    assert np.abs(np.diff(found)).max() < 0.005 * FREQUENCY**2 * SHARPNESS


def test_plain_numbers_give_what_arrays_give():
    rng = np.random.default_rng(4)
    lean, rate = rng.uniform(-0.6, 0.6, 300), rng.uniform(-2.0, 2.0, 300)
    many = wanted_acceleration(lean, rate, FREQUENCY, SHARPNESS, ControlBounds(), -1.0)
    single = [
        wanted_acceleration(a, b, FREQUENCY, SHARPNESS, ControlBounds(), -1.0, PLAIN)
        for a, b in zip(lean.tolist(), rate.tolist(), strict=True)
    ]
    np.testing.assert_allclose(many, single, rtol=1e-12)
