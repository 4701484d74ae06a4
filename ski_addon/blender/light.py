"""Low sun and a clear sky."""

from __future__ import annotations

import math

import bpy
from mathutils import Vector

from .materials import linear_colour, with_nodes

SKY = ((0.0, "eae6de"), (0.06, "c6dcf2"), (0.25, "78ade6"), (0.75, "2f69c0"))
"""Colours from the horizon upwards, by the sine of the height."""
SKY_STRENGTH = 0.7
SUN_COLOUR = (1.0, 0.90, 0.76)
SUN_STRENGTH = 4.2


def build_sun(
    collection: bpy.types.Collection, azimuth_deg: float = 120.0, height_deg: float = 24.0
) -> bpy.types.Object:
    """Return a new sun that stands `height_deg` over the horizon; azimuth 0 is +x (downhill), 90 is +y."""
    azimuth, height = math.radians(azimuth_deg), math.radians(height_deg)
    towards = Vector((math.cos(azimuth) * math.cos(height), math.sin(azimuth) * math.cos(height), math.sin(height)))
    light = bpy.data.lights.new("Sun", "SUN")
    light.energy = SUN_STRENGTH
    light.angle = math.radians(0.8)
    light.color = SUN_COLOUR
    sun = bpy.data.objects.new("Sun", light)
    sun.rotation_euler = towards.to_track_quat("Z", "Y").to_euler()
    collection.objects.link(sun)
    return sun


def build_sky(scene: bpy.types.Scene) -> bpy.types.World:
    """Give `scene` a new world: a clear sky as a gradient from horizon to zenith."""
    world = bpy.data.worlds.new("Ski sky")
    with_nodes(world)
    tree = world.node_tree
    background = next(node for node in tree.nodes if node.type == "BACKGROUND")
    place = tree.nodes.new("ShaderNodeTexCoord")
    split = tree.nodes.new("ShaderNodeSeparateXYZ")
    ramp = tree.nodes.new("ShaderNodeValToRGB")
    elements = ramp.color_ramp.elements
    while len(elements) < len(SKY):
        elements.new(1.0)
    for element, (height, colour) in zip(elements, SKY, strict=True):
        element.position = height
        element.color = linear_colour(colour)
    tree.links.new(place.outputs["Generated"], split.inputs["Vector"])
    tree.links.new(split.outputs["Z"], ramp.inputs["Fac"])
    tree.links.new(ramp.outputs["Color"], background.inputs["Color"])
    background.inputs["Strength"].default_value = SKY_STRENGTH
    world.color = linear_colour(SKY[1][1])[:3]
    if hasattr(world, "cycles"):  # a smooth sky needs no fine map of where its light comes from
        world.cycles.sampling_method = "MANUAL"
        world.cycles.sample_map_resolution = 128
    scene.world = world
    return world
