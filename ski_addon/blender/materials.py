"""Materials of skier, equipment and snow: plain node materials that need nothing of this add-on."""

from __future__ import annotations

from dataclasses import dataclass

import bpy


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
"""Look by the material names the pieces of the skier carry."""
PREFIX = "Ski "


def linear_colour(hex_colour: str) -> tuple[float, float, float, float]:
    """Return linear RGBA of an sRGB colour written as six hex digits."""
    channels = [int(hex_colour[i : i + 2], 16) / 255.0 for i in (0, 2, 4)]
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels)
    return red, green, blue, 1.0


def paint_material(name: str) -> bpy.types.Material:
    """Return the material of the palette entry `name`, made on first use and kept after that."""
    return painted(PREFIX + name.replace("_", " "), PALETTE[name])


def painted(name: str, paint: Paint) -> bpy.types.Material:
    """Return the material called `name`, which looks like `paint` where it is made on first use."""
    existing = bpy.data.materials.get(name)
    if existing is not None:
        return existing
    material, shader = new_material(name)
    colour = linear_colour(paint.colour)
    shader.inputs["Base Color"].default_value = colour
    shader.inputs["Roughness"].default_value = paint.roughness
    shader.inputs["Metallic"].default_value = paint.metallic
    shader.inputs["Coat Weight"].default_value = paint.coat
    material.diffuse_color = colour
    material.roughness = paint.roughness
    material.metallic = paint.metallic
    return material


def with_nodes(block: bpy.types.Material | bpy.types.World) -> None:
    """Make a material or world use nodes; from Blender 5.0 on they all do."""
    if bpy.app.version < (5, 0, 0):
        block.use_nodes = True


def new_material(name: str) -> tuple[bpy.types.Material, bpy.types.ShaderNode]:
    """Return a new node material and its Principled shader."""
    material = bpy.data.materials.new(name)
    with_nodes(material)
    shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    return material, shader
