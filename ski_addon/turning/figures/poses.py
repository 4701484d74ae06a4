"""From a turning motion to the world pose of every body of a figure at every scene frame."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...animation.poses import BodyPoses, frame_times
from ...frames import quaternion_from_matrix
from ...spec import FigureSpec, RunSpec
from ...terrain import Terrain
from ..motion import TurningMotion
from .cyclist import bicycle_frames
from .model import FigureModel
from .person import Frames
from .sampling import Run
from .skiers import alpine_frames, telemark_frames
from .snowboard import snowboard_frames

MAPPINGS: dict[str, Callable[[FigureModel, FigureSpec, Run, np.ndarray], Frames]] = {
    "alpine": alpine_frames,
    "snowboard": snowboard_frames,
    "telemark": telemark_frames,
    "bicycle": bicycle_frames,
}
"""How each kind of figure moves."""


def figure_poses(
    figure: FigureModel,
    spec: RunSpec,
    motion: TurningMotion,
    fps: float,
    subframes: int = 1,
    frame_start: float = 1,
    *,
    terrain: Terrain | None = None,
) -> BodyPoses:
    """Return the world poses of `figure` at the scene frames of a scene of `fps` [1/s].

    The poses' time is since the start of `motion`. With `terrain`, every ski and wheel stands on the real ground at
    its own place; without it, on the path of the motion and the planes along it, which is the same on a plane.
    """
    frame, time = frame_times(motion.duration, fps, subframes, frame_start)
    return poses_at(figure, spec, motion, time, frame, terrain=terrain)


def poses_at(
    figure: FigureModel,
    spec: RunSpec,
    motion: TurningMotion,
    time: np.ndarray,
    frame: np.ndarray | None = None,
    *,
    terrain: Terrain | None = None,
) -> BodyPoses:
    """Return the world poses of `figure` at `time` (m,) [s] since the start of `motion`; see `figure_poses`."""
    run = Run(motion, terrain)
    frames = MAPPINGS[figure.kind](figure, spec.figure, run, np.asarray(time, dtype=float) + motion.time[0])
    position = np.stack([frames[name][0] for name in figure.body_names], axis=1)
    turn = np.stack([frames[name][1] for name in figure.body_names], axis=1)
    frame = np.arange(len(time), dtype=float) if frame is None else frame
    return BodyPoses(frame, np.asarray(time, dtype=float), position, quaternion_from_matrix(turn), figure.body_names)
