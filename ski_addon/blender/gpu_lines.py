"""Lines and words drawn over a 3D view, with the view's drawing state left as it was."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import bpy
import numpy as np

from ..frames import Array


def line_batch(points: Array, colours: Array) -> tuple[Any, Any]:
    """Return (batch, shader) of separate lines between pairs of `points` (2 m, 3) with `colours` (2 m, 4)."""
    import gpu
    from gpu_extras.batch import batch_for_shader

    shader = gpu.shader.from_builtin("POLYLINE_SMOOTH_COLOR")
    content = {"pos": np.asarray(points, dtype=np.float32), "color": np.asarray(colours, dtype=np.float32)}
    return batch_for_shader(shader, "LINES", content), shader


def pairs(strip: Array) -> Array:
    """Return the values (2 (n - 1), k) of separate lines that make the strip of `strip` (n, k)."""
    return np.repeat(strip, 2, axis=0)[1:-1]


def draw_batch(batch: Any, shader: Any, width: float) -> None:
    """Draw a batch of `line_batch` with lines `width` [pixels at a scale of 1] wide."""
    import gpu

    shader.bind()
    shader.uniform_float("viewportSize", gpu.state.viewport_get()[2:])
    shader.uniform_float("lineWidth", width * bpy.context.preferences.system.ui_scale)
    batch.draw(shader)


@contextlib.contextmanager
def drawing_over(depth: str = "NONE") -> Iterator[None]:
    """Draw within over what is there; `depth` "LESS_EQUAL" hides what is behind it."""
    import gpu

    before = gpu.state.blend_get(), gpu.state.depth_test_get(), gpu.state.depth_mask_get()
    try:
        gpu.state.blend_set("ALPHA")
        gpu.state.depth_test_set(depth)
        gpu.state.depth_mask_set(False)
        yield
    finally:
        gpu.state.blend_set(before[0])
        gpu.state.depth_test_set(before[1])
        gpu.state.depth_mask_set(before[2])


def write_at(words: str, place: Array, colour: Any, size: float = 13.0, lift: float = 0.0) -> None:
    """Write `words` centred at `place` (3,) [m, world], `lift` [pixels] above it; nothing behind the eye."""
    from bpy_extras.view3d_utils import location_3d_to_region_2d
    from mathutils import Vector

    context = bpy.context
    spot = location_3d_to_region_2d(context.region, context.region_data, Vector([float(v) for v in place]))
    if spot is not None:
        write(words, spot.x, spot.y + lift, colour, size, centred=True)


def write(words: str, x: float, y: float, colour: Any, size: float = 13.0, *, centred: bool = False) -> None:
    """Write `words` at a place of the region [pixels], with a shadow that is read over snow."""
    import blf

    blf.size(0, size * bpy.context.preferences.system.ui_scale)
    blf.enable(0, blf.SHADOW)
    try:
        blf.shadow(0, 5, 0.0, 0.0, 0.0, 0.85)
        wide, high = blf.dimensions(0, words) if centred else (0.0, 0.0)
        blf.color(0, *colour)
        blf.position(0, x - 0.5 * wide, y - 0.5 * high, 0.0)
        blf.draw(0, words)
    finally:
        blf.disable(0, blf.SHADOW)
