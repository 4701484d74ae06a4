"""Phase control of one body and of many: frequency, sharpness and heading over time [VP93 sec. 5]."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.turning.body import TurningBody
from ski_addon.turning.pace import Pace
from ski_addon.turning.steering import FELL, RUNNING, STOPPED, Start, Steered, Targets, steer

STEP, SPEED = 0.01, 8.0


def targets(duration: float, period, sharpness_deg, heading_deg=0.0) -> Targets:
    """Targets of one body; each a number or a function of time."""
    time = STEP * np.arange(round(duration / STEP))

    def over(value) -> np.ndarray:
        return np.broadcast_to(value(time) if callable(value) else value, time.shape)[:, None]

    return Targets(STEP, 2.0 * np.pi / over(period), np.deg2rad(over(sharpness_deg)), np.deg2rad(over(heading_deg)))


def mean_course(run: Steered) -> np.ndarray:
    """Direction [degrees] in the middle of each whole half swing."""
    at = [turn.index for turn in run.turns]
    ends = np.rad2deg(run.course[at, 0])
    return 0.5 * (ends[1:] + ends[:-1])


def test_claim_10_beta_is_chosen_at_phases_0_and_180_only():
    run = steer(TurningBody(), targets(20.0, 2.0, 20.0, lambda t: 20.0 * np.sin(0.5 * t)), Start(SPEED))
    changed = np.flatnonzero(np.diff(run.beta[:, 0])) + 1
    assert len(changed) > 10
    assert np.abs(run.lean[changed, 0]).max() < STEP * np.abs(run.lean_rate).max()
    assert changed.tolist() == [turn.index for turn in run.turns if turn.index]


def test_claim_10_a_short_right_turn_changes_the_direction_to_the_left():
    """Fig. 8: the one turn after 26 m is shorter, the others are as before, 14 degrees further left."""
    run = steer(TurningBody(), targets(8.0, 2.0, 20.0, lambda t: np.where(SPEED * t < 26.0, 0.0, 14.0)), Start(SPEED))
    beta = np.array([turn.beta[0] for turn in run.turns])
    short = np.flatnonzero(np.abs(beta - 1.0) > 0.02)
    assert short.tolist() == [3] and run.turns[3].side == -1.0 and beta[3] < 0.5
    at = run.turns[3].index, run.turns[4].index
    assert run.down[at[0], 0] < 26.0 < run.down[at[1], 0]
    assert mean_course(run)[:3] == pytest.approx(0.0, abs=0.1)
    assert mean_course(run)[4:] == pytest.approx(14.0, abs=0.15)


@pytest.mark.parametrize(
    ("asked", "worst"),
    [
        ((20.0, lambda t: 1.4 + 0.12 * t, 20.0), 0.1),
        ((20.0, 2.0, lambda t: 5.0 + 1.4 * t), 0.3),
    ],
)
def test_claim_11_heading_does_not_drift_while_frequency_and_sharpness_change(asked, worst):
    run = steer(TurningBody(), targets(*asked), Start(SPEED))
    assert np.abs(mean_course(run)).max() < worst * 10.0
    assert abs(run.left[-1, 0]) < 2.5


def test_claim_11_two_bodies_half_a_swing_apart_make_figures_of_eight():
    asked = targets(14.0, 2.6, 26.0)
    both = Targets(
        STEP, *(np.repeat(values, 2, axis=1) for values in (asked.frequency, asked.sharpness, asked.heading))
    )
    run = steer(TurningBody(), both, Start(SPEED, np.array([1.0, -1.0])))
    np.testing.assert_allclose(run.left[:, 0], -run.left[:, 1], atol=1e-9)
    crossings = np.flatnonzero(np.diff(np.sign(run.left[:, 0] - run.left[:, 1])))
    assert len(crossings) >= 9
    np.testing.assert_allclose(np.diff(run.down[crossings, 0])[1:], 10.3, atol=0.3)


def test_claim_11_frequency_falls_and_sharpness_rises_as_asked():
    slower = steer(TurningBody(), targets(20.0, lambda t: 1.4 + 0.12 * t, 20.0), Start(SPEED))
    lasts = STEP * np.diff([turn.index for turn in slower.turns])
    middle = STEP * np.array([turn.index for turn in slower.turns][:-1]) + 0.5 * lasts
    np.testing.assert_allclose(lasts, 0.5 * (1.4 + 0.12 * middle), rtol=0.06)
    sharper = steer(TurningBody(), targets(20.0, 2.0, lambda t: 5.0 + 1.4 * t), Start(SPEED))
    lean = np.abs(np.rad2deg(sharper.lean[:, 0]))
    peaks = np.flatnonzero((lean[1:-1] > lean[:-2]) & (lean[1:-1] > lean[2:])) + 1
    np.testing.assert_allclose(lean[peaks], 5.0 + 1.4 * STEP * peaks, rtol=0.12)


def test_claim_16_a_thousand_bodies_at_once_do_what_each_does_alone():
    rng = np.random.default_rng(5)
    count, moments = 1000, 300
    period, sharpness = rng.uniform(1.4, 4.0, count), rng.uniform(0.05, 0.5, count)
    heading = rng.uniform(-0.3, 0.3, count) * np.linspace(0.0, 1.0, moments)[:, None]
    shape = (moments, count)
    asked = Targets(STEP, np.broadcast_to(2 * np.pi / period, shape), np.broadcast_to(sharpness, shape), heading)
    speed = rng.uniform(5.0, 12.0, count)
    pace = Pace(9.66, 1.7, 0.071, 0.004, 0.005, most=9.0)
    many = steer(TurningBody(), asked, Start(speed), pace)
    for body in (0, 17, 503, 999):
        own = Targets(STEP, *(values[:, body : body + 1] for values in (asked.frequency, asked.sharpness, heading)))
        single = steer(TurningBody(), own, Start(float(speed[body])), pace)
        for name in ("down", "left", "course", "speed", "lean", "curvature", "phase"):
            np.testing.assert_allclose(getattr(single, name)[:, 0], getattr(many, name)[:, body], atol=1e-8)


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_a_body_that_goes_straight_on_is_sent_into_its_first_turn(side):
    run = steer(TurningBody(), targets(8.0, 2.0, 20.0), Start(SPEED, side, swinging=False))
    assert run.lean[0, 0] == 0.0 == run.curvature[0, 0] or abs(run.curvature[0, 0]) <= STEP
    first = run.lean[np.argmax(np.abs(run.lean[:, 0]) > 0.1), 0]
    assert np.sign(first) == side
    assert mean_course(run)[2:] == pytest.approx(0.0, abs=0.5)


def test_curvature_and_its_rate_keep_within_their_bounds():
    body = TurningBody(curvature_bound=0.12, curvature_rate_bound=0.39)
    run = steer(body, targets(12.0, 2.0, 23.0), Start(SPEED))
    assert np.abs(run.curvature).max() == pytest.approx(0.12)
    assert np.abs(np.diff(run.curvature[:, 0])).max() <= 0.39 * STEP + 1e-12
    assert run.ended[0] == RUNNING and np.abs(run.lean).max() < 0.6


@pytest.mark.parametrize("heading_deg", [0.0, 25.0, -30.0])
def test_heading_is_kept_across_a_slope(heading_deg):
    """Gravity pulls the body down the fall line all the time; the turns make up for it."""
    pace = Pace(9.81 * np.cos(0.2), 9.81 * np.sin(0.2), held=True)
    run = steer(TurningBody(), targets(16.0, 2.2, 22.0, heading_deg), Start(SPEED), pace)
    assert mean_course(run)[2:] == pytest.approx(heading_deg, abs=0.6)


def test_speed_is_what_slope_and_snow_leave():
    """A straight run down 10 degrees, and one held by skidding in its turns."""
    slope = {"gravity_normal": 9.81 * np.cos(0.1745), "gravity_down": 9.81 * np.sin(0.1745), "friction": 0.07}
    free = steer(TurningBody(), targets(6.0, 2.0, 0.5), Start(4.0), Pace(**slope))
    gain = slope["gravity_down"] - 0.07 * slope["gravity_normal"]
    assert free.speed[-1, 0] == pytest.approx(4.0 + gain * (6.0 - STEP), rel=1e-3)
    held = steer(TurningBody(), targets(14.0, 2.2, 24.0), Start(6.0), Pace(**slope, most=6.5))
    assert (
        held.speed.max() < 6.9 < steer(TurningBody(), targets(14.0, 2.2, 24.0), Start(6.0), Pace(**slope)).speed.max()
    )


def test_a_body_without_speed_has_stopped_and_one_that_cannot_steer_falls():
    stopped = steer(TurningBody(), targets(10.0, 2.0, 0.3), Start(3.0), Pace(friction=0.1))
    assert stopped.ended[0] == STOPPED and stopped.time[stopped.last[0]] == pytest.approx(2.55, abs=0.03)
    stiff = TurningBody(curvature_bound=0.01, curvature_rate_bound=0.05)
    assert steer(stiff, targets(10.0, 2.0, 20.0), Start(3.0)).ended[0] == FELL


def test_halving_the_step_changes_errors_to_a_quarter():
    def course(step: float) -> float:
        time = step * np.arange(round(3.0 / step) + 1)[:, None]
        asked = Targets(step, np.pi + 0.0 * time, 0.4 + 0.0 * time, 0.0 * time)
        return float(steer(TurningBody(), asked, Start(SPEED)).left[-1, 0])

    exact = course(0.00125)
    assert abs(course(0.01) - exact) < 0.35 * abs(course(0.02) - exact) < 0.02
