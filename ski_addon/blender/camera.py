"""Cameras: one that follows the skier, and one that frames given points."""

from __future__ import annotations

import math

import bpy
import numpy as np
from mathutils import Matrix, Vector

from ..frames import Array

FOLLOW_OFFSET = (5.2, -3.6, 0.35)
"""Where the following camera stands from the skier: downhill and to the side [m]."""


def build_follow_camera(
    armature: bpy.types.Object, scene: bpy.types.Scene, collection: bpy.types.Collection
) -> bpy.types.Object:
    """Return a new camera that goes with the skier's pelvis and looks at it; it becomes the scene's camera."""
    carrier = bpy.data.objects.new("Camera carrier", None)
    carrier.empty_display_size = 0.3
    follow = carrier.constraints.new("COPY_LOCATION")
    follow.target, follow.subtarget = armature, "pelvis"
    camera = _camera("Camera", 45.0, collection)
    collection.objects.link(carrier)
    camera.parent = carrier
    camera.location = FOLLOW_OFFSET
    look = camera.constraints.new("TRACK_TO")
    look.target, look.subtarget = armature, "pelvis"
    look.track_axis, look.up_axis = "TRACK_NEGATIVE_Z", "UP_Y"
    scene.camera = camera
    return camera


def build_framing_camera(
    points: Array, direction: Array, scene: bpy.types.Scene, collection: bpy.types.Collection, *,
    lens: float = 50.0, fill: float = 0.90, lift: float = 0.0,
) -> bpy.types.Object:  # fmt: skip
    """Return a new camera looking against `direction` (3,) that has all `points` (n, 3) [m] within `fill` of the frame.

    `direction` points from the scene to the camera. `lift` moves the picture's content up by that share of its height.
    """
    camera = _camera("Camera", lens, collection)
    turn = Vector(direction).to_track_quat("Z", "Y").to_matrix()
    axes = np.array(turn)  # columns: right, up, back
    half_width = 0.5 * camera.data.sensor_width / lens * fill
    render = scene.render
    half_height = half_width * render.resolution_y / render.resolution_x
    local = points @ axes  # coordinates to the right, up and towards the camera
    place = _fitting_place(local, half_width, half_height)
    place[1] -= lift * half_height * (place[2] - float(np.median(local[:, 2])))
    world = Matrix.Translation(Vector(axes @ place)) @ turn.to_4x4()
    camera.matrix_world = world
    camera.data.clip_end = 6000.0
    scene.camera = camera
    return camera


def _fitting_place(local: Array, half_width: float, half_height: float) -> Array:
    """Return the camera's place (3,) in its own axes: the nearest from which |x| <= half_width * depth, same for y."""
    place = np.zeros(3)
    distances = []
    for axis, half in ((0, half_width), (1, half_height)):
        # x_i - c <= half * (d - z_i) for all i, and the same for -x: the two extreme lines cross at the place
        upper = float(np.max(local[:, axis] + half * local[:, 2]))
        lower = float(np.min(local[:, axis] - half * local[:, 2]))
        place[axis] = 0.5 * (upper + lower)
        distances.append(0.5 * (upper - lower) / half)
    place[2] = max(distances)
    return place


def _camera(name: str, lens: float, collection: bpy.types.Collection) -> bpy.types.Object:
    data = bpy.data.cameras.new(name)
    data.lens = lens
    data.clip_end = 6000.0
    camera = bpy.data.objects.new(name, data)
    collection.objects.link(camera)
    return camera


def direction_from(azimuth_deg: float, height_deg: float) -> Array:
    """Return the unit vector (3,) at an azimuth (0 is +x, 90 is +y) and a height over the horizon."""
    azimuth, height = math.radians(azimuth_deg), math.radians(height_deg)
    return np.array((math.cos(azimuth) * math.cos(height), math.sin(azimuth) * math.cos(height), math.sin(height)))
