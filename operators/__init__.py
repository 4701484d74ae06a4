"""Blender's buttons, one family a file; each is a thin call of the library."""

from __future__ import annotations

import bpy

from .bake import SKI_OT_bake
from .plan import SKI_OT_plan
from .preset import SKI_OT_reset_to_preset
from .simulate import SKI_OT_simulate

_CLASSES = (SKI_OT_plan, SKI_OT_simulate, SKI_OT_bake, SKI_OT_reset_to_preset)


def register() -> None:
    """Add the operators."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Take the operators away."""
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
