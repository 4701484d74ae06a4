"""Bake without a window: a new .blend with the skier, the slope, light and a camera. It opens in any plain Blender."""

from __future__ import annotations

import importlib.util
import logging
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from .. import atomic
from ..errors import BlenderMissingError, MissingInputError, OutputError, SpecError

if TYPE_CHECKING:
    from collections.abc import Callable

    import bpy

    from ..simulation.recording import Recording
    from ..spec import RunSpec
    from .bake import BakeResult
    from .ride import Ride

_LOG = logging.getLogger(__name__)
FILM_SIZE, FILM_SAMPLES = (1920, 1080), 64
"""How the frames of a new file are rendered, unless somebody asks for something else."""


def require_blender(needed_for: str) -> None:
    """Raise `BlenderMissingError` unless `bpy` can be imported."""
    if "bpy" not in sys.modules and importlib.util.find_spec("bpy") is None:
        raise BlenderMissingError(needed_for)
    try:
        import bpy  # noqa: F401 - found, but it may be built for another system
    except ImportError as error:
        raise BlenderMissingError(needed_for, str(error)) from error


def bake_file(recording: Recording, spec: RunSpec, target: str | Path) -> Path:
    """Write `target`, a new .blend with `recording` baked at the frame rate of `spec.bake`, in one step.

    The file holds plain Blender data only. Raises `BlenderMissingError` or `OutputError`. The open file is closed, so
    this is for Blender without a window.
    """
    require_blender("baking")
    from ..body import build_skeleton
    from .bake import bake_recording
    from .ride import recorded_ride

    ride = recorded_ride(recording, build_skeleton(spec.skier))
    return write_file(ride, spec, target, lambda scene: bake_recording(recording, scene, options=spec.bake))


def bake_into(recording: Recording, blend: Path, armature: str | None, target: Path) -> Path:
    """Bake `recording` into the file `blend`, on the armature of that name or on a new skier, and save it as `target`.

    The rest of the file is left as it is. The open file is closed, so this is for Blender without a window. Raises
    `BlenderMissingError`, `MissingInputError` for a file Blender cannot read, `SpecError` for an armature that is not
    there or cannot be used, or `OutputError`.
    """
    require_blender("baking")
    check_target(target)
    import bpy

    from .armatures import bake_on_armature
    from .bake import bake_recording, recorded_run

    try:
        bpy.ops.wm.open_mainfile(filepath=str(blend.resolve()), load_ui=False)
    except RuntimeError as error:
        raise MissingInputError(blend, str(error).strip().removeprefix("Error: ")) from error
    scene, options = bpy.context.scene, recorded_run(recording).bake
    if armature is None:
        bake_recording(recording, scene, options=options)
    else:
        found = bpy.data.objects.get(armature)
        if found is None or found.type != "ARMATURE":
            names = ", ".join(sorted(thing.name for thing in bpy.data.objects if thing.type == "ARMATURE"))
            hint = f"its armatures are: {names}" if names else "it has none: leave the name out for a new skier"
            raise SpecError("armature", armature, hint=hint, problem=f"is no armature of {blend.name}")
        bake_on_armature(recording, scene, found, bake=options)
    with atomic.atomic_path(target) as temporary:
        save_copy(temporary)
    _LOG.info("wrote %s with Blender %s", target, bpy.app.version_string)
    return target


def write_file(ride: Ride, spec: RunSpec, target: str | Path, bake: Callable[[bpy.types.Scene], BakeResult]) -> Path:
    """Write `target`, a new .blend with the stage of `ride` and the figure that `bake` makes in its scene.

    Raises as `bake_file`.
    """
    require_blender("baking")
    check_target(target)
    import bpy

    from .bake import scene_rate
    from .camera import build_follow_camera
    from .gates import bake_gates
    from .pictures import set_render
    from .stage import add_collection, empty_file, stage_ride

    scene = empty_file()
    scene.name = "Ski run"
    set_frame_rate(scene, spec.bake.fps)
    stage = stage_ride(ride, spec, scene)
    result = bake(scene)
    bake_gates(stage.gates, stage.swings, scene_rate(scene), spec.bake.frame_start)
    build_follow_camera(result.armature, scene, add_collection(scene, "Camera"))
    set_render(scene, FILM_SIZE, FILM_SAMPLES)
    scene.frame_set(scene.frame_start)
    look_through_camera()
    with atomic.atomic_path(target) as temporary:
        save_copy(temporary)
    _LOG.info("wrote %s with Blender %s", target, bpy.app.version_string)
    return Path(target)


def look_through_camera() -> None:
    """Set every 3D view of the file up to look through its camera, without the floor's grid."""
    import bpy

    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                view = area.spaces.active
                view.region_3d.view_perspective = "CAMERA"
                view.overlay.show_floor = view.overlay.show_axis_x = view.overlay.show_axis_y = False
                view.overlay.show_relationship_lines = False
                view.shading.color_type = "MATERIAL"
                view.clip_end = 6000.0


def check_target(target: str | Path) -> None:
    """Raise `OutputError`, before any work is done, if `target` has no folder (Blender would make it)."""
    if not Path(target).parent.is_dir():
        raise OutputError(target, "there is no such folder")


def save_copy(path: Path) -> None:
    """Save the open file as `path`; raises `OSError` where Blender says it could not."""
    import bpy

    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True, compress=True, relative_remap=False)
    except RuntimeError as error:
        raise OSError(str(error).strip().removeprefix("Error: ")) from error


def set_frame_rate(scene: object, fps: float) -> None:
    """Set the frame rate [1/s] of `scene`; rates that are not whole, such as 23.976, become a whole one and a base."""
    render = scene.render  # type: ignore[attr-defined]
    whole = max(1, round(fps))
    render.fps = whole
    render.fps_base = whole / fps
