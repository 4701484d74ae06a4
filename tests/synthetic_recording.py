"""A recording made from formulas, for tests of what only reads recordings."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ski_addon.spec import RunSpec

HINGES = tuple(
    f"{body}_{axis}{side}"
    for side, bodies in (
        ("", {"abdomen": "yxz", "chest": "yxz", "head": "yxz"}),
        (".L", {"upper_arm": "yxz", "forearm": "y", "hand": "y", "thigh": "yxz", "shank": "y", "foot": "yx"}),
        (".R", {"upper_arm": "yxz", "forearm": "y", "hand": "y", "thigh": "yxz", "shank": "y", "foot": "yx"}),
    )
    for body, axes in bodies.items()
    for axis in axes
)


@dataclass(frozen=True)
class SyntheticRecording:
    """The fields of a recording that reports and commands read."""

    header: dict[str, Any]
    time: np.ndarray
    arc_length: np.ndarray
    progress: np.ndarray
    speed: np.ndarray
    track_position: np.ndarray
    track_tangent: np.ndarray
    surface_normal: np.ndarray
    phase: np.ndarray
    inclination: np.ndarray
    edge_angle: np.ndarray
    edge_angle_reference: np.ndarray
    snow_force: np.ndarray
    torque_ratio: np.ndarray
    ski_error: np.ndarray
    com_error: np.ndarray
    push_force: np.ndarray
    track_offset: np.ndarray
    steering_offset: np.ndarray
    capture_margin: np.ndarray
    zmp_margin: np.ndarray
    com: np.ndarray
    com_reference: np.ndarray
    steering: np.ndarray
    qpos: np.ndarray

    def save(self, path: Path) -> None:
        """Write the arrays as a stand-in for a recording."""
        np.savez(path, time=self.time)


def synthetic_recording(
    spec: RunSpec | None = None,
    *,
    duration: float = 12.0,
    status: str = "finished",
    detail: dict[str, Any] | None = None,
    gates: int = 0,
) -> SyntheticRecording:
    """Sinusoidal turns of 5 s period on a slope of 10 degrees, at 8 m/s, left turn first; 100 samples a second.

    The skier stands upright in the straight pose, 1 m over the track and facing along it. With `gates`, one stands in
    the middle of each turn, half a metre and then 10 cm more each on its inner side; the recording may end before them.
    """
    spec = spec or RunSpec()
    time = np.arange(0.0, duration, 0.01)
    swing = np.sin(2 * np.pi * time / 5.0)
    tilt = np.radians(10.0)
    normal = np.tile([np.sin(tilt), 0.0, np.cos(tilt)], (len(time), 1))
    x, y = 8.0 * time, -10.0 / np.pi * swing
    steps = np.stack(
        (np.full_like(time, 8.0), -4.0 * np.cos(2 * np.pi * time / 5.0), -8.0 * np.tan(tilt) + 0 * time), axis=1
    )
    ground = np.stack((x, y, -x * np.tan(tilt)), axis=1)
    inclination = np.radians(30.0) * swing
    weight = 9.81 * spec.skier.mass
    left = np.array([0.0, 1.0, 0.0])
    share = np.stack((0.5 - 0.2 * swing, 0.5 + 0.2 * swing), axis=1)
    total = weight * ((1 - 0.2 * (swing**2 < 0.1))[:, None] * normal + np.tan(inclination)[:, None] * left)
    qpos = np.zeros((len(time), 42))
    qpos[:, :3] = np.stack((x, y, 1.0 - x * np.tan(tilt)), axis=1)
    heading = np.arctan2(steps[:, 1], steps[:, 0])
    qpos[:, 3], qpos[:, 6] = np.cos(0.5 * heading), np.sin(0.5 * heading)
    return SyntheticRecording(
        header={
            "spec": spec.to_toml(),
            "spec_hash": spec.content_hash(),
            "status": status,
            "status_detail": detail or {},
            "actuated_joint_names": list(HINGES),
            "mass": spec.skier.mass,
            "gravity": [0.0, 0.0, -9.81],
            **({"gates": _gates(gates, tilt)} if gates else {}),
        },
        time=time,
        arc_length=8.0 * time,
        progress=time,
        speed=8.0 + swing**2,
        track_position=ground,
        track_tangent=steps / np.linalg.norm(steps, axis=1, keepdims=True),
        surface_normal=normal,
        phase=np.where(np.abs(swing) > 0.5, np.sign(swing), 0).astype(np.int8),
        inclination=inclination,
        edge_angle=np.stack((inclination * 1.1, inclination * 1.2), axis=1),
        edge_angle_reference=np.stack((inclination * 1.15, inclination * 1.15), axis=1),
        snow_force=share[:, :, None] * total[:, None, :],
        torque_ratio=np.abs(swing)[:, None] * np.linspace(0.1, 0.8, len(HINGES)),
        ski_error=0.002 * np.abs(swing),
        com_error=0.001 * np.abs(swing),
        push_force=np.zeros((len(time), 3)),
        track_offset=np.stack((0.2 * swing, 0.15 * swing), axis=1),
        steering_offset=0.19 * swing,
        capture_margin=0.4 - 0.3 * np.abs(swing),
        zmp_margin=0.05 + 0.04 * swing,
        com=ground + (0.7 + 0.1 * swing)[:, None] * normal,
        com_reference=ground + 0.8 * normal,
        steering=np.radians(12.0) * swing,
        qpos=qpos,
    )


def _gates(count: int, tilt: float) -> dict[str, list]:
    """Poles on the inner side of the first `count` turns, as a recording's header has them."""
    side = (-1.0) ** np.arange(count)
    distance = 0.5 + 0.1 * np.arange(count)
    x, y = 10.0 + 20.0 * np.arange(count), side * (distance - 10.0 / np.pi)
    position = np.stack((x, y, -x * np.tan(tilt)), axis=1)
    return {"position": position.tolist(), "side": side.astype(int).tolist(), "distance": distance.tolist()}
