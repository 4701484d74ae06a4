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
from .ride_steps import LEAST_SIDE_FORCE, Ground, Rows, Steps, glide, hold, rows, stop

TIME_STEP = 0.005
"""Planned time between neighbouring places [s]."""
TABLE_STEP = 0.05
"""Distance between entries of the tables the speed is integrated with [m]."""
FORESIGHT = 1.5
"""Standard deviation [m] of the window in which a skier who brakes sees the track: he does not answer single bumps."""
BEFORE_BRAKING = 0.9
"""Time [s] from where the skis begin to turn across the track until they brake."""
ARRIVAL = 1.05
"""Most speed to begin a stop's braking with, in units of the speed to keep below."""


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
    return Rider(track, snow, control).ride(body, step)


class Rider:
    """Integrates rides of one track by bodies that lean differently.

    What the track gives is worked out once, in tables of even steps along it, at `places` (m,) [m].
    """

    def __init__(self, track: Track, snow: Snow, control: SpeedControl) -> None:
        """Take what all rides have in common."""
        count = max(int(math.ceil(track.length / TABLE_STEP)), 2)
        self.length, self._step, self._last = track.length, track.length / count, count - 1
        self.places = np.linspace(0.0, track.length, count + 1)
        self.snow, self.control, self.track = snow, control, track
        columns = (track.tangent @ GRAVITY, track.left @ GRAVITY, track.curvature)
        self._columns = [np.interp(self.places, track.arc_length, column) for column in columns]
        self._foreseen: Rows | None = None
        if not math.isinf(control.most):
            mean = [_blurred(column, FORESIGHT / self._step) for column in self._columns]
            # the speed that the energy over the mean ground stands for: crests slow, hollows speed up, neither matters
            self._taken = 2.0 * np.cumsum(mean[0] - self._columns[0]) * self._step
            self._most = self._speeds_to_stop_from(np.stack(mean, axis=1))
            self._foreseen = rows(*mean)

    def _speeds_to_stop_from(self, mean: np.ndarray) -> list[float]:
        """Return the speed to keep below at each place of the table [m/s].

        Nothing brakes on the straight way to a stop, so a skier who is to stop slows down in the turns before: as much
        as skids can, backwards from where the stop begins to brake.
        """
        most, track, step = self.control.most, self.track, self._step
        out = [most] * len(mean)
        if math.isinf(most) or math.isinf(track.stop_from):
            return out
        braking = track.stop_from + BEFORE_BRAKING * most
        square = (ARRIVAL * most) ** 2
        foreseen = mean.tolist()
        for i in range(min(int(braking / step), self._last), -1, -1):
            along, left, bend = foreseen[i]
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

    def ride(self, body: Body, time_step: float = TIME_STEP) -> Ride:
        """Return the ride of `body` to the end of the track, or until the skier stands long enough or sticks."""
        normal, swing = (np.interp(self.places, body.arc_length, column) for column in (body.normal, body.swing))
        ground = Ground(self._step, self.track.stop_from, self.length, self.snow)
        steps, control = Steps(self.track.start_speed, time_step), self.control
        table: Rows | None = None
        if self._foreseen is None:
            goes_on = glide(steps, ground, rows(self._columns[0], normal, swing))
        else:
            table = rows(*self._columns, normal, swing, self._taken)
            goes_on = hold(steps, ground, table, self._foreseen, self._most, control.skid)
        if goes_on:
            table = table or rows(*self._columns, normal, swing, np.zeros_like(swing))
            stop(steps, ground, table, control.stop_side, control.deceleration, control.stand)
        return _ride(steps, self.length)


def _ride(steps: Steps, length: float) -> Ride:
    """Return the ride of integrated steps, evenly in time up to the very end of the track."""
    arc, speed, gain, steering = steps.columns()
    time = steps.size * np.arange(len(arc))
    if arc[-1] > length:  # the last step goes a little too far: end where the track does
        before = (speed[-2], length - arc[-2])
        last = 2.0 * before[1] / (before[0] + math.sqrt(max(before[0] ** 2 + 2.0 * gain[-2] * before[1], 0.0)))
        even = np.linspace(0.0, time[-2] + last, len(time))
        arc, speed = _hermite(time, arc, speed, even), _hermite(time, speed, gain, even)
        gain, steering, time = np.interp(even, time, gain), np.interp(even, time, steering), even
    rate = np.gradient(steering, time) if len(time) > 1 else np.zeros_like(time)
    return Ride(time, arc, speed, gain, steering, rate, steps.stopped_at)


def _hermite(time: np.ndarray, values: np.ndarray, slope: np.ndarray, at: np.ndarray) -> np.ndarray:
    from scipy.interpolate import CubicHermiteSpline

    return np.asarray(CubicHermiteSpline(time, values, slope)(at))


def _blurred(values: np.ndarray, width: float) -> np.ndarray:
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(values, width, mode="nearest"))
