"""How a skier who is off the plan leans over the steered line, where his skis point, and how both go on."""

from __future__ import annotations

import math
from dataclasses import dataclass

from .deviation import Deviation
from .steering import Steering

DEEPEST = 0.94
"""Most sideways offset of the centre of mass over the skis, in units of its distance from them."""
SLOWEST = 0.5
"""Least speed [m/s] by which the direction of the steered line is judged."""
FLATTEST, FLATTEN_PUSH, BEYOND_FLAT = math.radians(10.0), 2.0, math.radians(3.0)
"""Skis are rolled by up to the first [rad] towards flat, and the third beyond, before a push that turns the body over
the edges that bear by the second [m/s^2] or more: then the other edges hold.
"""


@dataclass(frozen=True)
class Lean:
    """The lean off the plan: `angle` [rad, left] and its `rate` [rad/s].

    The height of the centre of mass differs from the planned by `rise` [m], changing by `rise_rate` [m/s] and
    `rise_acceleration` [m/s^2]; `sideways` [m/s^2] is what it is accelerated to the left off the plan.
    """

    angle: float
    rate: float
    rise: float
    rise_rate: float
    rise_acceleration: float
    sideways: float


@dataclass(frozen=True)
class Heading:
    """Turn of the skis off the plan `angle` [rad, left], `rate` [rad/s] and `acceleration` [rad/s^2]."""

    angle: float
    rate: float
    acceleration: float


def steered_heading(steering: Steering, deviation: Deviation, grip: float = 1.0) -> Heading:
    """Return the direction of the steered line against the planned skis; those without `grip` slide there unturned."""
    speed = max(deviation.speed - steering.offset * deviation.turning, SLOWEST)
    drift = steering.rate
    square = speed * speed + drift * drift
    turn = speed / square
    rate = steering.acceleration * turn
    acceleration = steering.jerk * turn - 2.0 * drift * steering.acceleration * rate / square
    return Heading(grip * math.atan2(drift, speed), grip * rate, grip * acceleration)


def measured_lean(steering: Steering, deviation: Deviation, push: float, planned: float) -> Lean:
    """Return the lean over the steered line against the planned one, and how it goes on.

    The body is a pendulum on a leg of the planned length: `push` [m/s^2] from outside, gravity and snow accelerate it.
    `planned` [m/s^2] is the plan's sideways acceleration at the planned speed.
    """
    d = deviation
    length = math.hypot(d.planned_y, d.planned_h)
    most = DEEPEST * length
    over = min(max(d.planned_y + d.y - steering.offset, -most), most)
    over_rate = d.planned_y_rate + d.y_rate - steering.rate
    height = math.sqrt(length * length - over * over)
    growth = d.planned_y * d.planned_y_rate + d.planned_h * d.planned_h_rate
    height_rate = (growth - over * over_rate) / height
    angle = math.atan2(over, d.h) - math.atan2(d.planned_y, d.planned_h)
    rate = _turning(over, over_rate, d.h, d.h_rate)
    rate -= _turning(d.planned_y, d.planned_y_rate, d.planned_h, d.planned_h_rate)
    # sideways acceleration over the skis = that of the body in the world + the frame's part
    square = d.turning * d.turning
    frame = square * (d.planned_y + d.y) - d.centripetal - steering.acceleration
    planned_bend = d.sideways - d.centripetal + square * d.planned_y
    planned_fall = _fall(d.planned_y, d.planned_y_rate, planned_bend, d.planned_h, d.planned_h_rate)
    load = d.pull * d.planned_h + _fall(over, over_rate, frame, height, height_rate) - planned_fall
    lever = over - steering.shift
    free = planned - d.pull * d.planned_y + push
    sideways = (free + lever * load / height) / max(1.0 + over * lever / (height * height), 0.5)
    fall = _fall(over, over_rate, sideways + frame, height, height_rate) - planned_fall
    return Lean(angle, rate, height - d.planned_h, height_rate - d.planned_h_rate, fall, sideways - d.sideways)


def _turning(y: float, y_rate: float, h: float, h_rate: float) -> float:
    """Return the rate [rad/s] of the angle whose tangent is y / h."""
    return (y_rate * h - y * h_rate) / (y * y + h * h)


def _fall(y: float, y_rate: float, y_acceleration: float, h: float, h_rate: float) -> float:
    """Return h'' of a leg of fixed length that leans."""
    return -(y_rate * y_rate + y * y_acceleration + h_rate * h_rate) / h


def flattening(edge: float, tipping: float) -> float:
    """Return the roll [rad] that brings the lifted edges of skis at `edge` [rad] down before `tipping` [m/s^2]."""
    if edge * tipping >= 0.0:
        return 0.0
    most = min(FLATTEST * min(abs(tipping) / FLATTEN_PUSH, 1.0), abs(edge) + BEYOND_FLAT)
    return math.copysign(most, tipping)
