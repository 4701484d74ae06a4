"""Which skier the tab shows, among those of the scene."""

from __future__ import annotations

from typing import Any

import bpy

from ..errors import SpecError
from .properties import is_skier


def skier_of(context: Any) -> bpy.types.Object | None:
    """Return the skier that the tab shows: the active object's, else the one chosen in the scene, else the only one."""
    obj = getattr(context, "object", None)
    for _ in range(20):  # a part, a gate's panel or a start object belongs to a skier near by
        if obj is None:
            break
        owner = _owner(obj, context.scene)
        if owner is not None:
            return owner
        obj = obj.parent
    chosen = context.scene.ski_skier
    if chosen is not None and is_skier(None, chosen) and chosen.name in context.scene.objects:
        return chosen
    known = skiers(context.scene)
    return known[0] if len(known) == 1 else None


def settings_of(context: Any) -> Any:
    """Return the settings of the skier that the tab shows; there must be one."""
    return required_skier(context).ski


def skiers(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """Return all skiers of a scene."""
    return [obj for obj in scene.objects if is_skier(None, obj)]


def required_skier(context: Any) -> bpy.types.Object:
    """Return the skier that the tab shows; raises `SpecError` if there is none."""
    skier = skier_of(context)
    if skier is None:
        several = len(skiers(context.scene)) > 1
        hint = "select one, or choose it in the Ski tab" if several else "press Add Skier in the Ski tab"
        raise SpecError("the skier", problem="is not chosen" if several else "is missing", hint=hint)
    return skier


def _owner(obj: bpy.types.Object, scene: bpy.types.Scene) -> bpy.types.Object | None:
    """Return the skier that `obj` is, or whose start or gate it is."""
    if is_skier(None, obj):
        return obj
    for skier in skiers(scene):
        settings = skier.ski
        if settings.start == obj or settings.curve == obj:
            return skier
        if settings.gates is not None and obj.name in settings.gates.all_objects:
            return skier
    return None
