"""The ride: how fast the skis run along a track, and how far they are turned out of it to brake.

The paper plans without friction and then meets its own snow's, so that plan and physics part. Here gravity, friction
and drag act on the centre of mass. Along the skis nothing but gravity and friction drives a skier, which gives

    v' = g_t + (g_l - kappa v^2) tan(delta) - r / cos(delta) - mu N - D

for a track of curvature kappa, gravity's parts g_t along and g_l to the left of it, and the body's own motion r over
the skis. delta is the steering angle between track and skis: a ski that points further into the turn than it travels
skids, its side force, which is across the ski, has a part against the motion, and the skier brakes. That is how skiers
hold a speed; it needs a side force, so it works in turns. To stop, the skis are turned across the track altogether and
the skier leans back against the motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..course import Track
from ..gravity import GRAVITY, STANDARD_GRAVITY
from ..snow import Snow

TIME_STEP = 0.005
"""Planned time between neighbouring places [s]."""
TABLE_STEP = 0.05
"""Distance between entries of the tables the speed is integrated with [m]."""
SLOWEST = 0.15
"""A skier slower than this [m/s] has stopped, unless gravity is about to move him."""
CONTROL_TIME = 0.45
"""Time [s] in which a speed above the wanted one is brought down."""
AIM = 0.95
"""Share of the wanted speed that is aimed at: it is exceeded where a turn changes and nothing brakes."""
LEAST_SIDE_FORCE = 1.5
"""Side force per mass [m/s^2] below which skis are turned less and less: a ski without it does not brake."""
FORESIGHT = 1.5
"""Standard deviation [m] of the window in which a skier who brakes sees the track: he does not answer single bumps."""
LAG = 0.06
"""Time [s] of each of three lags in which the skis follow the wanted steering angle, so that they turn smoothly."""
FASTEST_STEERING, FASTEST_STOP = np.deg2rad(250.0), np.deg2rad(130.0)
"""Most change of the wanted steering angle [rad/s] in turns, and where the skis are thrown across to stop."""
ACROSS = 0.5 * np.pi
"""Steering angle of a stop."""
BEFORE_BRAKING = 0.9
"""Time [s] from where the skis begin to turn across the track until they brake."""
ARRIVAL = 1.05
"""Most speed to begin a stop's braking with, in units of the speed to keep below."""
SKID_FADES = 2.0
"""Way [m] from where the skis begin to turn across on which what pressed on their sides before ceases to brake."""
BRAKE_FROM, BRAKE_TO = np.deg2rad(74.0), np.deg2rad(89.0)
"""Steering angles between which a stop begins to brake."""
SOFT_SPEED = 1.0
"""Speed [m/s] below which a stop brakes in proportion to the speed, so that it ends without a jerk."""
STANDING = 0.02
"""Speed [m/s] at which a skier stands."""


@dataclass(frozen=True)
class Ride:
    """n moments evenly in `time` [s]: `arc_length` [m], `speed` [m/s], `acceleration` [m/s^2] along the track,
    `steering` [rad] from track to skis, positive to the left, and its rate [rad/s].

    `stopped_at` [m] is where friction stopped the skier before the end of the track, or None.
    """

    time: np.ndarray
    arc_length: np.ndarray
    speed: np.ndarray
    acceleration: np.ndarray
    steering: np.ndarray
    steering_rate: np.ndarray
    stopped_at: float | None = None


@dataclass(frozen=True)
class SpeedControl:
    """What a skier does about speed: `most` [m/s] is the speed to keep below, `skid` [rad] the largest steering angle,
    `deceleration` [m/s^2] of a stop, `stop_side` +1 to stop with the skis turned left, -1 right, and `stand` [s] how
    long to stand then.
    """

    most: float = math.inf
    skid: float = np.deg2rad(35.0)
    deceleration: float = 4.0
    stop_side: int = 1
    stand: float = 1.0


@dataclass(frozen=True)
class Body:
    """What a body leaning over the skis does to their speed, by `arc_length` (m,) [m]: `normal` force per mass and
    `swing` [m/s^2] as in `Pendulum`. One entry stands for the whole track.
    """

    normal: np.ndarray
    swing: np.ndarray = field(default_factory=lambda: np.zeros(1))
    arc_length: np.ndarray = field(default_factory=lambda: np.zeros(1))


def plan_ride(track: Track, snow: Snow, body: Body, control: SpeedControl, step: float = TIME_STEP) -> Ride:
    """Return how `track` is ridden from its start speed, by Heun's method in steps of `step` [s].

    The ride ends at the end of the track or, with a stop, when the skier has stood long enough; where friction stops
    the skier before, it ends there.
    """
    return _Rider(track, snow, body, control, step).ride()


class _Rider:
    """Integrates one ride; plain floats and lists, for this is a loop of thousands of small steps."""

    def __init__(self, track: Track, snow: Snow, body: Body, control: SpeedControl, time_step: float) -> None:
        self.time_step = time_step
        count = max(int(math.ceil(track.length / TABLE_STEP)), 2)
        self.length, self.step = track.length, track.length / count
        places = np.linspace(0.0, track.length, count + 1)
        columns = (track.tangent @ GRAVITY, track.left @ GRAVITY, track.curvature)
        table = [np.interp(places, track.arc_length, column) for column in columns]
        table += [np.interp(places, body.arc_length, column) for column in (body.normal, body.swing)]
        mean = [_blurred(column, FORESIGHT / self.step) for column in table[:3]]
        # the speed that the energy over the mean ground stands for: a crest slows, a hollow speeds up, neither matters
        self.taken = (2.0 * np.cumsum(mean[0] - table[0]) * self.step).tolist()
        self.table = np.stack(table, axis=1).tolist()
        self.mean = np.stack(mean, axis=1).tolist()
        self.last = count - 1
        self.snow, self.control, self.track = snow, control, track
        self.most = self._speeds_to_stop_from()

    def _speeds_to_stop_from(self) -> list[float]:
        """Return the speed to keep below at each place of the table [m/s].

        Nothing brakes on the straight way to a stop, so a skier who is to stop slows down in the turns before: as much
        as skids can, backwards from where the stop begins to brake.
        """
        most, track, step = self.control.most, self.track, self.step
        out = [most] * len(self.table)
        if math.isinf(most) or math.isinf(track.stop_from):
            return out
        braking = track.stop_from + BEFORE_BRAKING * most
        square = (ARRIVAL * most) ** 2
        for i in range(min(int(braking / step), self.last), -1, -1):
            along, left, bend = self.mean[i]
            speed = math.sqrt(square)
            gain = self.snow.glide_acceleration(along, STANDARD_GRAVITY, speed)
            side = abs(bend * most * most - left)  # from the speed to hold: one who is slow brakes less
            if step * i < track.stop_from and side > LEAST_SIDE_FORCE:
                gain -= side * math.tan(self.control.skid)
            square = max(square - 2.0 * gain * step, 1.0)
            out[i] = min(math.sqrt(square), most)
            if square >= most * most and step * i < track.stop_from:
                break
        return out

    def _where(self, arc: float) -> tuple[int, float]:
        """Return the row of the tables before `arc` [m], and the share of the way to the next."""
        where = arc / self.step
        index = int(where)
        return (index, where - index) if index <= self.last else (self.last, 1.0)

    def at(self, arc: float) -> tuple[float, float, float, float, float]:
        """Return gravity along and to the left, curvature, normal force and swing at `arc` [m]."""
        index, share = self._where(arc)
        a, b, c, d, e = self.table[index]
        p, q, r, s, t = self.table[index + 1]
        return a + share * (p - a), b + share * (q - b), c + share * (r - c), d + share * (s - d), e + share * (t - e)

    def foreseen(self, arc: float) -> tuple[float, float, float]:
        """Return gravity along and to the left and curvature at `arc` [m], smoothed."""
        index, share = self._where(arc)
        a, b, c = self.mean[index]
        p, q, r = self.mean[index + 1]
        return a + share * (p - a), b + share * (q - b), c + share * (r - c)

    def taken_by_bumps(self, arc: float) -> float:
        """Return twice the energy per mass that bumps have taken up to `arc` [m^2/s^2]."""
        index, share = self._where(arc)
        return self.taken[index] + share * (self.taken[index + 1] - self.taken[index])

    def ride(self) -> Ride:
        """Return the ride to the end of the track, or until the skier stands long enough or sticks."""
        dt = self.time_step
        rows: list[tuple[float, float, float, float]] = []
        arc, speed, stopped_at = 0.0, self.track.start_speed, None
        wanted, first, second, steering = 0.0, 0.0, 0.0, 0.0
        stood = 0.0
        while True:
            stopping = arc >= self.track.stop_from
            gain = self.acceleration(arc, speed, steering, stopping)
            rows.append((arc, speed, gain, steering))
            stood += dt if stopping and speed < STANDING else 0.0
            if arc >= self.length or stood > self.control.stand:
                break
            if not stopping and speed < SLOWEST and gain <= 0.0:
                stopped_at = arc
                break
            target = self.steering(arc, speed, stopping)
            most = (FASTEST_STOP if stopping else FASTEST_STEERING) * dt
            wanted += min(max(target - wanted, -most), most)
            first += dt / LAG * (wanted - first)
            second += dt / LAG * (first - second)
            steering += dt / LAG * (second - steering)
            guess = max(speed + dt * gain, 0.0)
            ahead = self.acceleration(arc + dt * speed, guess, steering, stopping)
            after = max(speed + 0.5 * dt * (gain + ahead), 0.0)
            arc += 0.5 * dt * (speed + after)
            speed = after
        return _ride(np.array(rows), dt, self.length, stopped_at)

    def acceleration(self, arc: float, speed: float, steering: float, stopping: bool) -> float:
        """Return v' [m/s^2]."""
        along, left, bend, normal, swing = self.at(arc)
        glide = self.snow.glide_acceleration(along, normal, speed)
        sideways = 1.0 - _smooth_step(arc - self.track.stop_from, 0.0, SKID_FADES) if stopping else 1.0
        if sideways > 0.0:
            skid = (left - bend * speed * speed) * math.tan(steering) - swing / math.cos(steering)
            glide += sideways * skid
        if not stopping:
            return glide
        share = _smooth_step(abs(steering), BRAKE_FROM, BRAKE_TO)
        return (1.0 - share) * glide - share * self.control.deceleration * min(speed / SOFT_SPEED, 1.0)

    def steering(self, arc: float, speed: float, stopping: bool) -> float:
        """Return the steering angle [rad] to aim at; it looks ahead by the time the skis take to follow."""
        if stopping:
            return self.control.stop_side * ACROSS
        if math.isinf(self.control.most):
            return 0.0
        ahead = arc + 3.0 * LAG * speed
        along, left, bend = self.foreseen(ahead)
        most = self.most[min(int(ahead / self.step), self.last)]
        speed = math.sqrt(max(speed * speed + self.taken_by_bumps(arc), 0.0))
        glide = self.snow.glide_acceleration(along, STANDARD_GRAVITY, speed)
        brake = glide + (speed - AIM * most) / CONTROL_TIME
        if brake <= 0.0:
            return 0.0
        side = bend * speed * speed - left
        angle = math.atan(brake * side / (side * side + LEAST_SIDE_FORCE**2))
        return min(max(angle, -self.control.skid), self.control.skid)


def _smooth_step(value: float, low: float, high: float) -> float:
    """Return 0 up to `low`, 1 from `high` on."""
    x = min(max((value - low) / (high - low), 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def _ride(rows: np.ndarray, step: float, length: float, stopped_at: float | None) -> Ride:
    """Return the ride of integrated rows, evenly in time up to the very end of the track."""
    time = step * np.arange(len(rows))
    arc, speed, gain, steering = np.ascontiguousarray(rows.T)
    if arc[-1] > length:  # the last step goes a little too far: end where the track does
        before = (speed[-2], length - arc[-2])
        last = 2.0 * before[1] / (before[0] + math.sqrt(max(before[0] ** 2 + 2.0 * gain[-2] * before[1], 0.0)))
        even = np.linspace(0.0, time[-2] + last, len(time))
        arc, speed = _hermite(time, arc, speed, even), _hermite(time, speed, gain, even)
        gain, steering, time = np.interp(even, time, gain), np.interp(even, time, steering), even
    rate = np.gradient(steering, time) if len(time) > 1 else np.zeros_like(time)
    return Ride(time, arc, speed, gain, steering, rate, stopped_at)


def _hermite(time: np.ndarray, values: np.ndarray, slope: np.ndarray, at: np.ndarray) -> np.ndarray:
    from scipy.interpolate import CubicHermiteSpline

    return np.asarray(CubicHermiteSpline(time, values, slope)(at))


def _blurred(values: np.ndarray, width: float) -> np.ndarray:
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(values, width, mode="nearest"))
