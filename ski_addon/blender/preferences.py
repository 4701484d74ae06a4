"""The add-on's preferences: expert mode, the folder of recordings, colours of the preview."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import bpy

PACKAGE = (__package__ or "").rpartition(".ski_addon.blender")[0]


class SKI_AP_preferences(bpy.types.AddonPreferences):
    """What holds for all files."""

    bl_idname = PACKAGE or "ski_addon"

    expert: bpy.props.BoolProperty(
        name="Expert Mode",
        description="Show the fields that few need: masses of the gear, snow strength, comparison with the papers",
    )
    cache_folder: bpy.props.StringProperty(
        name="Recordings",
        description="Folder for the recordings of files that are not saved yet; empty = the add-on's own",
        subtype="DIR_PATH",
    )
    slow: bpy.props.FloatVectorProperty(
        name="Slowest",
        description="Colour of the slowest part of a track",
        subtype="COLOR",
        size=3,
        min=0.0,
        max=1.0,
        default=(0.16, 0.36, 0.72),
    )
    fast: bpy.props.FloatVectorProperty(
        name="Fastest",
        description="Colour of the fastest part of a track",
        subtype="COLOR",
        size=3,
        min=0.0,
        max=1.0,
        default=(0.95, 0.80, 0.25),
    )
    refused: bpy.props.FloatVectorProperty(
        name="Cannot Be Skied", description="Colour of places that cannot be skied", subtype="COLOR", size=3, min=0.0,
        max=1.0, default=(0.90, 0.10, 0.12),
    )  # fmt: skip

    def draw(self, _context: bpy.types.Context) -> None:
        """Draw them."""
        layout = self.layout
        layout.use_property_split = True
        for name in ("expert", "cache_folder", "slow", "fast", "refused"):
            layout.prop(self, name)


def preferences() -> Any:
    """Return the preferences, or None where the library runs without being installed as an extension."""
    addon = bpy.context.preferences.addons.get(PACKAGE)
    return None if addon is None else addon.preferences


def user_folder(name: str) -> Path:
    """Return the add-on's folder `name` among the user's own; it may not be there yet.

    Where the library runs without being installed as an extension it is a temporary one.
    """
    try:
        return Path(bpy.utils.extension_path_user(PACKAGE, path=name))
    except ValueError:
        return Path(tempfile.gettempdir()) / "ski_addon" / name


def is_expert(_context: Any) -> bool:
    """Return whether fields for experts are shown."""
    known = preferences()
    return known is not None and known.expert


def register() -> None:
    """Add the preferences."""
    bpy.utils.register_class(SKI_AP_preferences)


def unregister() -> None:
    """Take them away."""
    bpy.utils.unregister_class(SKI_AP_preferences)
