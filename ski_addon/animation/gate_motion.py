"""How gates give way: the skier's body knocks poles over as it leans past them, and they spring up again.

A pole swings about its foot in one vertical plane, ahead and away from the track. What pushes it are balls along the
skier's limbs; the physics of the run knows nothing of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..body.kinematics import forward_kinematics
from ..frames import Array, matrix_from_quaternion
from .poses import BodyPoses

if TYPE_CHECKING:
    from ..body.skeleton import Skeleton
    from ..course import Gates
    from ..simulation.recording import Recording

POLE_LENGTH = 1.80
"""Length of a gate's pole over the snow [m]."""
FLATTEST = math.radians(82.0)
"""Furthest that a pole is pushed over [rad]."""
AWAY = 0.5
"""How much of a push goes away from the track, for one part ahead."""
STEP = 0.005
"""Time between two places of a pole that are reckoned with [s]."""
SPRING, DAMPING = 2.0 * math.pi * 1.8, 0.38
"""Natural frequency [rad/s] and damping ratio of a pole that springs up."""
_NEAR, _AFTER = 3.0, 1.2  # [m], [s]
_BALLS = 6
_LIMBS = (
    *(("pelvis", "chest", 0.15), ("chest", "head", 0.14)),
    *(
        (f"{a}.{side}", f"{b}.{side}", radius)
        for side in "LR"
        for a, b, radius in (
            *(("thigh", "shank", 0.09), ("shank", "foot", 0.07)),
            *(("upper_arm", "forearm", 0.06), ("forearm", "hand", 0.05)),
        )
    ),
)
"""Bodies whose frames begin and end a limb, and the limb's radius [m]."""
_ENDS = (
    ("head", 0.13, 0.13),
    *((f"{part}.{side}", -0.04, radius) for side in "LR" for part, radius in (("hand", 0.06), ("foot", 0.08))),
)
"""Bodies at the limbs' ends: how far over its frame a ball lies, and its radius [m]."""


@dataclass(frozen=True)
class GateSwing:
    """How one gate swings: `angle` (m,) [rad] from plumb at `time` (m,) [s after the start], at rest before and after.

    `pushed` (m,) [rad] is the angle that the skier forces upon it, 0 while nobody touches it; `towards` (2,) the
    horizontal unit vector that it is pushed to.
    """

    time: Array
    angle: Array
    pushed: Array
    towards: Array

    def at(self, time: Array) -> Array:
        """Return the angle (k,) [rad] at `time` (k,) [s]."""
        return np.interp(time, self.time, self.angle)

    def quaternion(self, angle: Array) -> Array:
        """Return the rotations (k, 4) (w, x, y, z) from plumb that tilt the gate by `angle` (k,) [rad]."""
        half = 0.5 * np.asarray(angle, dtype=float)
        x, y = self.towards
        return np.stack((np.cos(half), -y * np.sin(half), x * np.sin(half), 0.0 * half), axis=-1)


def gate_swings(recording: Recording, skeleton: Skeleton, gates: Gates) -> list[GateSwing | None]:
    """Return how each of `gates` swings in `recording`, or None for one that nobody touches."""
    clock = np.asarray(recording.time, dtype=float) - recording.time[0]
    time = np.arange(0.0, clock[-1], STEP)
    index = np.searchsorted(clock, time).clip(0, len(clock) - 1)
    qpos = np.asarray(recording.qpos)

    def balls(passing: slice) -> tuple[Array, Array]:
        return _balls(skeleton.body_names, *forward_kinematics(skeleton, qpos[index[passing]]))

    return _swings(time, qpos[index, :2], balls, gates)


def pose_swings(poses: BodyPoses, gates: Gates) -> list[GateSwing | None]:
    """Return how each of `gates` swings when a figure passes in `poses`, one every `STEP` from the start."""

    def balls(passing: slice) -> tuple[Array, Array]:
        turn = matrix_from_quaternion(poses.quaternion[passing])
        return _balls(poses.body_names, poses.position[passing], turn)

    return _swings(poses.time, poses.position[:, poses.body_names.index("pelvis"), :2], balls, gates)


def _swings(
    time: Array, pelvis: Array, balls: Callable[[slice], tuple[Array, Array]], gates: Gates
) -> list[GateSwing | None]:
    """Return how each of `gates` swings, with the `pelvis` (m, 2) [m] and the body's `balls` at `time` (m,) [s]."""
    swings: list[GateSwing | None] = []
    for foot, side in zip(gates.position, gates.side.tolist(), strict=True):
        near = np.flatnonzero(np.linalg.norm(pelvis - foot[:2], axis=1) < _NEAR)
        passing = slice(near[0], near[-1] + 1) if len(near) > 1 else slice(0, 0)
        towards = _towards(pelvis[passing], side)
        pushed = _pushed(*balls(passing), foot, towards)
        swings.append(_swing(time[passing.start], pushed, towards) if np.any(pushed > 0.0) else None)
    return swings


def _towards(way: Array, side: int) -> Array:
    """Return the horizontal unit vector (2,) to which a pole on that `side` of the way (m, 2) is pushed."""
    ahead = way[-1] - way[0] if len(way) else np.array((1.0, 0.0))
    towards = ahead + AWAY * side * np.array((-ahead[1], ahead[0]))
    return np.asarray(towards / np.linalg.norm(towards))


def _balls(names: tuple[str, ...], position: Array, rotation: Array) -> tuple[Array, Array]:
    """Return places (m, k, 3) [m] and radii (k,) [m] of balls along the limbs of a person whose bodies are so."""
    places, radii = [], []
    for first, last, radius in _LIMBS:
        a, b = position[:, names.index(first)], position[:, names.index(last)]
        shares = np.linspace(0.0, 1.0, _BALLS)
        places += [a + share * (b - a) for share in shares]
        radii += [radius] * len(shares)
    for name, up, radius in _ENDS:
        body = names.index(name)
        places.append(position[:, body] + up * rotation[:, body, :, 2])
        radii.append(radius)
    return np.stack(places, axis=1), np.array(radii)


def _pushed(places: Array, radii: Array, foot: Array, towards: Array) -> Array:
    """Return the angle (m,) [rad] by which a pole at `foot` must be tilted to lie just ahead of all balls."""
    offset = places - foot
    ahead, up = offset[..., :2] @ towards, offset[..., 2]
    beside = offset[..., 0] * towards[1] - offset[..., 1] * towards[0]
    radius = np.sqrt(np.maximum(radii**2 - beside**2, 0.0))
    distance = np.hypot(ahead, up)
    reached = (radius > 0.0) & (distance - radius < POLE_LENGTH) & (up > 0.0)
    angle = np.arctan2(ahead, up) + np.arcsin(np.clip(radius / np.maximum(distance, 1e-6), 0.0, 1.0))
    return np.clip(np.where(reached, angle, 0.0).max(axis=1), 0.0, FLATTEST)


def _swing(begin: float, pushed: Array, towards: Array) -> GateSwing:
    """Return the motion of a pole that is `pushed` (m,) [rad] at least, from `begin` [s] on, until it is at rest."""
    free = np.full(int(_AFTER / STEP), -FLATTEST)
    least = np.concatenate((np.where(pushed > 0.0, pushed, -FLATTEST), free)).tolist()
    angles, angle, speed = [0.0], 0.0, 0.0
    for bound in least:
        speed -= STEP * (SPRING**2 * angle + 2.0 * DAMPING * SPRING * speed)
        moved = min(max(angle + STEP * speed, bound), FLATTEST)
        speed, angle = (moved - angle) / STEP, moved
        angles.append(angle)
    angles[-1] = 0.0
    time = begin + STEP * (np.arange(len(angles)) - 1.0)
    return GateSwing(time, np.array(angles), np.concatenate((np.zeros(1), pushed, 0.0 * free)), towards)
