"""The frame rate of a scene."""

from __future__ import annotations

import bpy


def scene_rate(scene: bpy.types.Scene) -> float:
    """Return the frames per second of `scene`, its base included."""
    return float(scene.render.fps) / float(scene.render.fps_base)
