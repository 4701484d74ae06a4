"""Rendering a still picture by Cycles."""

from __future__ import annotations

from pathlib import Path

import bpy

from .. import atomic
from ..errors import RenderError


def set_render(scene: bpy.types.Scene, size: tuple[int, int], samples: int) -> None:
    """Set `scene` up for a still picture by Cycles on the processor."""
    render = scene.render
    render.engine = "CYCLES"
    render.resolution_x, render.resolution_y = size
    render.resolution_percentage = 100
    render.image_settings.file_format = "PNG"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = True
    scene.cycles.adaptive_threshold = 0.03
    scene.cycles.use_denoising = True
    scene.cycles.max_bounces = 4
    scene.cycles.diffuse_bounces = 2
    scene.cycles.seed = 0


def render_to(scene: bpy.types.Scene, target: str | Path) -> None:
    """Render `scene` into `target` in one step; raises `RenderError` or `OutputError`."""
    with atomic.atomic_path(target) as temporary:
        scene.render.filepath = str(temporary)
        try:
            bpy.ops.render.render(write_still=True, scene=scene.name)
        except RuntimeError as error:
            raise RenderError(f"{target} could not be rendered: {error}") from error
        if not temporary.exists():
            raise RenderError(f"{target} could not be rendered: Blender wrote no picture")
