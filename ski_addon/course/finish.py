"""The end of a run that stops: out of the last turn, down the fall line, and room to brake."""

from __future__ import annotations

import math

import numpy as np

from ..errors import SpecError
from ..gravity import GRAVITY, STANDARD_GRAVITY
from ..snow import Snow
from ..spec import RunSpec
from ..terrain import Terrain
from .pace import speed_to_hold
from .surface import SPACING, track_on_surface
from .track import TRANSITION, Track

EASY_TURN = 0.45
"""Sideways acceleration of the turn into the fall line, in units of gravity."""
TIGHTEST = 1.0 / 6.0
"""Most curvature of that turn [1/m]."""
TIME_TO_TURN = 1.2
"""Time [s] to throw the skis across before they brake."""
UNHELD = 1.8
"""How much faster than the speed to hold a skier may be where there is nothing to brake against."""
MARGIN = 6.0
"""Length of track [m] that is left over when the skier stands."""


def with_run_out(track: Track, spec: RunSpec, terrain: Terrain) -> Track:
    """Return `track` continued into the fall line, straight from its `stop_from` on, with room to stop.

    Raises `SpecError` if the ground ends before.
    """
    speed = coasting_speed(track, spec)
    down, left = track.position[:, 0] / math.cos(terrain.mean_angle), track.position[:, 1]
    heading = math.atan2(left[-1] - left[-2], down[-1] - down[-2])
    bend = min(EASY_TURN * STANDARD_GRAVITY / max(speed, 1.0) ** 2, TIGHTEST)
    turn = max(2.0 * abs(heading) / bend, 1.0)
    fast = coasting_speed(track, spec, UNHELD)  # over bumps and on straights nobody holds the speed for sure
    braking = 0.5 * (fast + 1.0) ** 2 / (0.9 * spec.technique.stop_deceleration)
    distance = TIME_TO_TURN * (fast + 1.0) + braking + MARGIN
    along = np.arange(1, int((turn + distance) / SPACING)) * SPACING
    share = np.clip(along / turn, 0.0, 1.0)
    # the curvature rises and falls as one wave of a cosine
    angle = heading * (1.0 - share + np.sin(2.0 * np.pi * share) / (2.0 * np.pi))
    step = np.concatenate((np.full(1, along[0]), np.diff(along)))
    down = np.concatenate((down, down[-1] + np.cumsum(step * np.cos(angle))))
    left = np.concatenate((left, left[-1] + np.cumsum(step * np.sin(angle))))
    _check_ground(terrain, down, left, len(along))
    added = np.full(len(along), TRANSITION, dtype=np.int8)
    phase, number = (
        np.concatenate((track.phase, added)),
        np.concatenate((track.turn, np.full(len(along), track.turn[-1]))),
    )
    whole = track_on_surface(terrain, down, left, phase, number, track.start_speed)
    straight = whole.length - distance
    return Track(**{**vars(whole), "stop_from": straight})


def coasting_speed(track: Track, spec: RunSpec, held: float = 1.1) -> float:
    """Return about how fast [m/s] a skier reaches the end of `track` who brakes to `held` times the speed asked for."""
    snow = Snow.of(spec.snow, spec.skier, spec.technique.tuck)
    along, into = track.tangent @ GRAVITY, -(track.surface_normal @ GRAVITY)
    most = held * speed_to_hold(spec)
    energy = 0.5 * track.start_speed**2
    for i, step in enumerate(np.diff(track.arc_length).tolist()):
        speed = math.sqrt(2.0 * energy)
        energy = max(energy + step * snow.glide_acceleration(float(along[i]), float(into[i]), speed), 0.0)
        energy = min(energy, 0.5 * most**2)
    return math.sqrt(2.0 * energy)


def _check_ground(terrain: Terrain, down: np.ndarray, left: np.ndarray, added: int) -> None:
    inside = terrain.contains(down * math.cos(terrain.mean_angle), left)
    if not np.all(inside[-added:]):
        missing = SPACING * (added - int(np.argmin(inside[-added:])))
        hint = f"the ground ends {missing:.0f} m too early for a stop: shorten the course, or let it glide"
        raise SpecError("course.finish", "stop", problem="does not fit on the slope", hint=hint)
