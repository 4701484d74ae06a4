"""Recording to poses of every body at scene frames: `python -m benchmarks --only resample`.

The peer is MuJoCo's `mj_kinematics` in a loop over the same number of states: one forward kinematics in C a frame,
where ours makes two, for the states before and after, and a slerp between them.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from benchmarks.measuring import How, Measurement, in_turn
from ski_addon.animation.poses import sample_body_poses
from ski_addon.body import SkierModel, build_skeleton, build_skier_model
from ski_addon.spec import RunSpec
from tests.synthetic_motion import synthetic_motion

SUBJECT = "resample"
DURATION = 10.0
RATES = (24, 60)


def measurements(how: How) -> list[Measurement]:
    """Return the rows of resampling ten seconds at each rate."""
    spec = RunSpec()
    skeleton, model = build_skeleton(spec.skier), build_skier_model(spec.skier)
    recording: Any = synthetic_motion(skeleton, spec, duration=DURATION)
    functions: dict[str, Callable[[], Any]] = {}
    for rate in RATES:
        states = recording.qpos[:: round(1000 / rate)]
        functions[f"at {rate} fps"] = partial(sample_body_poses, recording, skeleton, rate)
        functions[f"peer {rate}"] = partial(kinematics, model, states)
    samples = in_turn(functions, how.rounds(25, 9))
    rows = []
    for rate in RATES:
        mine = samples[f"at {rate} fps"]
        ratio = mine.over(samples[f"peer {rate}"])
        row = mine.row(SUBJECT, f"at {rate} fps", "ms", peer="mj_kinematics", peer_ratio=ratio)
        rows.append(row)
    return rows


def kinematics(model: SkierModel, states: np.ndarray) -> np.ndarray:
    """Return the places of all bodies (n, b, 3) [m] at states (n, nq), by MuJoCo."""
    import mujoco

    data = mujoco.MjData(model.mujoco)
    places = np.empty((len(states), *data.xpos.shape))
    for index, state in enumerate(states):
        data.qpos[:] = state
        mujoco.mj_kinematics(model.mujoco, data)
        places[index] = data.xpos
    return places
