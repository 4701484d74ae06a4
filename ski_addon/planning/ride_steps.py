"""The steps of a ride: Heun's method in plain floats, for these are loops of thousands of small steps.

What a step looks up comes from tables of even steps along the track. There are three loops: one for a skier who lets
the skis run, one for a skier who brakes by skids, and one for the end of a run that stops. All the formulas stand in
the loops, because calls would take most of their time.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..gravity import STANDARD_GRAVITY
from ..snow import Snow

SLOWEST = 0.15
"""A skier slower than this [m/s] has stopped, unless gravity is about to move him."""
CONTROL_TIME = 0.45
"""Time [s] in which a speed above the wanted one is brought down."""
AIM = 0.95
"""Share of the wanted speed that is aimed at: it is exceeded where a turn changes and nothing brakes."""
LEAST_SIDE_FORCE = 1.5
"""Side force per mass [m/s^2] below which skis are turned less and less: a ski without it does not brake."""
LAG = 0.06
"""Time [s] of each of three lags in which the skis follow the wanted steering angle, so that they turn smoothly."""
FASTEST_STEERING, FASTEST_STOP = np.deg2rad(250.0), np.deg2rad(130.0)
"""Most change of the wanted steering angle [rad/s] in turns, and where the skis are thrown across to stop."""
ACROSS = 0.5 * np.pi
"""Steering angle of a stop."""
SKID_FADES = 2.0
"""Way [m] from where the skis begin to turn across on which what pressed on their sides before ceases to brake."""
BRAKE_FROM, BRAKE_TO = np.deg2rad(74.0), np.deg2rad(89.0)
"""Steering angles between which a stop begins to brake."""
SOFT_SPEED = 1.0
"""Speed [m/s] below which a stop brakes in proportion to the speed, so that it ends without a jerk."""
STANDING = 0.02
"""Speed [m/s] at which a skier stands."""

Rows = list[tuple[float, ...]]
"""Rows of a table: of each of its columns the value, then of each how much it changes up to the next row."""


@dataclass(frozen=True)
class Ground:
    """What is under the skis: tables have a row every `step` [m], a stop begins at `stop_from` [m], and the track ends
    at `length` [m]; `snow`.
    """

    step: float
    stop_from: float
    length: float
    snow: Snow


@dataclass
class Steps:
    """The steps of a ride so far, `size` [s] apart; and the lags in which the skis follow the wanted steering angle."""

    start_speed: float
    size: float
    arcs: list[float] = field(default_factory=list)
    speeds: list[float] = field(default_factory=list)
    gains: list[float] = field(default_factory=list)
    steerings: list[float] = field(default_factory=list)
    reached: tuple[float, float] = (0.0, 0.0)
    lags: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 0.0)
    stopped_at: float | None = None

    def __post_init__(self) -> None:
        self.reached = (0.0, self.start_speed)

    def columns(self) -> tuple[np.ndarray, ...]:
        """Return way [m], speed [m/s], its change [m/s^2] and steering [rad] (n,); unsaid steering is none."""
        steering = np.zeros(len(self.arcs))
        steering[len(self.arcs) - len(self.steerings) :] = self.steerings
        return np.array(self.arcs), np.array(self.speeds), np.array(self.gains), steering

    def add(self, arc: float, speed: float, gain: float, steering: float) -> None:
        """Append one step."""
        self.arcs.append(arc)
        self.speeds.append(speed)
        self.gains.append(gain)
        self.steerings.append(steering)


def rows(*columns: np.ndarray) -> Rows:
    """Return the rows of a table with these columns (n,), all but the last, which only ends the one before."""
    values = [column[:-1].tolist() for column in columns]
    changes = [np.diff(column).tolist() for column in columns]
    return list(zip(*values, *changes, strict=True))


def glide(steps: Steps, ground: Ground, table: Rows) -> bool:
    """Let the skis run, up to where a stop begins; return whether the ride goes on there.

    `table` has gravity's part along the track, the snow's normal force and the body's swing. The skis point along the
    track.
    """
    dt, half, step, last = steps.size, 0.5 * steps.size, ground.step, len(table) - 1
    snow = ground.snow
    friction, per_speed, drag = snow.friction, snow.friction_per_speed, snow.drag_factor
    arc, speed = steps.reached
    add_arc, add_speed, add_gain = steps.arcs.append, steps.speeds.append, steps.gains.append
    while arc < ground.stop_from:
        where = arc / step
        index = int(where)
        share = where - index
        if index > last:
            index, share = last, 1.0
        a, b, c, p, q, r = table[index]
        gain = a + share * p - (friction + per_speed * speed) * (b + share * q) - drag * speed * speed - (c + share * r)
        add_arc(arc)
        add_speed(speed)
        add_gain(gain)
        if arc >= ground.length:
            return False
        if speed < SLOWEST and gain <= 0.0:
            steps.stopped_at = arc
            return False
        guess = speed + dt * gain
        guess = guess if guess > 0.0 else 0.0
        where = (arc + dt * speed) / step
        index = int(where)
        share = where - index
        if index > last:
            index, share = last, 1.0
        a, b, c, p, q, r = table[index]
        ahead = (
            a + share * p - (friction + per_speed * guess) * (b + share * q) - drag * guess * guess - (c + share * r)
        )
        after = speed + half * (gain + ahead)
        after = after if after > 0.0 else 0.0
        arc += half * (speed + after)
        speed = after
    steps.reached = (arc, speed)
    return True


def hold(  # noqa: PLR0915 (one loop: calls would take most of its time)
    steps: Steps, ground: Ground, table: Rows, foreseen: Rows, most: list[float], skid: float
) -> bool:
    """Keep below the speeds `most` [m/s] of the tables' places by skids of `skid` [rad] at most; else like `glide`.

    `table` has gravity's parts along the track and to its left, its curvature, the snow's normal force, the body's
    swing, and twice the energy per mass that bumps have taken; `foreseen` the first three, smoothed.
    """
    dt, half, step, last = steps.size, 0.5 * steps.size, ground.step, len(table) - 1
    snow, sqrt, atan, tan, cos = ground.snow, math.sqrt, math.atan, math.tan, math.cos
    friction, per_speed, drag = snow.friction, snow.friction_per_speed, snow.drag_factor
    arc, speed = steps.reached
    wanted, first, second, steering = steps.lags
    quickest, lag, foresight, least = FASTEST_STEERING * dt, dt / LAG, 3.0 * LAG, LEAST_SIDE_FORCE**2
    tangent, cosine, add_steering = tan(steering), cos(steering), steps.steerings.append
    add_arc, add_speed, add_gain = steps.arcs.append, steps.speeds.append, steps.gains.append
    while arc < ground.stop_from:
        where = arc / step
        index = int(where)
        share = where - index
        if index > last:
            index, share = last, 1.0
        a, b, c, d, e, f, p, q, r, s, t, u = table[index]
        gain = a + share * p - (friction + per_speed * speed) * (d + share * s) - drag * speed * speed
        gain += (b + share * q - (c + share * r) * speed * speed) * tangent - (e + share * t) / cosine
        add_arc(arc)
        add_speed(speed)
        add_gain(gain)
        add_steering(steering)
        if arc >= ground.length:
            return False
        if speed < SLOWEST and gain <= 0.0:
            steps.stopped_at = arc
            return False
        v = speed * speed + (f + share * u)
        v = sqrt(v) if v > 0.0 else 0.0
        where = (arc + foresight * speed) / step
        index = int(where)
        share = where - index
        if index > last:
            index, share = last, 1.0
        a, b, c, p, q, r = foreseen[index]
        brake = a + share * p - (friction + per_speed * v) * STANDARD_GRAVITY - drag * v * v
        brake += (v - AIM * most[index]) / CONTROL_TIME
        target = 0.0
        if brake > 0.0:
            side = (c + share * r) * v * v - (b + share * q)
            target = atan(brake * side / (side * side + least))
            target = skid if target > skid else -skid if target < -skid else target
        change = target - wanted
        wanted += quickest if change > quickest else -quickest if change < -quickest else change
        first += lag * (wanted - first)
        second += lag * (first - second)
        steering += lag * (second - steering)
        tangent, cosine = tan(steering), cos(steering)
        guess = speed + dt * gain
        guess = guess if guess > 0.0 else 0.0
        where = (arc + dt * speed) / step
        index = int(where)
        share = where - index
        if index > last:
            index, share = last, 1.0
        a, b, c, d, e, f, p, q, r, s, t, u = table[index]
        ahead = a + share * p - (friction + per_speed * guess) * (d + share * s) - drag * guess * guess
        ahead += (b + share * q - (c + share * r) * guess * guess) * tangent - (e + share * t) / cosine
        after = speed + half * (gain + ahead)
        after = after if after > 0.0 else 0.0
        arc += half * (speed + after)
        speed = after
    steps.reached, steps.lags = (arc, speed), (wanted, first, second, steering)
    return True


def stop(steps: Steps, ground: Ground, table: Rows, side: int, deceleration: float, stand: float) -> None:
    """Turn the skis across the track to the left (`side` +1) or right (-1), brake by `deceleration` [m/s^2], and stand
    for `stand` [s]. `table` is as for `hold`.
    """
    dt, most, stood = steps.size, FASTEST_STOP * steps.size, 0.0
    arc, speed = steps.reached
    wanted, first, second, steering = steps.lags
    while True:
        gain = _stopping(ground, table, arc, speed, steering, deceleration)
        steps.add(arc, speed, gain, steering)
        stood += dt if speed < STANDING else 0.0
        if arc >= ground.length or stood > stand:
            return
        wanted += min(max(side * ACROSS - wanted, -most), most)
        first += dt / LAG * (wanted - first)
        second += dt / LAG * (first - second)
        steering += dt / LAG * (second - steering)
        guess = max(speed + dt * gain, 0.0)
        ahead = _stopping(ground, table, arc + dt * speed, guess, steering, deceleration)
        after = max(speed + 0.5 * dt * (gain + ahead), 0.0)
        arc += 0.5 * dt * (speed + after)
        speed = after


def _stopping(ground: Ground, table: Rows, arc: float, speed: float, steering: float, deceleration: float) -> float:
    """Return v' [m/s^2] of a skier who throws the skis across the track."""
    across = _smooth_step(abs(steering), BRAKE_FROM, BRAKE_TO)
    brake = deceleration * min(speed / SOFT_SPEED, 1.0)
    if across == 1.0:
        return -brake
    where, last = arc / ground.step, len(table) - 1
    index = int(where)
    index, share = (index, where - index) if index <= last else (last, 1.0)
    a, b, c, d, e, _, p, q, r, s, t, _ = table[index]
    glide = ground.snow.glide_acceleration(a + share * p, d + share * s, speed)
    sideways = 1.0 - _smooth_step(arc - ground.stop_from, 0.0, SKID_FADES)
    if sideways > 0.0:
        skid = (b + share * q - (c + share * r) * speed * speed) * math.tan(steering)
        glide += sideways * (skid - (e + share * t) / math.cos(steering))
    return (1.0 - across) * glide - across * brake


def _smooth_step(value: float, low: float, high: float) -> float:
    """Return 0 up to `low`, 1 from `high` on."""
    x = min(max((value - low) / (high - low), 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)
