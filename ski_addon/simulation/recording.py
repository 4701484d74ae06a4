"""The recording of a run: what happened at every step, as plain arrays in one `.npz` file.

Nothing in the file is pickled and its bytes depend only on its contents: the archive's time stamps are fixed.
"""

from __future__ import annotations

import json
import zipfile
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from .. import archive
from ..archive import DAMAGE
from ..atomic import atomic_path
from ..errors import RecordingError

FORMAT = "ski-addon-recording"
FORMAT_VERSION = 2

SHAPES: dict[str, tuple[int, ...]] = {
    "time": (),
    "arc_length": (),
    "progress": (),
    "speed": (),
    "qpos": (42,),
    "qvel": (41,),
    "tau": (31,),
    "snow_force": (2, 3),
    "snow_edge_force": (2, 2),
    "snow_edge_side": (2, 2),
    "inclination": (),
    "edge_angle": (2,),
    "edge_angle_reference": (2,),
    "com": (3,),
    "com_reference": (3,),
    "ski_error": (),
    "com_error": (),
    "turn_phase": (),
    "curvature": (),
    "track_position": (3,),
    "track_tangent": (3,),
    "surface_normal": (3,),
    "root_residual": (),
    "torque_ratio": (31,),
    "joint_margin": (),
    "push_force": (3,),
    "track_offset": (2,),
    "steering_offset": (),
    "capture_margin": (),
    "zmp": (2,),
    "zmp_margin": (),
    "disturbance": (3,),
    "steering": (),
    "end_stop": (31,),
}
"""Real numbers recorded each step, and their shapes."""
COUNTS = {
    "phase": np.int8,
    "turn": np.int32,
    "solver_iterations": np.int32,
    "solver_status": np.int8,
    "solver_attempts": np.int8,
}
"""Whole numbers recorded each step, and their types."""


@dataclass(frozen=True)
class Recording:
    """States, forces and errors of a run at n steps; arrays are read-only.

    `header`: dict with `spec` (the run document as TOML), `spec_hash`, `model_hash`, `versions`, `seed`, `status`
    ("finished", "fell", "cancelled", "diverged"), `status_detail` ({time, what, where, why} or {}), `body_names`,
    `joint_names`, `actuated_joint_names`, `time_step`, `gravity`, `mass`, `gates` (`Gates.lists`: `position` (k, 3) [m,
    world] of the poles' feet, `side` +1 or -1, `distance` [m] asked; {} for a course without gates).
    Arrays: `time` [s], `arc_length` of the skier's place [m], `progress` in the plan [s, planned], `speed` of the
    centre of mass [m/s]; `qpos` (n, 42), `qvel` (n, 41), `tau` (n, 31) [N m]; `snow_force` (n, 2, 3) on each ski
    [N, world]; `snow_edge_force` (n, 2, 2)
    normal force by ski and edge [N], `snow_edge_side` (n, 2, 2) side force, positive to the left [N];
    `inclination` (n,), `edge_angle` (n, 2) [rad] as they were, `edge_angle_reference` (n, 2); `com`, `com_reference`
    (n, 3) [m, world]; `ski_error` (n,) largest error of a ski corner [m], `com_error` (n,) [m]; `turn_phase` (n,),
    `phase` (n,) int8, `turn` (n,) int32, `curvature` (n,) [1/m]; `track_position`, `track_tangent`, `surface_normal`
    (n, 3); `solver_iterations`, `solver_status` (0: converged), `solver_attempts`; `root_residual` [N or N m];
    `torque_ratio` (n, 31) of the human limit, 0..1; `joint_margin` (n,) least distance of a hinge from its limit [rad];
    `push_force` (n, 3) sum of the pushes from outside [N, world] and `disturbance` (n, 3) what the skier felt of them;
    `track_offset` (n, 2) of the skis' middle and of the centre of mass to the left of the plan [m], `steering_offset`
    (n,) of the line the skis are steered along; `capture_margin` (n,) [m]: positive while steering keeps the skier up;
    `zmp` (n, 2) where the load acts, along and to the left of the skis from their middle [m], and `zmp_margin` (n,) [m]
    from there to the border of the bearing edges. Errors and offsets are from the plan, not from the steered line.
    `steering` (n,) [rad] is the planned angle from the track to the skis, positive to the left: skids brake.
    `end_stop` (n, 31) [N m] is the part of `tau` that the ends of the hinges' ranges give, past the muscles' limits.
    """

    header: dict[str, Any]
    time: np.ndarray
    arc_length: np.ndarray
    progress: np.ndarray
    speed: np.ndarray
    qpos: np.ndarray
    qvel: np.ndarray
    tau: np.ndarray
    snow_force: np.ndarray
    snow_edge_force: np.ndarray
    snow_edge_side: np.ndarray
    inclination: np.ndarray
    edge_angle: np.ndarray
    edge_angle_reference: np.ndarray
    com: np.ndarray
    com_reference: np.ndarray
    ski_error: np.ndarray
    com_error: np.ndarray
    turn_phase: np.ndarray
    phase: np.ndarray
    turn: np.ndarray
    curvature: np.ndarray
    track_position: np.ndarray
    track_tangent: np.ndarray
    surface_normal: np.ndarray
    solver_iterations: np.ndarray
    solver_status: np.ndarray
    solver_attempts: np.ndarray
    root_residual: np.ndarray
    torque_ratio: np.ndarray
    joint_margin: np.ndarray
    push_force: np.ndarray
    track_offset: np.ndarray
    steering_offset: np.ndarray
    capture_margin: np.ndarray
    zmp: np.ndarray
    zmp_margin: np.ndarray
    disturbance: np.ndarray
    steering: np.ndarray
    end_stop: np.ndarray

    def __post_init__(self) -> None:
        for name in array_names():
            getattr(self, name).setflags(write=False)

    @property
    def status(self) -> str:
        """How the run ended."""
        return str(self.header["status"])

    @property
    def duration(self) -> float:
        """Simulated time [s]."""
        return float(self.time[-1] + self.header["time_step"]) if len(self.time) else 0.0

    def save(self, path: str | Path) -> Path:
        """Write the recording to `path`, whole or not at all; raises `OutputError` when it cannot be written."""
        target = Path(path)
        header = {"format": FORMAT, "format_version": FORMAT_VERSION, **self.header}
        with atomic_path(target) as temporary:
            archive.write(temporary, header, {name: getattr(self, name) for name in array_names()})
        return target

    @classmethod
    def load(cls, path: str | Path) -> Recording:
        """Read a recording; raises `RecordingError` when the file is missing, truncated or something else."""
        source = Path(path)
        if not source.is_file():
            raise RecordingError(source, "there is no such file")
        try:
            with zipfile.ZipFile(source) as members:
                archive.check_size(members)
                header = _read_header(source, members)
                arrays = {name: archive.read_member(members, name) for name in array_names()}
        except KeyError as missing:
            raise RecordingError(source, f"it lacks {missing}; simulate again") from None
        except (*DAMAGE, zipfile.BadZipFile) as problem:
            raise RecordingError(source, f"it is truncated or not a recording ({problem})") from None
        _check_shapes(source, arrays)
        return cls(header, **arrays)


def array_names() -> list[str]:
    """Return the names of a recording's arrays."""
    return [entry.name for entry in fields(Recording) if entry.name != "header"]


def _read_header(source: Path, members: zipfile.ZipFile) -> dict[str, Any]:
    document = json.loads(archive.read_member(members, "header").tobytes())
    if not isinstance(document, dict) or document.pop("format", None) != FORMAT:
        raise RecordingError(source, "it is not a recording of a ski run")
    version = document.pop("format_version", None)
    if version != FORMAT_VERSION:
        reason = f"it has format version {version}, this version reads {FORMAT_VERSION}; simulate again"
        raise RecordingError(source, reason)
    return document


def _check_shapes(source: Path, arrays: dict[str, np.ndarray]) -> None:
    count = arrays["time"].size
    for name, array in arrays.items():
        expected = (count, *SHAPES.get(name, ()))
        if array.shape != expected:
            raise RecordingError(source, f"{name} has the shape {array.shape} instead of {expected}; simulate again")
        if array.dtype.kind not in "fiu":
            raise RecordingError(source, f"{name} does not hold numbers")
