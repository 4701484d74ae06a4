"""Blender's buttons, one family a file; each is a thin call of the library."""

from __future__ import annotations

import bpy

from . import analyse, bake, bones, course, crowd, plan, preset, rows, simulate, skier

_MODULES = (skier, bones, preset, rows, course, plan, simulate, bake, crowd, analyse)
_CLASSES = tuple(cls for module in _MODULES for cls in module.CLASSES)


def register() -> None:
    """Add the operators."""
    for cls in _CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    """Take the operators away."""
    for cls in reversed(_CLASSES):
        bpy.utils.unregister_class(cls)
