"""The cyclist: both wheels on their own tracks, steering from the curvature, hands and feet by inverse kinematics.

The rear wheel runs along the path of the support, a little behind it, and the frame points along its track. The front
wheel is one wheelbase ahead; where it goes says how the fork is turned. So neither wheel slips sideways, whatever the
ground [VP93 sec. 7]. Lean, steering and head angle together pitch the frame a little: it is pitched until the front
wheel is on the ground, too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .bicycle_sizes import HEAD_ANGLE, fork_place, fork_turn
from .sampling import STEP, Moments, Run, uneven
from .standing import lean_line
from .vectors import Array, columns, cross, dot, turn_yxz, unit

AROUND, SLOW = 0.05, 0.5
"""Way [m] before and after a moment between which the front wheel's way is measured, and the speed [m/s] it is for at
least. A wheel trails behind its steering axis, which evens out what is shorter.
"""


@dataclass(frozen=True)
class Bicycle:
    """A bicycle on the ground; places (m, 3) [m, world], rotations (m, 3, 3).

    `rear`, `front` axles; `frame`, `fork` rotations; `rear_wheel`, `front_wheel` rotations without their rolling;
    `steering` (m,) [rad] of the fork; `rear_way`, `front_way` (m,) [m] that the wheels have rolled.
    """

    rear: Array
    front: Array
    frame: Array
    fork: Array
    rear_wheel: Array
    front_wheel: Array
    steering: Array
    rear_way: Array
    front_way: Array


def ride(sizes: dict[str, float], run: Run, time: Array) -> Bicycle:
    """Return the bicycle of `sizes` at `time` (m,) [s].

    Where the front wheel touches the ground shifts with lean and steering, so its way is measured first, a moment
    before and after; then the fork is turned into it. On uneven ground this is done twice.
    """
    count = len(time)
    moment = AROUND / np.maximum(np.interp(time, run.motion.time, run.motion.speed), SLOW)
    around = _Stand(sizes, run, run.at(np.concatenate((time - moment, time, time + moment))))
    now = around.only(slice(count, 2 * count))
    near = around.settled(around.front_ahead, 2)
    ahead = _way(near.contact, now.front_ahead)
    if uneven(run):
        more = ahead - now.front_ahead
        change = moment[:, None] * np.gradient(more, time, axis=0) if count > 1 else np.zeros_like(more)
        better = around.front_ahead + np.concatenate((more - change, more, more + change))
        ahead = _way(around.settled(unit(better), 4).contact, now.front_ahead)
    settled = now.settled(ahead, 4 if uneven(run) else 2)
    rear_way = now.rear_way
    front_way = _front_way(run, rear_way, sizes["wheelbase"])
    axle = settled.fork[..., 1]
    front_wheel = columns(cross(axle, settled.front_up), axle, settled.front_up)
    rear_wheel = columns(now.level[..., 0], now.level[..., 1], now.rear_up)
    return Bicycle(
        now.rear,
        settled.front,
        settled.frame,
        settled.fork,
        rear_wheel,
        front_wheel,
        settled.steering,
        rear_way,
        front_way,
    )


@dataclass(frozen=True)
class _Settled:
    """Frame and fork (m, 3, 3) with both wheels on the ground, steering (m,), and the front wheel's middle, direction
    from contact to middle, and contact (m, 3).
    """

    frame: Array
    fork: Array
    steering: Array
    front: Array
    front_up: Array
    contact: Array


class _Stand:
    """The rear wheel on its track, and where the front one will be."""

    def __init__(self, sizes: dict[str, float], run: Run, moments: Moments) -> None:
        self.sizes, self.run = sizes, run
        self.rear_way = moments.distance - sizes["bottom_bracket_forward"]
        track, front_track = _tracks(run, self.rear_way, sizes["wheelbase"])
        ahead = unit(track[:, 3] - track[:, 1])
        self.front_ahead = unit(front_track[:, 2] - front_track[:, 0])
        self.rear_contact, self.front_near = track[:, 2], front_track[:, 1]
        up = lean_line(moments)
        up = unit(up - dot(up, ahead)[:, None] * ahead)
        side = cross(up, ahead)
        self.level = columns(ahead, side, up)
        self.rear_up = _from_contact(run.normal(self.rear_contact, self.rear_way), side)
        self.rear = self.rear_contact + sizes["wheel_radius"] * self.rear_up

    def only(self, index: slice) -> _Stand:
        """Return the stand at some of its moments."""
        part = object.__new__(_Stand)
        for name, value in vars(self).items():
            setattr(part, name, value[index] if isinstance(value, np.ndarray) else value)
        return part

    def settled(self, front_ahead: Array, rounds: int) -> _Settled:
        """Return frame and fork with the front wheel pointing along `front_ahead` (m, 3) and on the ground."""
        sizes, run, way = self.sizes, self.run, self.rear_way + self.sizes["wheelbase"]
        up, near = self.level[..., 2], self.front_near
        pitch = _pitch_of_slope(near - self.rear_contact, self.level)
        for _ in range(rounds):
            frame = self.level @ turn_yxz(pitch)
            steering = _steering(frame, front_ahead)
            fork = frame @ fork_turn(sizes) @ turn_yxz(0.0, 0.0, steering)
            front = self.rear + frame @ fork_place(sizes) + sizes["fork_offset"] * fork[..., 0]
            front_up = _from_contact(run.normal(near, way), fork[..., 1])
            contact = front - sizes["wheel_radius"] * front_up
            near = run.on_ground(contact) if run.terrain is not None else near
            high = dot(contact - near, run.normal(near, way))
            pitch = pitch + high / (sizes["wheelbase"] * np.maximum(dot(up, front_up), 0.2))
        return _Settled(frame, fork, steering, front, front_up, contact)


def _way(contact: Array, otherwise: Array) -> Array:
    """Return the directions (m, 3) in which contacts (3 m, 3) move; `otherwise` where they rest."""
    count = len(otherwise)
    way = contact[2 * count :] - contact[:count]
    moved = dot(way, way) > 1e-12
    return unit(np.where(moved[:, None], way, otherwise))


def _tracks(run: Run, way: Array, wheelbase: float) -> tuple[Array, Array]:
    """Return the track of the rear wheel (m, 5, 3), `STEP` apart, and that of the front wheel (m, 3, 3)."""
    track = run.ground(way[:, None] + STEP * np.arange(-2.0, 3.0))
    ahead = unit(track[:, 2:] - track[:, :-2])
    return track, run.on_ground(track[:, 1:-1] + wheelbase * ahead)


def _from_contact(normal: Array, axle: Array) -> Array:
    """Return the direction (m, 3) from where a wheel touches ground with `normal` to its middle, at right angles to its
    `axle`.
    """
    return unit(normal - dot(normal, axle)[:, None] * axle)


def _steering(frame: Array, ahead: Array) -> Array:
    """Return the angle (m,) [rad] of the fork in `frame` (m, 3, 3) at which the front wheel points `ahead` (m, 3)."""
    straight = frame @ turn_yxz(HEAD_ANGLE - 0.5 * np.pi)
    return np.arctan2(dot(straight[..., 1], ahead), dot(straight[..., 0], ahead))


def _pitch_of_slope(way: Array, level: Array) -> Array:
    """Return the frame's pitch (m,) [rad], nose down, from the rear to the front contact `way` (m, 3)."""
    return np.arctan2(-dot(way, level[..., 2]), dot(way, level[..., 0]))


def _front_way(run: Run, rear_way: Array, wheelbase: float) -> Array:
    """Return how far (m,) [m] the front wheel has come: it goes a longer way than the rear one in every curve."""
    motion = run.motion
    start = float(motion.distance[0]) - wheelbase
    knots = np.linspace(start, max(float(motion.distance[-1]), start + 1e-3), max(2 * len(motion.distance), 64))
    track = run.ground(knots)
    ahead = unit(np.gradient(track, axis=0))
    front = run.on_ground(track + wheelbase * ahead)
    step = np.diff(front, axis=0)
    way = np.concatenate(([0.0], np.cumsum(np.sqrt(dot(step, step)))))
    return np.interp(rear_way, knots, way)
