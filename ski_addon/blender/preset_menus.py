"""Menus of presets in the panels' headers: the shipped ones, then the user's own, to save and to remove."""

from __future__ import annotations

from typing import Any

import bpy

from ..spec import PRESET_KINDS
from .own_presets import OWN, all_presets, own_presets, shipped_presets

MENU = "SKI_MT_{}_presets"
TITLES = {"runs": "Runs", "courses": "Courses", "skiers": "Skiers", "snow": "Snow", "styles": "Styles"}


def menu_name(kind: str) -> str:
    """Return the identifier of the menu of a kind of presets."""
    return MENU.format(kind)


def draw_menu_button(layout: Any, kind: str, text: str = "") -> None:
    """Draw the button that opens the menu of a kind of presets."""
    layout.menu(menu_name(kind), text=text, icon="PRESET")


def _draw_menu(self: Any, _context: Any) -> None:
    layout, kind = self.layout, self.kind
    for preset in shipped_presets(kind):
        _entry(layout, kind, preset.identifier, preset.name)
    own = own_presets(kind)
    layout.separator()
    for preset in own:
        row = layout.row(align=True)
        _entry(row, kind, preset.identifier, preset.name)
    layout.operator("ski.save_preset", text="Save as Preset...", icon="ADD").kind = kind
    if own:
        layout.menu(menu_name(kind) + "_remove", text="Remove", icon="REMOVE")


def _draw_removal(self: Any, _context: Any) -> None:
    for preset in own_presets(self.kind):
        button = self.layout.operator("ski.remove_preset", text=preset.name)
        button.kind, button.preset = self.kind, preset.identifier


def _entry(layout: Any, kind: str, identifier: str, name: str) -> None:
    icon = "USER" if identifier.startswith(OWN) else "NONE"
    button = layout.operator("ski.apply_preset", text=name, icon=icon)
    button.kind, button.preset = kind, identifier


def _draw_start_menu(self: Any, _context: Any) -> None:
    for preset in all_presets("runs"):
        self.layout.operator("ski.add_skier", text=preset.name).preset = preset.identifier


def _menu(name: str, label: str, draw: Any, kind: str = "") -> type:
    content = {"__doc__": f"{label}.", "bl_idname": name, "bl_label": label, "draw": draw, "kind": kind}
    return type(name, (bpy.types.Menu,), content)


CLASSES = (
    *(_menu(menu_name(kind), TITLES[kind], _draw_menu, kind) for kind in PRESET_KINDS),
    *(_menu(menu_name(kind) + "_remove", f"Remove {TITLES[kind]}", _draw_removal, kind) for kind in PRESET_KINDS),
    _menu("SKI_MT_add_skier", "Add Skier with Run", _draw_start_menu),
)
