"""The loops of a ride against each other: where they mean the same skier, they say the same."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.planning.ride_steps import Ground, Steps, glide, hold, rows, stop
from ski_addon.snow import Snow
from ski_addon.spec import SkierSpec, SnowSpec

SNOW = Snow.of(SnowSpec(), SkierSpec())
PLACES = np.linspace(0.0, 30.0, 601)
STEP = float(PLACES[1])
ALONG, LEFT, BEND = 2.0 + 0.5 * np.sin(PLACES), 0.8 * np.cos(0.7 * PLACES), 0.1 * np.sin(0.5 * PLACES)
NORMAL, SWING, NONE = 9.0 + np.cos(PLACES), 0.4 * np.sin(0.9 * PLACES), np.zeros_like(PLACES)
WHOLE = rows(ALONG, LEFT, BEND, NORMAL, SWING, NONE)
FORESEEN = rows(ALONG, LEFT, BEND)


def held(most: float, stop_from: float = np.inf) -> tuple[Steps, Ground, bool]:
    """The steps of a skier who keeps below `most` [m/s]."""
    steps, ground = Steps(5.0, 0.005), Ground(STEP, stop_from, float(PLACES[-1]), SNOW)
    return steps, ground, hold(steps, ground, WHOLE, FORESEEN, [most] * len(WHOLE), 0.6)


def test_rows_hold_each_value_and_how_it_changes():
    table = rows(np.array([1.0, 3.0, 2.0]), np.array([0.0, 5.0, 5.0]))
    assert table == [(1.0, 0.0, 2.0, 5.0), (3.0, 5.0, -1.0, 0.0)]


def test_who_need_not_brake_glides():
    free = Steps(5.0, 0.005)
    ground = Ground(STEP, np.inf, float(PLACES[-1]), SNOW)
    assert not glide(free, ground, rows(ALONG, NORMAL, SWING))
    braking, _, _ = held(1e6)
    for one, other in zip(free.columns(), braking.columns(), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)
    assert free.arcs[-1] >= PLACES[-1] > free.arcs[-2]


def test_steps_are_of_the_equation_of_motion():
    """v' = g_t + (g_l - kappa v^2) tan(delta) - r / cos(delta) - mu N - D at each step, with a skier who skids."""
    arc, speed, gain, steering = held(4.0)[0].columns()
    assert np.abs(steering).max() > 0.3
    along, left, bend, normal, swing = (np.interp(arc, PLACES, column) for column in (ALONG, LEFT, BEND, NORMAL, SWING))
    friction = (SNOW.friction + SNOW.friction_per_speed * speed) * normal + SNOW.drag_factor * speed**2
    skid = (left - bend * speed**2) * np.tan(steering) - swing / np.cos(steering)
    np.testing.assert_allclose(gain, along + skid - friction, atol=1e-12)


@pytest.mark.parametrize("most", [4.0, 1e6])
def test_a_stop_begins_with_what_went_before(most):
    """Speed, its change and steering go on where the stop's loop takes over."""
    steps, ground, goes_on = held(most, stop_from=15.0)
    assert goes_on
    count = len(steps.arcs)
    stop(steps, ground, WHOLE, 1, 4.0, 1.0)
    whole = held(most)[0]
    assert steps.arcs[count] == whole.arcs[count]
    assert steps.speeds[count] == whole.speeds[count]
    assert steps.steerings[count] == whole.steerings[count]
    assert steps.gains[count] == pytest.approx(whole.gains[count], abs=0.05)  # skids begin to fade at once
    assert abs(steps.steerings[-1]) > 1.5 and steps.speeds[-1] < 0.02
