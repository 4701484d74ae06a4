"""Materials of skier, equipment and snow: plain node materials that need nothing of this add-on."""

from __future__ import annotations

import bpy

from .skier.paints import Paint, paint_of

PREFIX = "Ski "


def linear_colour(hex_colour: str) -> tuple[float, float, float, float]:
    """Return linear RGBA of an sRGB colour written as six hex digits."""
    channels = [int(hex_colour[i : i + 2], 16) / 255.0 for i in (0, 2, 4)]
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in channels)
    return red, green, blue, 1.0


def paint_material(name: str) -> bpy.types.Material:
    """Return the material of the paint `name`, made on first use and kept after that."""
    return painted(PREFIX + name.replace("_", " "), paint_of(name))


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
