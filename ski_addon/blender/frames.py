"""Rendering frames of a .blend file as still pictures: the same bytes each time, from the file alone."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import bpy

from ..apart import silenced
from ..errors import MissingInputError, RenderError
from .headless import require_blender

if TYPE_CHECKING:
    from ..tasks.rendering import RenderSettings

ENGINES = {"cycles": "CYCLES", "workbench": "BLENDER_WORKBENCH"}
MOTION_STEPS = 3
"""Cycles' steps of motion while the shutter is open: 2^(3 - 1) parts, so that curved ways are curved."""
PLAIN, PACKED = b"BLENDER", b"\x28\xb5\x2f\xfd"
"""How .blend files begin, plain and compressed."""
PACKED_END = b"\xb1\xea\x92\x8f"
"""How compressed ones end."""


class FrameRenderer:
    """Renders frames of one open file: `first` to `last` are those it has."""

    def __init__(self, blend: Path, settings: RenderSettings) -> None:
        """Open `blend`, whose scripts are not run, and set it up; the open file is closed.

        Raises `MissingInputError` for a file that cannot be read and `RenderError` for one that cannot be rendered so.
        """
        require_blender("rendering")
        _open(blend)
        self._scene = bpy.context.scene
        if self._scene.camera is None:
            raise RenderError(f"{blend} cannot be rendered: its scene has no camera")
        self.first, self.last = self._scene.frame_start, self._scene.frame_end
        _set_up(self._scene, settings)

    def render(self, frame: int, target: Path) -> None:
        """Write the picture of `frame` to `target`; raises `RenderError`."""
        scene = self._scene
        with silenced():
            scene.frame_set(frame)
            scene.render.filepath = str(target)
            try:
                bpy.ops.render.render(write_still=True, scene=scene.name)
            except RuntimeError as error:
                raise RenderError(f"frame {frame} could not be rendered: {error}") from error
        if not target.exists():
            raise RenderError(f"frame {frame} could not be rendered: Blender wrote no picture")


def _open(blend: Path) -> None:
    _check_whole(blend)
    try:
        bpy.ops.wm.open_mainfile(filepath=str(blend.resolve()), load_ui=False, use_scripts=False)
    except RuntimeError as error:
        raise MissingInputError(blend, str(error).strip().removeprefix("Error: ")) from error


def _check_whole(blend: Path) -> None:
    """Raise `MissingInputError` for a file that is cut short: Blender opens some of these, with parts missing."""
    try:
        content = blend.read_bytes()
    except OSError as error:
        raise MissingInputError(blend, error.strerror or str(error)) from None
    if not content.startswith((PLAIN, PACKED)):
        raise MissingInputError(blend, "it is not a .blend file")
    whole = content.endswith(PACKED_END) if content.startswith(PACKED) else b"ENDB" in content[-64:]
    if not whole:
        raise MissingInputError(blend, "it is cut short: bake it again")


def _set_up(scene: bpy.types.Scene, settings: RenderSettings) -> None:
    render = scene.render
    render.engine = ENGINES[settings.engine]
    if settings.size:
        render.resolution_x, render.resolution_y = settings.size
        render.resolution_percentage = 100
    _set_pictures(render)
    if settings.engine == "cycles":
        _set_cycles(scene, settings)
    elif settings.samples:
        aa = ("5", "8", "11", "16", "32")
        scene.display.render_aa = next((count for count in aa if int(count) >= settings.samples), "32")


def _set_pictures(render: bpy.types.RenderSettings) -> None:
    """Let nothing be written into the pictures that differs from one time to the next."""
    images = render.image_settings
    if hasattr(images, "media_type"):  # Blender 5
        images.media_type = "IMAGE"
    images.file_format = "PNG"
    images.color_mode = "RGBA" if render.film_transparent else "RGB"
    images.color_depth = "8"
    render.use_file_extension = False
    for name in dir(render):
        if name.startswith("use_stamp"):
            setattr(render, name, False)


def _set_cycles(scene: bpy.types.Scene, settings: RenderSettings) -> None:
    cycles = scene.cycles
    cycles.seed, cycles.use_animated_seed = 0, False
    if settings.denoise is not None:
        cycles.use_denoising = settings.denoise
    if settings.samples:
        cycles.samples = settings.samples
    _set_device(scene, settings.device)
    if settings.motion_blur is not None:
        scene.render.use_motion_blur = settings.motion_blur > 0.0
        scene.render.motion_blur_shutter = max(settings.motion_blur, 0.01)
    if scene.render.use_motion_blur:
        for figure in scene.objects:
            figure.cycles.motion_steps = max(figure.cycles.motion_steps, MOTION_STEPS)


def _set_device(scene: bpy.types.Scene, device: str) -> None:
    """Render on all devices of a kind; raises `RenderError` if there are none."""
    scene.cycles.device = "CPU" if device == "CPU" else "GPU"
    if device == "CPU":
        return
    preferences = bpy.context.preferences.addons["cycles"].preferences
    try:
        preferences.compute_device_type = device
    except TypeError:
        raise RenderError(f"--device {device}: this Blender cannot use such devices: use --device CPU") from None
    preferences.get_devices()
    fitting = [found for found in preferences.devices if found.type == device]
    for found in preferences.devices:
        found.use = found in fitting
    if not fitting:
        raise RenderError(f"--device {device}: there is no such device here: use --device CPU")
