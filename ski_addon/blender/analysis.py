"""The report of a run as an image that Blender's Image Editor shows."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..report.plots import SIZE, draw_report

if TYPE_CHECKING:
    from ..simulation.recording import Recording

REPORT_PROPERTY = "ski_report"
"""Custom property of an image: the scene or run whose report it is."""


def show_report(recording: Recording, scene: bpy.types.Scene | str, *, size: tuple[int, int] = SIZE) -> bpy.types.Image:
    """Draw the report of `recording` into the image "Ski report NAME" and return it; nothing is opened.

    NAME is that of `scene`, or the text itself. The image is made at the first call and drawn anew later; it is packed
    into the .blend. `size` is its width and height [pixels]. Raises `RecordingError` if the recording holds no steps.
    """
    pixels = draw_report(recording, size)
    height, width = pixels.shape[:2]
    image = _report_image(scene if isinstance(scene, str) else scene.name, width, height)
    image.pixels.foreach_set(np.ascontiguousarray(pixels[::-1]).ravel())  # Blender's first row is the lowest
    image.update()
    image.pack()
    return image


def find_report(name: str) -> bpy.types.Image | None:
    """Return the image that shows the report of the scene or run `name`, whatever it is called by now, or None."""
    return next((image for image in bpy.data.images if image.get(REPORT_PROPERTY) == name), None)


def _report_image(name: str, width: int, height: int) -> bpy.types.Image:
    """Return the image for the report of `name`, `width` by `height` pixels."""
    image = find_report(name)
    if image is not None and min(image.size) and not image.is_float:  # to ask for its size loads it from the .blend
        if tuple(image.size) != (width, height):
            image.scale(width, height)
        return image
    fresh = bpy.data.images.new(f"Ski report {name}", width, height, alpha=False)
    fresh[REPORT_PROPERTY] = name
    if image is not None:  # its pixels cannot be had any more: whatever shows it shows the new one
        image.user_remap(fresh)
        called = image.name
        bpy.data.images.remove(image)
        fresh.name = called
    return fresh
