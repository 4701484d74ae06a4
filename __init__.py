"""Ski Addon: a Blender extension that makes skiing animation from physics.

This file is imported by Blender and, because the root folder is a package, by pytest as well. It therefore imports
nothing by itself: everything that needs Blender is loaded in `register`.
"""

from __future__ import annotations

from importlib import import_module
from types import ModuleType

# In the order of registration: properties first, then what uses them.
_NAMES = (
    "ski_addon.blender.preferences",
    "ski_addon.blender.properties",
    "operators",
    "ski_addon.blender.panels",
    "ski_addon.blender.live",
    "ski_addon.blender.command_line",
)


def _modules() -> list[ModuleType]:
    """The extension's parts, each with its own `register` and `unregister`."""
    return [import_module("." + name, __package__) for name in _NAMES]


def register() -> None:
    """Add properties, operators and panels to Blender."""
    for module in _modules():
        module.register()


def unregister() -> None:
    """Take everything out of Blender again, last part first."""
    for module in reversed(_modules()):
        module.unregister()
