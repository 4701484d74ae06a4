"""Planned speed against closed forms."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ski_addon.planning.pendulum import Pendulum
from ski_addon.planning.speed import plan_speed, travel_time
from ski_addon.snow import Snow
from ski_addon.spec import SkierSpec, SnowSpec

ARC = np.linspace(0.0, 40.0, 2001)
ZERO = np.zeros_like(ARC)
SLOPE = math.radians(10)
GRAVITY_ALONG, GRAVITY_INTO = 9.81 * math.sin(SLOPE), 9.81 * math.cos(SLOPE)


def upright(y: float = 0.0) -> Pendulum:
    return Pendulum(ZERO + y, ZERO, ZERO + 0.9, ZERO, ZERO + GRAVITY_INTO)


def straight_speed(snow: SnowSpec, drag_area: float, start: float) -> np.ndarray:
    model = Snow.of(snow, SkierSpec(mass=80, drag_area=drag_area))
    return plan_speed(ARC, ZERO, ZERO + GRAVITY_ALONG, upright(), model, start)


def test_frictionless_energy():
    speed = straight_speed(SnowSpec(friction=0, friction_per_speed=0), 0.0, 3.0)
    np.testing.assert_allclose(speed**2, 9.0 + 2 * GRAVITY_ALONG * ARC, rtol=1e-9)


def test_constant_friction():
    speed = straight_speed(SnowSpec(friction=0.1, friction_per_speed=0), 0.0, 3.0)
    np.testing.assert_allclose(speed**2, 9.0 + 2 * (GRAVITY_ALONG - 0.1 * GRAVITY_INTO) * ARC, rtol=1e-9)


def test_drag_approaches_the_terminal_speed():
    """v^2 = V^2 - (V^2 - v0^2) exp(-2 k s), V^2 = a / k."""
    speed = straight_speed(SnowSpec(friction=0.05, friction_per_speed=0), 2.0, 30.0)
    k = 0.5 * 1.2 * 2.0 / 80
    top = (GRAVITY_ALONG - 0.05 * GRAVITY_INTO) / k
    np.testing.assert_allclose(speed**2, top - (top - 900.0) * np.exp(-2 * k * ARC), rtol=1e-5)


def test_friction_that_grows_with_speed():
    """v' = a - b v: arc length over speed is s = (v0 - v) / b + (a / b^2) ln((a - b v0) / (a - b v))."""
    speed = straight_speed(SnowSpec(friction=0.05, friction_per_speed=0.02), 0.0, 4.0)
    a, b = GRAVITY_ALONG - 0.05 * GRAVITY_INTO, 0.02 * GRAVITY_INTO
    arc = (4.0 - speed) / b + a / b**2 * np.log((a - b * 4.0) / (a - b * speed))
    np.testing.assert_allclose(arc, ARC, atol=1e-3)


def test_friction_stops_the_skier_at_the_braking_distance():
    model = Snow.of(SnowSpec(friction=0.4, friction_per_speed=0), SkierSpec(drag_area=0))
    speed = plan_speed(ARC, ZERO, ZERO, upright(), model, 6.0)
    distance = 36.0 / (2 * 0.4 * GRAVITY_INTO)
    assert np.all(speed[distance + 0.1 < ARC] == 0.0) and np.all(speed[distance - 0.1 > ARC] > 0.0)


def test_body_on_the_inner_lane_keeps_its_own_energy():
    """In a steady turn on flat frictionless ground nothing changes; gravity works on the body's way, not the skis'."""
    free = Snow.of(SnowSpec(friction=0, friction_per_speed=0), SkierSpec(drag_area=0))
    bend, offset = ZERO + 0.1, 0.5
    np.testing.assert_allclose(plan_speed(ARC, bend, ZERO, upright(offset), free, 8.0), 8.0, rtol=1e-12)
    speed = plan_speed(ARC, bend, ZERO + 1.0, upright(offset), free, 8.0)
    inside = 1.0 - 0.1 * offset
    np.testing.assert_allclose(
        (inside * speed) ** 2 - (inside * 8.0) ** 2, 2 * 1.0 * inside * ARC, rtol=1e-6, atol=1e-9
    )


def test_travel_time_of_an_even_acceleration():
    speed = np.sqrt(4.0 + 2 * 1.5 * ARC)
    time = travel_time(ARC, speed)
    np.testing.assert_allclose(time, (speed - 2.0) / 1.5, rtol=1e-12, atol=1e-12)
    assert time[0] == 0.0 and time[-1] == pytest.approx((speed[-1] - 2) / 1.5)
