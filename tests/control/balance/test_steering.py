"""The steered line: within its bounds, back to the plan, and its capture margin against a simulated pendulum."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.control.balance import Reach, Regulator, Steering, acceleration_bounds
from ski_addon.control.balance import steering as module

STEP = 0.002
OMEGA = 3.7
REACH = Reach(-0.12, 0.12, -6.0, 6.0, 5.0)
REGULATOR = Regulator()


def skied(start: float, push: float = 0.0, reach: Reach = REACH, omega: float = OMEGA, seconds: float = 8.0):
    """Rows (xi, E, E', a, s, j) of a pendulum that starts with the divergent component `start` [m] and is pushed by
    `push` [m/s^2] for 0.5 s; it stops when the skier has fallen.
    """
    steering, divergent, rows = Steering(REGULATOR, STEP), start, []
    for i in range(round(seconds / STEP)):
        steering.update(divergent, omega, reach)
        rows.append((divergent, steering.offset, steering.rate, steering.acceleration, steering.shift, steering.jerk))
        force = push if i * STEP < 0.5 else 0.0
        divergent += STEP * (omega * (divergent - steering.offset - steering.shift) + force / omega)
        steering.advance()
        if abs(divergent - steering.offset) > 3.0:
            break
    return np.array(rows)


def test_zero_deviation_steers_nothing():
    assert np.all(skied(0.0, seconds=1.0) == 0.0)


@pytest.mark.parametrize("push", [-4.0, -2.0, 1.0, 4.0])
def test_a_pushed_pendulum_comes_back_to_the_line(push):
    """4 m/s^2 for half a second are 200 N on 50 kg."""
    rows = skied(0.0, push)
    assert np.sign(push) * rows[:, 1].max(initial=0.0) > 0.0 or np.sign(push) * rows[:, 1].min(initial=0.0) > 0.0
    assert np.abs(rows[-1, :3]).max() < 0.02
    assert np.abs(rows[:, 1]).max() < 3.0


def test_mirrored_push_is_answered_by_mirrored_steering():
    np.testing.assert_array_equal(skied(0.1, 3.0), -skied(-0.1, -3.0))


@pytest.mark.parametrize("reach", [REACH, Reach(-0.05, 0.12, -3.0, 7.0, 5.0), Reach(-0.12, 0.05, -8.0, 1.0, 5.0)])
def test_bounds_hold_at_every_step(reach):
    for push in (-4.0, 4.0):
        rows = skied(0.0, push, reach, seconds=3.0)
        assert rows[:, 3].min() >= reach.slowest - 1e-9 and rows[:, 3].max() <= reach.fastest + 1e-9
        assert rows[:, 4].min() >= reach.right and rows[:, 4].max() <= reach.left
        assert np.abs(np.diff(rows[:, 3])).max() <= module.MOST_JERK * STEP + 1e-9


def test_bounds_that_close_in_are_met_without_a_jump():
    steering = Steering(REGULATOR, STEP)
    for _ in range(50):
        steering.update(1.0, OMEGA, REACH)
        steering.advance()
    assert steering.acceleration == pytest.approx(REACH.fastest)
    before = steering.acceleration
    steering.update(1.0, OMEGA, Reach(-0.12, 0.12, -6.0, 1.0, 5.0))
    steering.advance()
    assert before - 2.0 * module.MOST_JERK * STEP <= steering.acceleration < before


@pytest.mark.parametrize("speed", [0.0, 2.0, 5.0, 9.0, 15.0])
def test_acceleration_is_bounded_by_curvature_strength_and_turning(speed):
    low, high = acceleration_bounds(speed, 0.0)
    assert low == -high
    expected = min(module.TIGHTEST * speed**2, module.MOST_ACCELERATION, module.FASTEST_TURNING * speed)
    assert high == pytest.approx(expected)


@pytest.mark.parametrize("centripetal", [-20.0, -4.0, 4.0, 20.0])
def test_what_the_plan_takes_is_not_there_for_steering(centripetal):
    low, high = acceleration_bounds(9.0, centripetal)
    assert low <= 0.0 <= high and high - low == pytest.approx(-2.0 * (low + centripetal))
    assert (low + high) / 2 == pytest.approx(-centripetal)


def caught(start: float, reach: Reach) -> bool:
    """Whether a pendulum that starts at `start` [m] can be caught by the most that can be done, all of it at once."""
    steering, divergent = Steering(REGULATOR, STEP), start
    for _ in range(round(4.0 / STEP)):
        target = reach.fastest if start > 0.0 else reach.slowest
        change = target - steering.acceleration
        steering.jerk = float(np.clip(change / STEP, -module.MOST_JERK, module.MOST_JERK))
        shift = reach.left if start > 0.0 else reach.right
        divergent += STEP * OMEGA * (divergent - steering.offset - shift)
        steering.advance()
        if (divergent - steering.offset) * np.sign(start) < 0.0:
            return True
    return False


@pytest.mark.parametrize("reach", [REACH, Reach(-0.05, 0.12, -2.0, 9.0, 5.0)])
@pytest.mark.parametrize("side", [1.0, -1.0])
def test_the_capture_margin_is_zero_where_the_most_that_can_be_done_only_just_catches(reach, side):
    """Found by bisection on simulated pendulums."""
    low, high = 0.0, 3.0
    for _ in range(30):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if caught(side * middle, reach) else (low, middle)
    margin = Steering(REGULATOR, STEP).capture_margin(side * low, OMEGA, reach)
    assert margin == pytest.approx(0.0, abs=0.01)


def test_the_capture_margin_falls_by_what_the_skier_leans_further():
    steering = Steering(REGULATOR, STEP)
    here, there = (steering.capture_margin(x, OMEGA, REACH) for x in (0.1, 0.15))
    assert here - there == pytest.approx(0.05)
    assert steering.capture_margin(-0.1, OMEGA, REACH) == pytest.approx(here)


def test_faster_skis_come_back_faster_but_not_without_end():
    """After a great push: the sideways speed of coming back grows with the speed, up to a bound."""
    rates = []
    for speed in (3.0, 5.0, 6.0, 9.0):
        rows = skied(0.0, 4.0, Reach(-0.12, 0.12, -6.0, 6.0, speed))
        assert np.abs(rows[-1, :3]).max() < 0.02
        rates.append(-rows[:, 2].min())
    assert rates[0] == rates[1] < 0.98 * rates[2] < 0.98 * rates[3]
    assert rates[3] < 1.6 * rates[1]
