"""Close-ups of a run: the apex of a left and a right turn and the transition between them, from front and side."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..frames import Array
from .headless import check_target, require_blender
from .turns import turn_apexes

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..spec import RunSpec
    from .ride import Ride
    from .rig import Rig

SUN_BESIDE = 100.0, 24.0
"""Azimuth, beside the fall line, and height of the sun [deg]."""


def render_closeups(
    recording: Recording,
    spec: RunSpec,
    folder: str | Path,
    *,
    size: tuple[int, int] = (640, 640),
    samples: int = 32,
) -> list[Path]:
    """Write six pictures into `folder`: apex of a left turn, transition, apex of a right turn; front and side each."""
    require_blender("the pictures")
    from ..body import build_skeleton
    from .ride import recorded_ride

    return render_ride_closeups(
        recorded_ride(recording, build_skeleton(spec.skier)), spec, folder, size=size, samples=samples
    )


def render_ride_closeups(
    ride: Ride,
    spec: RunSpec,
    folder: str | Path,
    *,
    size: tuple[int, int] = (640, 640),
    samples: int = 32,
) -> list[Path]:
    """Write six pictures of `ride` of any figure into `folder`, as `render_closeups` does of a recording."""
    require_blender("the pictures")
    check_target(Path(folder) / "front.png")
    from .camera import build_framing_camera
    from .pictures import render_to, set_render
    from .posing import posed_as, world_vertices
    from .rig import build_rig_of
    from .stage import add_collection, empty_file, stage_ride

    scene = empty_file()
    stage_ride(ride, spec, scene, sun_deg=SUN_BESIDE)
    rig = build_rig_of(ride.figure, scene)
    set_render(scene, size, samples)
    moments = turn_apexes(ride.timeline)
    clock = np.asarray(ride.timeline.time) - ride.timeline.time[0]
    written = []
    cameras = add_collection(scene, "Camera")
    poses = ride.poses_at(clock[list(moments.values())])
    for name, _ in zip(moments, posed_as(rig, ride.figure, ride.bone_map, poses), strict=True):
        points = np.concatenate([world_vertices(obj) for obj in rig.meshes])
        heading = _heading(rig)
        for view, turn in (("front", heading), ("side", np.array([heading[1], -heading[0], 0.0]))):
            build_framing_camera(points, turn + np.array([0.0, 0.0, 0.16]), scene, cameras, lens=70.0, fill=0.9)
            path = Path(folder) / f"{name}_{view}.png"
            render_to(scene, path)
            written.append(path)
    return written


def _heading(rig: Rig) -> Array:
    """Return the horizontal direction (3,) in which skis, board or frame point."""
    axis = np.zeros(3)
    for name in {"ski.L", "ski.R", "board", "frame"} & set(rig.equipment):
        axis += np.array(rig.armature.matrix_world @ rig.armature.pose.bones[name].matrix)[:3, 1]
    axis[2] = 0.0
    return axis / np.linalg.norm(axis)
