"""Writing keys into actions: one way for Blender 4.5, 5.0 and 5.2, by layers, slots and channelbags."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ..frames import Array

LINEAR = 1
"""Value of a keyframe's interpolation as `foreach_set` takes it."""
MARK = "ski_addon_bake"
"""Custom property of the actions that this add-on wrote and may write again."""


def ensure_channelbag(action: bpy.types.Action, slot: Any) -> Any:
    """Return the channelbag of `slot` in `action`, with the layer and strip around it."""
    layer = action.layers[0] if action.layers else action.layers.new("Layer")
    strip = layer.strips[0] if layer.strips else layer.strips.new(type="KEYFRAME")
    return strip.channelbag(slot, ensure=True)


class KeyWriter:
    """Writes curves that all have their keys at the same `frame` (m,), with linear interpolation."""

    def __init__(self, channelbag: Any, frame: Array) -> None:
        self._channelbag = channelbag
        self._keys = np.empty((len(frame), 2), dtype=np.float32)
        self._keys[:, 0] = frame
        self._interpolation = np.full(len(frame), LINEAR, dtype=np.uint8)

    def write(self, data_path: str, values: Array, group: str) -> None:
        """Write one curve (values (m,)) or one a column (values (m, k)) for the property at `data_path`."""
        columns = np.asarray(values).reshape(len(self._keys), -1)
        for index in range(columns.shape[1]):
            curve = self._channelbag.fcurves.new(data_path, index=index)
            curve.group = self._group(group)
            self._keys[:, 1] = columns[:, index]
            points = curve.keyframe_points
            points.add(len(self._keys))
            points.foreach_set("co", self._keys.ravel())
            points.foreach_set("interpolation", self._interpolation)
            curve.update()

    def _group(self, name: str) -> Any:
        return self._channelbag.groups.get(name) or self._channelbag.groups.new(name)


def bake_action(
    obj: bpy.types.Object, name: str, again: bpy.types.Action | None = None
) -> tuple[bpy.types.Action, Any, Any]:
    """Return (action, slot, channelbag), empty, to write the motion of `obj` into; it is not yet assigned.

    The action that `obj` has is taken again if an earlier bake made it for this object alone (`again` is one that is
    known to be so). Otherwise there is a new one, so that nobody's own keys are lost.
    """
    data = obj.animation_data
    action = again or (data.action if data else None)
    if action is not None and (again or is_ours_alone(action)):
        slot = action.slots[0]
        channelbag = ensure_channelbag(action, slot)
        channelbag.fcurves.clear()
        return action, slot, channelbag
    action = bpy.data.actions.new(name)
    action[MARK] = True
    slot = action.slots.new(id_type="OBJECT", name=obj.name)
    return action, slot, ensure_channelbag(action, slot)


def is_ours_alone(action: bpy.types.Action) -> bool:
    """Return whether a bake made `action` and it is used in one place only, so that it may be written again."""
    users = action.users - int(action.use_fake_user)
    return bool(action.get(MARK)) and action.is_editable and users == 1 and len(action.slots) == 1


def assign_action(obj: bpy.types.Object, action: bpy.types.Action, slot: Any) -> None:
    """Make `action` the active one of `obj`; the one it had before is kept in the file."""
    data = obj.animation_data_create()
    before = data.action
    if before is not None and before != action and before.users == 1 and before.is_editable:
        before.use_fake_user = True
    data.action = action
    data.action_slot = slot
