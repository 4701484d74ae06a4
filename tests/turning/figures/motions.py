"""Motions for the figures' tests: open-loop turns of the 1993 paper [VP93 Fig. 4], integrated here."""

from __future__ import annotations

import numpy as np

from ski_addon.gravity import STANDARD_GRAVITY
from ski_addon.turning.body import TurningBody, support_speed
from ski_addon.turning.motion import TurningMotion


def turns(
    period=2.5, lean_max_deg=23.0, speed=8.0, seconds=10.0, step=0.01, *, angle=0.0, terrain=None, start=0.0, side=1.0
):
    """Return turns with lean = max sin(w t + start) at constant speed, drawn on a plane that falls by `angle` [rad] and
    dropped on `terrain` if there is one. `side` -1 mirrors them."""
    time = np.arange(0.0, seconds + step / 2, step)
    rate, most = 2 * np.pi / period, np.deg2rad(lean_max_deg) * side
    lean, lean_rate = most * np.sin(rate * time + start), most * rate * np.cos(rate * time + start)
    body = TurningBody()
    curvature = body.curvature_for(lean, -(rate**2) * lean, speed)
    way = support_speed(lean, curvature, speed, body.leg_length)
    distance = _integral(way, time)
    heading = _integral(way * curvature, time)
    heading = heading - heading.mean()
    x, y = _integral(way * np.cos(heading), time), _integral(way * np.sin(heading), time)
    left, up = body.leg_force(lean, lean_rate, curvature, speed)
    force = np.hypot(left, up) / STANDARD_GRAVITY
    phase = np.mod(rate * time + start + (0.0 if side > 0 else np.pi), 2 * np.pi)
    position = np.stack((x * np.cos(angle), y, -x * np.sin(angle)), axis=1)
    normal = np.broadcast_to([np.sin(angle), 0.0, np.cos(angle)], position.shape).copy()
    forward = np.stack((np.cos(heading) * np.cos(angle), np.sin(heading), -np.cos(heading) * np.sin(angle)), axis=1)
    if terrain is not None:
        position[:, 2] = terrain.height(position[:, 0], position[:, 1])
        normal = terrain.normal(position[:, 0], position[:, 1])
        forward = np.gradient(position, time, axis=0)
        forward /= np.linalg.norm(forward, axis=1, keepdims=True)
        distance = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(position, axis=0), axis=1))))
    speeds = np.full(len(time), speed)
    return TurningMotion(time, position, forward, normal, distance, speeds, lean, lean_rate, curvature, force, phase)


def _integral(values, time):
    """Trapezium sums, from 0."""
    return np.concatenate(([0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(time))))
