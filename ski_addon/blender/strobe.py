"""The strobe picture: the slope with the skier at several instants of one run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..frames import Array
from .headless import check_target, require_blender
from .views import choose_view, way

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..spec import RunSpec
    from .ride import Ride

SIZE = (1600, 900)
SAMPLES = 20
FILL = 0.90


def render_strobe(
    recording: Recording,
    spec: RunSpec,
    target: str | Path,
    instants: int = 10,
    *,
    stop: bool = False,
    size: tuple[int, int] = SIZE,
    samples: int = SAMPLES,
) -> Path:
    """Write `target`, one picture of the slope with the skier at `instants` moments, as in [SG19 Fig. 11].

    What is shown and from where depends on the course (see `choose_view`); with `stop` it is the end of the run.
    Raises `BlenderMissingError`, `RenderError` or `OutputError`. The open file is closed.
    """
    require_blender("the picture")
    check_target(target)
    from ..body import build_skeleton
    from .ride import recorded_ride

    ride = recorded_ride(recording, build_skeleton(spec.skier))
    return render_ride(ride, spec, target, instants, stop=stop, size=size, samples=samples)


def render_ride(
    ride: Ride,
    spec: RunSpec,
    target: str | Path,
    instants: int = 10,
    *,
    stop: bool = False,
    size: tuple[int, int] = SIZE,
    samples: int = SAMPLES,
) -> Path:
    """Write `target`, one picture of `ride` of any figure, as `render_strobe` does of a recording."""
    require_blender("the picture")
    check_target(target)
    from .camera import build_framing_camera, direction_from
    from .gates import pose_gates
    from .pictures import render_to, set_render
    from .posing import leave_copies, posed_as, remove_rig
    from .rig import build_rig_of
    from .scenery import build_trees
    from .stage import add_collection, empty_file, stage_ride

    scene = empty_file()
    view = choose_view(ride.timeline, spec, instants, stop=stop)
    azimuth, descent = way(ride.timeline, view.time)
    sun = azimuth + view.sun_deg, view.sun_height_deg
    stage = stage_ride(ride, spec, scene, sun_deg=sun, trees=False)
    figures = add_collection(scene, "Instants")
    rig = build_rig_of(ride.figure, scene)
    poses = ride.poses_at(view.time)
    points = [leave_copies(rig, figures) for _ in posed_as(rig, ride.figure, ride.bone_map, poses)]
    remove_rig(rig)
    pose_gates(stage.gates, stage.swings, view.time)
    set_render(scene, size, samples)
    points.append(points[0] + np.array([0.0, 0.0, view.headroom]))
    seen = np.concatenate(points)
    slant = np.cos(np.radians(view.azimuth_deg))  # of the way, as the camera sees it
    direction = direction_from(azimuth + view.azimuth_deg, view.height_deg - slant * descent)
    look = {"lens": view.lens, "fill": FILL, "lift": view.lift}
    camera = build_framing_camera(seen, direction, scene, add_collection(scene, "Camera"), **look)
    outline = _outline(np.array(camera.matrix_world.translation), seen)
    track, scenery = np.asarray(ride.timeline.track_position), scene.collection.children["Scenery"]
    build_trees(stage.terrain, track, scenery, clear=outline, snow=ride.on_snow)
    render_to(scene, target)
    return Path(target)


def _outline(camera: Array, seen: Array) -> Array:
    """Return the corners (3, 2), counter-clockwise, of the triangle from `camera` (3,) over all of `seen` (n, 3)."""
    offset = (seen - camera)[:, :2]
    ahead = offset.mean(axis=0)
    bearing = np.arctan2(ahead[0] * offset[:, 1] - ahead[1] * offset[:, 0], offset @ ahead)
    ends = np.arctan2(ahead[1], ahead[0]) + np.array((bearing.min(), bearing.max()))
    length = np.linalg.norm(offset, axis=1).max() / np.cos(0.5 * np.ptp(bearing))
    far = camera[:2] + length * np.stack((np.cos(ends), np.sin(ends)), axis=1)
    return np.stack((camera[:2], *far))
