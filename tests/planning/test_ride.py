"""The ride against closed forms: gliding, braking by skidding, starting from rest and stopping."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.course import Track
from ski_addon.planning.ride import Body, Ride, SpeedControl, plan_ride
from ski_addon.planning.ride_steps import AIM
from ski_addon.snow import Snow
from ski_addon.spec import SkierSpec, SnowSpec

LENGTH = 40.0
SLOPE = math.radians(10)
GRAVITY_ALONG, GRAVITY_INTO = 9.81 * math.sin(SLOPE), 9.81 * math.cos(SLOPE)
FREE = Snow.of(SnowSpec(friction=0, friction_per_speed=0), SkierSpec(mass=80, drag_area=0))
BODY = Body(np.array([GRAVITY_INTO]))


def straight(start: float, slope: float = SLOPE, stop_from: float = np.inf, bend: float = 0.0) -> Track:
    """A straight track down a plane, which may claim a curvature."""
    arc = np.linspace(0.0, LENGTH, 801)
    tangent = np.array([math.cos(slope), 0.0, -math.sin(slope)])
    normal = np.array([math.sin(slope), 0.0, math.cos(slope)])
    zero = np.zeros_like(arc)
    return Track(
        arc_length=arc,
        position=arc[:, None] * tangent,
        tangent=np.broadcast_to(tangent, (801, 3)).copy(),
        surface_normal=np.broadcast_to(normal, (801, 3)).copy(),
        curvature=zero + bend,
        normal_curvature=zero.copy(),
        torsion=zero.copy(),
        phase=zero.astype(np.int8),
        turn=zero.astype(int) + 1,
        start_speed=start,
        stop_from=stop_from,
    )


def ride(track: Track, snow: SnowSpec, drag_area: float = 0.0, control: SpeedControl | None = None) -> Ride:
    model = Snow.of(snow, SkierSpec(mass=80, drag_area=drag_area))
    return plan_ride(track, model, BODY, control or SpeedControl())


def test_frictionless_energy():
    free = ride(straight(3.0), SnowSpec(friction=0, friction_per_speed=0))
    np.testing.assert_allclose(free.speed**2, 9.0 + 2 * GRAVITY_ALONG * free.arc_length, rtol=1e-9)


def test_constant_friction():
    slowed = ride(straight(3.0), SnowSpec(friction=0.1, friction_per_speed=0))
    gain = GRAVITY_ALONG - 0.1 * GRAVITY_INTO
    np.testing.assert_allclose(slowed.speed**2, 9.0 + 2 * gain * slowed.arc_length, rtol=1e-9)
    np.testing.assert_allclose(slowed.acceleration, gain, rtol=1e-9)


def test_drag_approaches_the_terminal_speed():
    """v^2 = V^2 - (V^2 - v0^2) exp(-2 k s), V^2 = a / k."""
    fast = ride(straight(30.0), SnowSpec(friction=0.05, friction_per_speed=0), 2.0)
    k = 0.5 * 1.2 * 2.0 / 80
    top = (GRAVITY_ALONG - 0.05 * GRAVITY_INTO) / k
    np.testing.assert_allclose(fast.speed**2, top - (top - 900.0) * np.exp(-2 * k * fast.arc_length), rtol=1e-5)


def test_friction_that_grows_with_speed():
    """v' = a - b v: arc length over speed is s = (v0 - v) / b + (a / b^2) ln((a - b v0) / (a - b v))."""
    slowed = ride(straight(4.0), SnowSpec(friction=0.05, friction_per_speed=0.02))
    a, b = GRAVITY_ALONG - 0.05 * GRAVITY_INTO, 0.02 * GRAVITY_INTO
    arc = (4.0 - slowed.speed) / b + a / b**2 * np.log((a - b * 4.0) / (a - b * slowed.speed))
    np.testing.assert_allclose(arc, slowed.arc_length, atol=1e-3)


def test_friction_stops_the_skier_at_the_braking_distance():
    braked = ride(straight(6.0, slope=0.0), SnowSpec(friction=0.4, friction_per_speed=0))
    assert braked.stopped_at == pytest.approx(36.0 / (2 * 0.4 * GRAVITY_INTO), abs=0.02)
    assert ride(straight(6.0), SnowSpec(friction=0.05)).stopped_at is None


def test_ride_ends_exactly_at_the_end_of_the_track():
    for start in (3.0, 7.7, 20.0):
        gone = ride(straight(start), SnowSpec())
        assert gone.arc_length[-1] == pytest.approx(LENGTH, abs=1e-9)
        np.testing.assert_allclose(np.gradient(gone.arc_length, gone.time)[3:-3], gone.speed[3:-3], rtol=1e-4)


def test_start_from_rest_takes_the_time_of_free_gliding():
    begun = ride(straight(0.0), SnowSpec(friction=0.05, friction_per_speed=0))
    gain = GRAVITY_ALONG - 0.05 * GRAVITY_INTO
    assert begun.time[-1] == pytest.approx(math.sqrt(2 * LENGTH / gain), rel=1e-3)


def test_start_from_rest_on_a_slope_that_friction_holds_is_no_start():
    held = ride(straight(0.0, slope=math.radians(2)), SnowSpec(friction=0.05, friction_per_speed=0))
    assert held.stopped_at == 0.0


def test_claim_18_skis_on_a_turn_run_ahead_of_a_swinging_body():
    """What the body's motion over the skis adds along them is taken from the skis' own acceleration."""
    track = straight(5.0, slope=0.0)
    pulled = plan_ride(track, FREE, Body(np.array([9.81]), np.array([0.7])), SpeedControl())
    np.testing.assert_allclose(pulled.acceleration, -0.7, atol=1e-12)


# -- skidding ----------------------------------------------------


@pytest.mark.parametrize("bend", [0.1, -0.1])
def test_skidding_holds_the_speed_and_points_the_skis_into_the_turn(bend):
    track = straight(8.0, slope=math.radians(20), bend=bend)
    model = Snow.of(SnowSpec(), SkierSpec(mass=80, drag_area=0.4))
    held = plan_ride(track, model, BODY, SpeedControl(most=8.0))
    late = held.time > 1.5
    assert np.all(held.speed[late] > AIM * 8.0) and np.all(held.speed[late] < 8.0), "aimed at, and wanted"
    assert np.all(held.steering[late] * bend > 0) and 5 < np.rad2deg(np.abs(held.steering[late])).max() < 35
    free = plan_ride(track, model, BODY, SpeedControl())
    assert free.speed[-1] > 12 and not free.steering.any()


def test_skid_brakes_by_side_force_times_the_tangent_of_the_steering_angle():
    track = straight(8.0, slope=math.radians(20), bend=0.1)
    held = plan_ride(track, FREE, BODY, SpeedControl(most=8.0))
    brake = 9.81 * math.sin(math.radians(20)) - held.acceleration
    np.testing.assert_allclose(brake, 0.1 * held.speed**2 * np.tan(held.steering), atol=1e-4)


def test_skis_are_never_turned_further_than_the_skier_skids():
    track = straight(15.0, slope=math.radians(25), bend=0.05)
    held = plan_ride(track, FREE, BODY, SpeedControl(most=5.0, skid=0.3))
    assert 0.25 < np.abs(held.steering).max() <= 0.3


def test_below_the_wanted_speed_nobody_brakes():
    slow = ride(straight(3.0, bend=0.1), SnowSpec(), control=SpeedControl(most=20.0))
    assert not slow.steering.any()


# -- stopping ----------------------------------------------------


@pytest.mark.parametrize("side", [1, -1])
def test_stop_turns_the_skis_across_brakes_and_stands(side):
    control = SpeedControl(stop_side=side, deceleration=4.0, stand=1.0)
    stop = ride(straight(8.0, stop_from=4.0), SnowSpec(), control=control)
    assert stop.speed[-1] < 0.02 and stop.stopped_at is None
    assert np.rad2deg(side * stop.steering[-1]) == pytest.approx(90, abs=0.1)
    standing = stop.time[-1] - stop.time[np.argmax(stop.speed < 0.02)]
    assert standing == pytest.approx(1.0, abs=0.02)
    assert stop.acceleration.min() == pytest.approx(-4.0, abs=0.05)
    assert not stop.steering[stop.arc_length < 4.0].any()
    assert stop.arc_length[-1] < 4.0 + 8.0 * 1.4 + 8.5**2 / 8.0 + 1.0


def test_steering_is_smooth():
    stop = ride(straight(8.0, stop_from=4.0), SnowSpec(), control=SpeedControl())
    np.testing.assert_allclose(np.gradient(stop.steering, stop.time), stop.steering_rate, atol=1e-12)
    assert np.abs(np.gradient(stop.steering_rate, stop.time)).max() < 50.0
    assert np.abs(np.diff(stop.steering_rate, 2)).max() < 0.05
