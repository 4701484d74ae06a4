"""Colours and gloss of clothes and gear, by the material names that pieces carry. No bpy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Paint:
    """Look of one material: sRGB `colour` as hex, `roughness`, `metallic` and `coat` 0..1."""

    colour: str
    roughness: float = 0.6
    metallic: float = 0.0
    coat: float = 0.0


PALETTE: dict[str, Paint] = {
    "jacket": Paint("d23b26", 0.62),
    "jacket_yoke": Paint("1d2b45", 0.62),
    "jacket_accent": Paint("f1e9da", 0.60),
    "jacket_trim": Paint("16203a", 0.65),
    "trousers": Paint("243352", 0.66),
    "trousers_stripe": Paint("d23b26", 0.62),
    "trousers_trim": Paint("11182a", 0.70),
    "helmet": Paint("eceae4", 0.22, coat=0.6),
    "helmet_stripe": Paint("d23b26", 0.25, coat=0.6),
    "helmet_trim": Paint("1b1f27", 0.45),
    "goggles_lens": Paint("e08a1e", 0.08, metallic=0.85, coat=1.0),
    "goggles_frame": Paint("14161b", 0.35),
    "goggles_strap": Paint("20242d", 0.75),
    "skin": Paint("d9a184", 0.55),
    "gloves": Paint("1c1f26", 0.60),
    "gloves_cuff": Paint("d23b26", 0.62),
    "boots": Paint("e3e1db", 0.28, coat=0.3),
    "boots_trim": Paint("23304c", 0.40),
    "boots_sole": Paint("17191e", 0.70),
    "buckles": Paint("b9bec6", 0.25, metallic=0.9),
    "skis": Paint("f0b429", 0.22, coat=0.7),
    "skis_accent": Paint("1d2b45", 0.22, coat=0.7),
    "skis_stripe": Paint("fbf7ec", 0.22, coat=0.7),
    "skis_base": Paint("101216", 0.35),
    "skis_edge": Paint("8d949d", 0.30, metallic=0.8),
    "bindings": Paint("1a1c21", 0.40),
    "bindings_accent": Paint("d23b26", 0.35),
    "poles": Paint("2b2f37", 0.30, metallic=0.5),
    "poles_accent": Paint("e9e5da", 0.40),
    "poles_grip": Paint("15171b", 0.60),
}
"""Look of the alpine skier by material name; other figures share what they have alike."""

OTHER_FIGURES: dict[str, Paint] = {
    "snowboard_jacket": Paint("2f7f86", 0.66),
    "snowboard_jacket_yoke": Paint("e9a13b", 0.64),
    "snowboard_jacket_accent": Paint("f3ead8", 0.62),
    "snowboard_jacket_trim": Paint("1c3d44", 0.68),
    "snowboard_trousers": Paint("5d5145", 0.72),
    "snowboard_trousers_stripe": Paint("5d5145", 0.72),
    "snowboard_trousers_trim": Paint("3a332c", 0.72),
    "snowboard_helmet": Paint("22262b", 0.40, coat=0.2),
    "snowboard_helmet_stripe": Paint("2b3036", 0.40, coat=0.2),
    "snowboard_goggles_lens": Paint("4b86c8", 0.08, metallic=0.85, coat=1.0),
    "snowboard_goggles_strap": Paint("e9a13b", 0.70),
    "snowboard_gloves_cuff": Paint("5d5145", 0.65),
    "soft_boots": Paint("3b3f46", 0.70),
    "soft_boots_trim": Paint("e9a13b", 0.60),
    "soft_boots_sole": Paint("d8d2c4", 0.75),
    "laces": Paint("f3ead8", 0.70),
    "board": Paint("e2552e", 0.25, coat=0.6),
    "board_accent": Paint("f3ead8", 0.25, coat=0.6),
    "board_stripe": Paint("1c3d44", 0.25, coat=0.6),
    "telemark_jacket": Paint("4f7f3f", 0.66),
    "telemark_jacket_yoke": Paint("3b4a33", 0.66),
    "telemark_jacket_accent": Paint("e8dfc8", 0.64),
    "telemark_jacket_trim": Paint("28331f", 0.68),
    "telemark_trousers": Paint("3d3f44", 0.70),
    "telemark_trousers_stripe": Paint("6b6f76", 0.70),
    "telemark_trousers_trim": Paint("26282c", 0.72),
    "telemark_helmet": Paint("d7c9a3", 0.35, coat=0.3),
    "telemark_helmet_stripe": Paint("4f7f3f", 0.35, coat=0.3),
    "telemark_goggles_lens": Paint("7f5a2a", 0.08, metallic=0.8, coat=1.0),
    "telemark_gloves": Paint("7a5636", 0.65),
    "telemark_gloves_cuff": Paint("28331f", 0.65),
    "telemark_boots": Paint("4a5561", 0.35, coat=0.2),
    "telemark_boots_trim": Paint("c98b2e", 0.40),
    "telemark_skis": Paint("8fb7c9", 0.24, coat=0.7),
    "telemark_skis_accent": Paint("28425a", 0.24, coat=0.7),
    "telemark_skis_stripe": Paint("f3ead8", 0.24, coat=0.7),
    "telemark_bindings_accent": Paint("c98b2e", 0.35),
    "bellows": Paint("20242a", 0.60),
    "cable": Paint("9aa1a9", 0.30, metallic=0.9),
    "bicycle_jacket": Paint("f2c230", 0.60),
    "bicycle_jacket_accent": Paint("20242b", 0.60),
    "bicycle_jacket_trim": Paint("20242b", 0.62),
    "bicycle_trousers": Paint("20242b", 0.55),
    "bicycle_trousers_stripe": Paint("f2c230", 0.58),
    "bicycle_helmet": Paint("f3f1ec", 0.25, coat=0.6),
    "bicycle_helmet_trim": Paint("1b1f27", 0.55),
    "bicycle_goggles_lens": Paint("2a2e35", 0.06, metallic=0.7, coat=1.0),
    "bicycle_goggles_frame": Paint("d23b26", 0.30),
    "bicycle_gloves": Paint("20242b", 0.62),
    "bicycle_gloves_cuff": Paint("20242b", 0.62),
    "socks": Paint("f3f1ec", 0.75),
    "shoes": Paint("f3f1ec", 0.30, coat=0.3),
    "shoes_trim": Paint("20242b", 0.45),
    "shoes_sole": Paint("17191e", 0.60),
    "bicycle_frame": Paint("1f5fae", 0.20, metallic=0.2, coat=0.8),
    "bicycle_frame_accent": Paint("f3f1ec", 0.22, coat=0.8),
    "bicycle_parts": Paint("1a1c21", 0.38),
    "bicycle_metal": Paint("b9bec6", 0.25, metallic=0.9),
    "saddle": Paint("1a1a1c", 0.55),
    "grips": Paint("17181b", 0.75),
    "tyres": Paint("17181a", 0.80),
    "tyre_walls": Paint("8a6a45", 0.75),
}
"""What other figures wear and ride; `dressed_for` finds `KIND_NAME` here."""


def paint_of(name: str) -> Paint:
    """Return the paint of a material name."""
    return OTHER_FIGURES[name] if name in OTHER_FIGURES else PALETTE[name]


def dressed_for(kind: str, materials: Sequence[str]) -> list[str]:
    """Return `materials` as a figure of `kind` wears them: the kind's own paint where the palette has one."""
    return [own if (own := f"{kind}_{name}") in OTHER_FIGURES else name for name in materials]
