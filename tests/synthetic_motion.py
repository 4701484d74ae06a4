"""A recording made from formulas, for tests of what moves a skier: smooth turns down a plane, every hinge in motion."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

PERIOD = 3.0
SPEED = 6.0


def _about(axis: int, angle: np.ndarray) -> np.ndarray:
    out = np.zeros((len(angle), 4))
    out[:, 0], out[:, 1 + axis] = np.cos(0.5 * angle), np.sin(0.5 * angle)
    return out


def _times(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    scalar = a[:, 0] * b[:, 0] - np.sum(a[:, 1:] * b[:, 1:], axis=1)
    vector = a[:, :1] * b[:, 1:] + b[:, :1] * a[:, 1:] + np.cross(a[:, 1:], b[:, 1:])
    return np.column_stack((scalar, vector))


def synthetic_motion(
    skeleton: Any, spec: Any, *, duration: float = 2.0, step: float = 0.001, start: float = 0.0
) -> SimpleNamespace:
    """Turns of 3 s period at 6 m/s, left first; the clock starts at `start` [s].

    `skeleton` and `spec` may come from any import of the library; the result has the fields that animation reads.
    """
    clock = np.arange(round(duration / step) + 1) * step
    swing = np.sin(2 * np.pi * clock / PERIOD)
    tilt = np.radians(spec.slope.angle_deg)
    x, y = SPEED * clock, 0.9 * (1 - np.cos(2 * np.pi * clock / PERIOD))
    ground = np.stack((x, y, -x * np.tan(tilt)), axis=1)
    lean = np.radians(25.0) * swing
    normal = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
    left = np.cross(normal, [1.0, 0.0, 0.0])
    force = 0.5 * 9.81 * spec.skier.mass * (normal + np.tan(lean)[:, None] * left)
    share = np.stack((1.0 - 0.4 * swing, 1.0 + 0.4 * swing), axis=1)
    qpos = np.zeros((len(clock), skeleton.nq))
    qpos[:, :3] = ground + np.array([0.0, 0.0, 0.52 * skeleton.height])
    qpos[:, 3:7] = _times(_times(_about(2, 0.3 * swing), _about(1, np.full_like(clock, tilt + 0.2))), _about(0, -lean))
    qpos[:, skeleton.joint_qpos] = _hinge_angles(skeleton.joint_names, clock)
    return SimpleNamespace(
        header={"spec": spec.to_toml(), "spec_hash": spec.content_hash(), "status": "finished", "status_detail": {}},
        time=start + clock,
        arc_length=SPEED * clock,
        progress=clock,
        speed=SPEED + swing**2,
        qpos=qpos,
        inclination=lean,
        edge_angle=np.stack((1.1 * lean, 1.2 * lean), axis=1),
        snow_force=share[:, :, None] * force[:, None, :],
        turn_phase=swing,
        track_position=ground,
        surface_normal=np.tile(normal, (len(clock), 1)),
    )


def _hinge_angles(names: tuple[str, ...], clock: np.ndarray) -> np.ndarray:
    """A crouch with every hinge swinging at a rate of its own."""
    crouch = {"thigh_y": -1.0, "shank_y": 1.1, "foot_y": -0.3, "forearm_y": -0.9, "upper_arm_y": -0.6}
    angles = [
        crouch.get(name.partition(".")[0], 0.0) + 0.2 * np.sin(rate * clock + 0.3 * i)
        for i, (rate, name) in enumerate(zip(np.linspace(1.5, 4.0, len(names)), names, strict=True))
    ]
    return np.stack(angles, axis=1)
