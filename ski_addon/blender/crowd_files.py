"""A crowd without a window: a new .blend with everybody on one slope, and one picture of the moment most are on it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import atomic
from .headless import check_target, look_through_camera, require_blender, save_copy, set_frame_rate

if TYPE_CHECKING:
    import bpy

    from ..crowd.skied import SkiedCrowd
    from ..frames import Array
    from ..spec import RunSpec
    from .stage import Stage

SIZE = (1600, 900)
SAMPLES = 20
FILL = 0.86
MOST_SEEN = 100.0
"""Length of the slope that a picture shows at most [m]: farther apart skiers are too small."""
LOOK = 5
"""Steps between two moments that are looked at for a picture."""
HEIGHT_DEG, AZIMUTH_DEG = 24.0, 28.0
"""Where the camera of a picture stands, from the way down: over the slope, and to the side."""


def bake_crowd_file(folder: Path, target: str | Path) -> Path:
    """Write `target`, a new .blend with the crowd that was simulated into `folder`, in one step.

    The camera shows the moment at which most are on the slope. Raises as `headless.bake_file`.
    """
    require_blender("baking")
    check_target(target)
    scene, _ = _stage(folder)
    look_through_camera()
    with atomic.atomic_path(target) as temporary:
        save_copy(temporary)
    return Path(target)


def render_crowd(folder: Path, target: str | Path, *, size: tuple[int, int] = SIZE, samples: int = SAMPLES) -> Path:
    """Write `target`, a picture of the moment at which most of the crowd in `folder` are on the slope.

    Raises as `strobe.render_strobe`. The open file is closed.
    """
    require_blender("the picture")
    check_target(target)
    from .pictures import render_to, set_render

    scene, _ = _stage(folder, size, samples, set_render)
    render_to(scene, target)
    return Path(target)


def _stage(folder: Path, size: tuple[int, int] = SIZE, samples: int = SAMPLES, set_up: Any = None) -> Any:
    """Open an empty file and put the crowd, its slope and a camera into it; returns the scene and the spec."""
    from ..crowd.skied import read_skied
    from ..simulation.recording import Recording
    from .bake import recorded_run
    from .crowd_bake import bake_crowd
    from .stage import add_collection, empty_file, stage_ride

    crowd = read_skied(folder)
    spec = recorded_run(Recording.load(crowd.members[0].path))
    scene = empty_file()
    scene.name = "Ski crowd"
    set_frame_rate(scene, spec.bake.fps)
    if set_up is not None:
        set_up(scene, size, samples)
    made = bake_crowd(crowd, scene, add_collection(scene, "Crowd"), spec.bake)
    if made.ride is not None:
        stage = stage_ride(made.ride, spec, scene)
        _stand_gates(made.courses, stage, scene)
    _look(scene, crowd, spec)
    return scene, spec


def _stand_gates(courses: Sequence[tuple[RunSpec, float]], stage: Stage, scene: bpy.types.Scene) -> None:
    """Stand the gates of every course where it was skied, each once; `stage` has those of the first, not yet moved."""
    from ..course import course_gates
    from .gates import build_gates
    from .stage import add_collection

    collection = stage.gates[0][0].users_collection[0] if stage.gates else None
    seen: set[tuple[bytes, float]] = set()
    for number, (spec, offset) in enumerate(courses):
        gates = course_gates(spec, stage.terrain)
        if gates is None or (gates.position.tobytes(), offset) in seen:
            continue
        seen.add((gates.position.tobytes(), offset))
        collection = collection or add_collection(scene, "Gates")
        built = build_gates(spec, stage.terrain, collection) if number else stage.gates
        for obj in [obj for objects in built for obj in objects]:
            obj.location.y += offset


def _look(scene: bpy.types.Scene, crowd: SkiedCrowd, spec: RunSpec) -> None:
    """Go to the fullest moment and frame those who are on the slope then."""
    from .camera import build_framing_camera, direction_from
    from .stage import add_collection

    time, seen = fullest_moment(crowd)
    scene.frame_set(spec.bake.frame_start + round(time * spec.bake.fps))
    points = np.concatenate([seen + np.array((0.0, y, z)) for y in (-1.0, 1.0) for z in (-1.0, 1.2)])
    direction = direction_from(AZIMUTH_DEG, HEIGHT_DEG - spec.slope.angle_deg)
    build_framing_camera(points, direction, scene, add_collection(scene, "Camera"), lens=60.0, fill=FILL)


def fullest_moment(crowd: SkiedCrowd) -> tuple[float, Array]:
    """Return the time [s] at which most skiers are within `MOST_SEEN` of each other, and where they are (k, 3) [m].

    Where there are many such moments it is the middle one: at the first and last ones they only just start or stop.
    """
    from ..crowd.tracks import STEP, on_clock, way_of
    from ..simulation.recording import Recording

    placed = []
    for member in crowd.members:
        recording = Recording.load(member.path)
        way = way_of(recording.time, recording.com, float(recording.time[-1]))
        first, place = on_clock(way, member.start, 0.0)
        placed.append((first, place + (0.0, member.offset, 0.0)))
    moments: list[tuple[float, Array]] = []
    for step in range(min(first for first, _ in placed), max(first + len(place) for first, place in placed), LOOK):
        there = np.array([place[step - first] for first, place in placed if 0 < step - first < len(place)])
        if len(there):
            along = there[:, 0]
            near = max((there[(along >= low) & (along <= low + MOST_SEEN)] for low in along), key=len)
            moments.append((step * STEP, near))
    if not moments:
        return 0.0, placed[0][1][:1]
    most = max(len(near) for _, near in moments)
    fullest = [moment for moment in moments if len(moment[1]) == most]
    return fullest[len(fullest) // 2]
