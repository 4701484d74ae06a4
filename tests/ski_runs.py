"""Plans and runs that several tests look at: each is made once in a session."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ski_addon.body import SkierModel, build_skier_model
from ski_addon.control import Dynamics
from ski_addon.pipeline import Planned, make_plan, run_simulation
from ski_addon.simulation import Recording
from ski_addon.spec import RunSpec, SkierSpec

PRESETS = Path(__file__).resolve().parents[1] / "presets" / "runs"
FRICTIONLESS = {"snow.friction": 0, "snow.friction_per_speed": 0}
MAIN = {"course.turn_count": 2}
"""The paper's main case cut to two turns (3.5 s): right, then left, from 9 m/s."""
COARSE = {**MAIN, "simulation.time_step": 0.002}
"""The same in steps of 2 ms: half the time to compute, twice the tracking error."""
FAST = {**COARSE, "course.start_speed": 12}
"""42 degrees of lean."""
WEAK = {**FAST, "skier.strength": 0.42, "simulation.time_step": 0.004, "technique.balance": "tracking"}
"""The same with muscles that cannot do it and no steps aside: at their limits from the start, and a fall within two
seconds.
"""


def preset(name: str, changes: Mapping[str, Any] | None = None) -> RunSpec:
    """A shipped run with some keys changed."""
    return RunSpec.from_toml(PRESETS / f"{name}.toml").with_overrides(changes or {})


def planned(name: str, changes: Mapping[str, Any] | None = None) -> Planned:
    """The plan of a shipped run, kept for the session."""
    return _planned(name, tuple(sorted((changes or {}).items())))


def simulated(name: str, changes: Mapping[str, Any] | None = None) -> Recording:
    """The recording of a shipped run, kept for the session."""
    return _simulated(name, tuple(sorted((changes or {}).items())))


@functools.cache
def _planned(name: str, changes: tuple[tuple[str, Any], ...]) -> Planned:
    return make_plan(preset(name, dict(changes)))


@functools.cache
def _simulated(name: str, changes: tuple[tuple[str, Any], ...]) -> Recording:
    return run_simulation(_planned(name, changes))[0]


@functools.cache
def default_model() -> SkierModel:
    """The paper's skier: 50 kg, 1.5 m."""
    return build_skier_model(SkierSpec())


def random_configuration(model: SkierModel, rng: np.random.Generator, spread: float = 1.0) -> np.ndarray:
    """A qpos (42,) anywhere within the joint ranges, the root anywhere and turned any way."""
    qpos = np.zeros(model.mujoco.nq)
    qpos[:3] = rng.normal(size=3)
    qpos[3:7] = rng.normal(size=4)
    qpos[3:7] /= np.linalg.norm(qpos[3:7])
    qpos[7:] = 0.4 * rng.normal(size=len(qpos) - 7)  # the poles' hinges have no range
    middle, half = 0.5 * (model.joint_lower + model.joint_upper), 0.5 * (model.joint_upper - model.joint_lower)
    qpos[model.actuated_qpos] = middle + spread * half * rng.uniform(-1.0, 1.0, len(half))
    return qpos


def random_dynamics(model: SkierModel, seed: int, drag_factor: float = 0.004) -> Dynamics:
    """Dynamics at a random state: every hinge and the root turning, 8 m/s on."""
    rng = np.random.default_rng(seed)
    dynamics = Dynamics(model, drag_factor)
    dynamics.qpos[:] = random_configuration(model, rng)
    dynamics.qvel[:] = rng.normal(size=model.mujoco.nv)
    dynamics.qvel[:3] *= 8.0
    dynamics.update()
    return dynamics


def mirrored_hinges(model: SkierModel) -> tuple[np.ndarray, np.ndarray]:
    """For every hinge of the skeleton: the index of its mirror image, and the sign its angle takes there."""
    names = list(model.skeleton.joint_names)
    other = {"L": "R", "R": "L"}
    index, sign = [], []
    for name in names:
        base, _, side = name.partition(".")
        index.append(names.index(f"{base}.{other[side]}" if side else base))
        sign.append(1.0 if base.endswith("_y") else -1.0)
    return np.array(index), np.array(sign)


def mirrored_qpos(model: SkierModel, qpos: np.ndarray) -> np.ndarray:
    """The mirror image in the xz plane of configurations (..., 42)."""
    from ski_addon.frames import mirror_quaternion, mirror_vector

    index, sign = mirrored_hinges(model)
    out = np.empty_like(qpos)
    out[..., :3] = mirror_vector(qpos[..., :3])
    out[..., 3:7] = mirror_quaternion(qpos[..., 3:7])
    out[..., 7:] = sign * qpos[..., 7:][..., index]
    return out
