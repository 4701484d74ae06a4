"""The balanced centre of mass against what can be derived by hand."""

from __future__ import annotations

import numpy as np
import pytest

from ski_addon.planning.pendulum import (
    balanced_pendulum,
    derivative,
    second_derivative,
    speed_for_lean,
)

G, LENGTH = 9.81, 0.85
TIME = np.arange(0.0, 4.0, 0.005)
ONES = np.ones_like(TIME)


def pendulum(curvature, speed, left=0.0, into=G, least_load=0.25, extension=0.1):
    return balanced_pendulum(
        TIME, curvature * ONES, speed * ONES, left * ONES, into * ONES, LENGTH, least_load, extension
    )


@pytest.mark.parametrize(("speed", "radius"), [(5.0, 15.0), (9.0, 15.0), (9.0, -10.0), (12.0, 25.0)])
def test_claim_17_lean_of_a_steady_turn(speed, radius):
    """tan(lean) = u^2 / (g R) of the centre of mass's own speed u and radius R; both are smaller than the skis'."""
    steady = pendulum(1.0 / radius, speed)
    middle = len(TIME) // 2
    own_radius = radius - steady.y[middle]
    own_speed = speed * own_radius / radius
    assert np.tan(steady.inclination[middle]) == pytest.approx(own_speed**2 / (G * own_radius), rel=1e-6)
    assert np.hypot(steady.y[middle], steady.h[middle]) == pytest.approx(LENGTH, rel=1e-9)
    assert steady.normal[middle] == pytest.approx(G)


def test_claim_17_paper_limit():
    """tan(lean) = v^2 / (g r) [SG19 Eq. 7] when the circle is large against the skier."""
    steady = pendulum(1.0 / 1000.0, 40.0)
    assert np.tan(steady.inclination[400]) == pytest.approx(40.0**2 / (G * 1000.0), rel=1e-3)


@pytest.mark.parametrize("degrees", [-20.0, 8.0, 30.0])
def test_claim_17_traverse(degrees):
    """Straight across a slope the skier stands upright in the world: leaning from the snow's normal by the slope."""
    slope = np.deg2rad(degrees)
    still = pendulum(0.0, 6.0, left=G * np.sin(slope), into=G * np.cos(slope))
    np.testing.assert_allclose(still.inclination, -slope, atol=1e-6)


def test_claim_17_straight_on_flat_ground_is_upright():
    still = pendulum(0.0, 6.0)
    np.testing.assert_allclose(still.y, 0.0, atol=1e-12)
    np.testing.assert_allclose(still.h, LENGTH, atol=1e-12)


def swinging(least_load=0.0, quick=0.12, bend=0.1, speed=9.0, extension=0.1):
    """A turn to the left that changes to the right at 2 s, within about 3 `quick` seconds."""
    curvature = -bend * np.tanh((TIME - 2.0) / quick)
    return curvature, balanced_pendulum(
        TIME, curvature, speed * ONES, 0 * ONES, G * ONES, LENGTH, least_load, extension
    )


def test_pendulum_obeys_its_equation_of_motion():
    """y'' = (normal / h + (kappa v)^2) y + g_left - kappa v^2, with h'' in the normal force; by finite differences."""
    curvature, swing = swinging()
    left_hand = second_derivative(TIME, swing.y)
    right_hand = (swing.normal / swing.h + (curvature * 9.0) ** 2) * swing.y - curvature * 81.0
    np.testing.assert_allclose(left_hand[3:-3], right_hand[3:-3], atol=1e-4)
    np.testing.assert_allclose(G + second_derivative(TIME, swing.h)[3:-3], swing.normal[3:-3], atol=1e-6)
    np.testing.assert_allclose(np.gradient(swing.y, TIME)[3:-3], swing.y_rate[3:-3], atol=1e-9)
    np.testing.assert_allclose(np.gradient(swing.h, TIME)[3:-3], swing.h_rate[3:-3], atol=1e-9)


def test_pendulum_anticipates():
    """A bounded pendulum moves before its turn does: it crosses with the turn's change, and starts to move earlier."""
    curvature, swing = swinging()
    assert abs(np.interp(2.0, TIME, swing.y)) < 1e-3
    before = np.searchsorted(TIME, 1.6)
    steady_left = pendulum(0.1, 9.0).y[400]
    assert curvature[before] > 0.99 * 0.1 and swing.y[before] < 0.9 * steady_left


@pytest.mark.parametrize("least", [0.5, 0.8])
def test_load_never_falls_below_what_is_asked(least):
    """A rigid leg would be unloaded by a quick change of edges; the legs bend and stretch to keep the load."""
    rigid, kept = swinging()[1], swinging(least_load=least)[1]
    assert rigid.normal.min() < 0.8 * G, "the case is too easy to test anything"
    assert kept.normal.min() >= least * G
    assert np.all(np.hypot(kept.y, kept.h) <= LENGTH + 0.1 + 1e-6)


def test_extension_is_the_limit_of_the_legs():
    _, kept = swinging(least_load=0.9, extension=0.01, speed=10.0)
    assert np.hypot(kept.y, kept.h).max() <= LENGTH + 0.01 + 1e-3


def test_mirrored_turn_gives_the_mirrored_lean():
    bend = 0.1 * np.sin(2.0 * TIME) + 0.02
    left, right = (
        balanced_pendulum(TIME, side * bend, 8 * ONES, side * 0.3 * ONES, G * ONES, LENGTH, 0.25, 0.1)
        for side in (1, -1)
    )
    np.testing.assert_allclose(left.y, -right.y, atol=1e-12)
    np.testing.assert_allclose(left.h, right.h, atol=1e-12)


def test_derivatives_are_exact_for_parabolas_on_uneven_time():
    time = np.sort(np.random.default_rng(0).uniform(0, 1, 40))
    np.testing.assert_allclose(derivative(time, 3 * time**2 - time), 6 * time - 1, atol=1e-10)
    np.testing.assert_allclose(second_derivative(time, 3 * time**2 - time), 6.0, atol=1e-6)


@pytest.mark.parametrize("left", [-1.5, 0.0, 1.5])
@pytest.mark.parametrize("bend", [-0.1, 0.04])
def test_speed_for_a_lean_is_the_way_back(bend, left):
    lean = np.deg2rad(35.0)
    speed = speed_for_lean(np.sign(bend) * lean, np.array([bend]), np.array([left]), np.array([G]), LENGTH)[0]
    steady = pendulum(bend, speed, left=left)
    assert abs(steady.inclination[400]) == pytest.approx(lean, rel=1e-6)


def test_speed_for_a_lean_where_the_track_does_not_ask_for_one():
    """Any speed will do on a straight, or where the track bends away; none where gravity alone asks for more."""
    bends, pulls = np.array([0.0, -0.1, 0.1]), np.array([0.0, 0.0, -30.0])
    speeds = speed_for_lean(0.5, bends, pulls, np.full(3, G), LENGTH)
    np.testing.assert_array_equal(speeds, [np.inf, np.inf, 0.0])
