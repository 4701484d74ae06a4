"""An object that follows the edge of the outside ski and says how much snow flies: to emit particles from."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy
import numpy as np

from ..animation.spray import spray_motion
from ..body import build_skeleton
from .channels import assign_action, bake_action
from .fewer_keys import FewerKeys, KeyOptions
from .slope import mesh_object, snow_material

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..spec import RunSpec

NAME = "Snow spray"
MARK = "ski_addon_spray"
"""Custom property of the emitter, by which a later bake finds it again."""
STRENGTH = "strength"
"""Custom property of the emitter with keys: how much snow flies, 0..1."""
LENGTH, WIDTH = 0.8, 0.01
"""Size of the emitter along and across the ski [m]; too thin to be seen itself."""


def build_spray(
    recording: Recording,
    run: RunSpec,
    collection: bpy.types.Collection,
    rate: float,
    frame_start: float = 1,
    keys: KeyOptions | None = None,
) -> bpy.types.Object:
    """Return the emitter of `collection` with keys for `recording` of `run`, at `rate` frames a second.

    It is a thin face that lies along the edge of the outside ski and looks where the snow flies (see `SprayMotion`),
    with keys for location, rotation and its custom property "strength", from `frame_start` on. One that is there from
    an earlier bake is taken again, with the particle systems and modifiers that the user gave it. `keys` says which
    frames are baked, and which keys are left out.

    Raises `SpecError` for an impossible rate and `EmptyRecordingError` if nothing was recorded.
    """
    motion = spray_motion(recording, build_skeleton(run.skier), run.skier.mass, rate, frame_start)
    emitter = next((obj for obj in collection.all_objects if obj.get(MARK)), None) or _new_emitter(collection)
    emitter.rotation_mode = "QUATERNION"
    emitter[STRENGTH] = float(motion.strength[0])
    emitter.id_properties_ui(STRENGTH).update(
        min=0.0, max=1.0, soft_min=0.0, soft_max=1.0, description="How much snow the skis throw up"
    )
    action, slot, channelbag = bake_action(emitter, NAME)
    kept = (keys or KeyOptions()).span.within(motion.frame)
    writer = FewerKeys(channelbag, motion.frame[kept], keys or KeyOptions())
    writer.places("location", motion.position[kept], NAME)
    writer.rotations("rotation_quaternion", motion.quaternion[kept], NAME)
    writer.numbers(f'["{STRENGTH}"]', motion.strength[kept], NAME)
    assign_action(emitter, action, slot)
    return emitter


def _new_emitter(collection: bpy.types.Collection) -> bpy.types.Object:
    x, y = 0.5 * LENGTH, 0.5 * WIDTH
    corners = np.array([(-x, -y, 0.0), (x, -y, 0.0), (x, y, 0.0), (-x, y, 0.0)])
    emitter = mesh_object(NAME, corners, [(0, 1, 2, 3)], collection)
    emitter.data.materials.append(snow_material())
    emitter.display_type = "WIRE"
    emitter.show_instancer_for_render = False  # of an emitter only what it emits is rendered
    emitter[MARK] = True
    return emitter
