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

FIRM_TURN, LEANING = 0.85, 0.75
"""Sideways acceleration of the turn into the fall line, in units of gravity: firm, so that skids can brake
there, and at most this share of what `technique.inclination_max_deg` allows."""
TIGHTEST = 1.0 / 6.0
"""Most curvature of that turn [1/m]."""
QUICKEST = 0.04
"""Most change of that turn's curvature [1/m^2]."""
FADING_TIME, NOTABLE_BEND = 0.4, 0.01
"""Time [s] in which a bend that a track ends with fades out; a bend below the second [1/m] takes less of it."""
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
    fast = coasting_speed(track, spec, UNHELD)  # over bumps and on straights nobody holds the speed for sure
    braking = 0.5 * (fast + 1.0) ** 2 / (0.9 * spec.technique.stop_deceleration)
    distance = TIME_TO_TURN * (fast + 1.0) + braking + MARGIN
    firm = min(FIRM_TURN, LEANING * math.tan(math.radians(spec.technique.inclination_max_deg)))
    angle = _turn_down(down, left, float(track.curvature[-1]), speed, firm)
    angle = np.concatenate((angle, np.zeros(int(distance / SPACING))))
    down = np.concatenate((down, down[-1] + np.cumsum(SPACING * np.cos(angle))))
    left = np.concatenate((left, left[-1] + np.cumsum(SPACING * np.sin(angle))))
    _check_ground(terrain, down, left, len(angle))
    added = np.full(len(angle), TRANSITION, dtype=np.int8)
    phase, number = (
        np.concatenate((track.phase, added)),
        np.concatenate((track.turn, np.full(len(angle), track.turn[-1]))),
    )
    whole = track_on_surface(terrain, down, left, phase, number, track.start_speed)
    return Track(**{**vars(whole), "stop_from": whole.length - distance})


def _turn_down(down: np.ndarray, left: np.ndarray, curvature: float, speed: float, firm: float) -> np.ndarray:
    """Return headings (n,) [rad] from the end of a line `down`, `left` (m,) [m] into the fall line, one for each
    `SPACING`: its `curvature` [1/m] fades out, then that of a turn at `speed` [m/s] rises to `firm` gravities and falls
    again as one wave.
    """
    last = math.hypot(down[-1] - down[-2], left[-1] - left[-2])
    heading = math.atan2(left[-1] - left[-2], down[-1] - down[-2]) + 0.5 * last * curvature
    fade = max(FADING_TIME * speed * min(abs(curvature) / NOTABLE_BEND, 1.0), SPACING)
    to_turn = heading + 0.5 * curvature * fade
    bend = min(firm * STANDARD_GRAVITY / max(speed, 1.0) ** 2, TIGHTEST)
    bend = min(bend, math.sqrt(2.0 * QUICKEST * abs(to_turn) / math.pi) + 1e-9)  # the steepest place of the wave
    turn = max(2.0 * abs(to_turn) / bend, 1.0)
    along = (np.arange(math.ceil((fade + turn) / SPACING)) + 0.5) * SPACING
    x, share = np.clip(along / fade, 0.0, 1.0), np.clip((along - fade) / turn, 0.0, 1.0)
    faded = heading + curvature * fade * (0.5 * x + np.sin(np.pi * x) / (2.0 * np.pi))
    return faded - to_turn * (share - np.sin(2.0 * np.pi * share) / (2.0 * np.pi))


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
