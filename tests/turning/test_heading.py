"""How far a turn turns, and turns that change the direction [VP93 sec. 5.2]."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.turning.body import TurningBody, support_speed
from ski_addon.turning.heading import half_swing, heading_change, small_lean_modifier, turn_modifier

SPEED, ASKED = 8.0, np.deg2rad(10.0)
TURNS = [(3.0, 7.0, 10.1), (2.0, 7.0, 10.2), (2.0, 10.0, 10.3), (2.0, 23.0, 11.6), (1.5, 23.0, 12.2)]
"""Period [s], sharpness [degrees], and the change [degrees] that Eq. 11 makes of 10."""


def turned(body: TurningBody, sharpness: float, frequency: float, speed: float = SPEED) -> float:
    """Direction changed in half a swing, by adding up the curvature of Eq. 1."""
    time, step = np.linspace(0.0, np.pi / frequency, 20001, retstep=True)
    lean = sharpness * np.sin(frequency * time)
    curvature = body.curvature_for(lean, -(frequency**2) * lean, speed)
    rate = support_speed(lean, curvature, speed, body.leg_length) * curvature
    return float(step * (rate.sum() - 0.5 * (rate[0] + rate[-1])))


@pytest.mark.parametrize("body", [TurningBody(), TurningBody(leg_length=0.8, inertia=0.1)])
@pytest.mark.parametrize("speed", [4.0, 8.0, 14.0])
def test_two_columns_are_the_papers_whole_table(body, speed):
    """Any frequency, sharpness and speed: what a swing of Eq. 1 really does."""
    for sharpness in np.deg2rad([3.0, 23.0, 45.0, 60.0]):
        for period in (1.2, 2.0, 4.0):
            found = heading_change(body, sharpness, 2.0 * np.pi / period, speed)
            assert found == pytest.approx(turned(body, sharpness, 2.0 * np.pi / period, speed), rel=1e-5)


@pytest.mark.parametrize(("period", "sharpness_deg", "found"), TURNS)
def test_claim_9_equation_11_gives_a_little_more_than_asked(period, sharpness_deg, found):
    body, w, a = TurningBody(), 2.0 * np.pi / period, np.deg2rad(sharpness_deg)
    beta = float(small_lean_modifier(ASKED, a, w, SPEED))
    assert np.rad2deg(turned(body, beta * a, w / beta) - turned(body, a, w)) == pytest.approx(found, abs=0.06)


@pytest.mark.parametrize(("period", "sharpness_deg", "_found"), [*TURNS, (1.2, 40.0, 0.0)])
@pytest.mark.parametrize("change_deg", [10.0, 4.0, -4.0])
def test_claim_9_the_table_with_newton_is_within_one_percent(period, sharpness_deg, _found, change_deg):
    body, w, a = TurningBody(), 2.0 * np.pi / period, np.deg2rad(sharpness_deg)
    before = turned(body, a, w)
    wanted = np.array([before + np.deg2rad(change_deg)])
    beta, missed = turn_modifier(body, wanted, np.array([a]), np.array([w]), np.array([SPEED]))
    got = turned(body, float(beta[0]) * a, w / float(beta[0])) - before
    assert np.rad2deg(got) == pytest.approx(change_deg, rel=0.01)
    assert (beta > 1.0) == (change_deg > 0.0) and abs(missed[0]) < 1e-6


def test_claim_9_a_change_to_the_left_makes_left_turns_longer_and_right_turns_shorter():
    assert small_lean_modifier(ASKED, 0.2, 3.0, SPEED, 1.0) > 1.0 > small_lean_modifier(ASKED, 0.2, 3.0, SPEED, -1.0)
    assert small_lean_modifier(-ASKED, 0.2, 3.0, SPEED, -1.0) > 1.0
    assert small_lean_modifier(0.0, 0.2, 3.0, SPEED) == 1.0


def test_a_change_beyond_a_straight_turn_has_no_beta_and_is_left_to_later_turns():
    """[reading g]: 8.2 degrees are the most for 7 degrees of lean, 3 s and 8 m/s."""
    w, a = 2.0 * np.pi / 3.0, np.deg2rad(7.0)
    assert (
        small_lean_modifier(-np.deg2rad(8.1), a, w, SPEED) > 0.0 == small_lean_modifier(-np.deg2rad(8.3), a, w, SPEED)
    )
    before = turned(TurningBody(), a, w)
    wanted = np.array([before - np.deg2rad(20.0)])
    beta, missed = turn_modifier(TurningBody(), wanted, np.array([a]), np.array([w]), np.array([SPEED]))
    assert beta[0] == 0.3
    assert missed[0] == pytest.approx(wanted[0] - turned(TurningBody(), 0.3 * a, w / 0.3), abs=1e-4)


def test_duration_of_a_modified_half_swing():
    a, w = 0.3, 2.0
    assert half_swing(1.0, a, w, w * a) == pytest.approx(np.pi / w)
    assert half_swing(1.5, a, w, w * a) == pytest.approx(1.5 * np.pi / w)
