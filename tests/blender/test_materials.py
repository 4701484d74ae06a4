"""Colours and materials of skier and snow."""

from __future__ import annotations

import pytest


@pytest.fixture
def materials(core, scene):
    return core("blender.materials")


def test_colours_are_linear(materials) -> None:
    assert materials.linear_colour("000000") == (0.0, 0.0, 0.0, 1.0)
    assert materials.linear_colour("ffffff") == pytest.approx((1.0, 1.0, 1.0, 1.0))
    red, green, blue, _ = materials.linear_colour("800a00")
    assert red == pytest.approx(0.2159, abs=1e-4)
    assert green == pytest.approx(10 / 255 / 12.92)
    assert blue == 0.0


def test_every_piece_has_a_paint(core, materials) -> None:
    skeleton = core("body").build_skeleton(core("spec").SkierSpec())
    parts = core("blender.skier.build").build_parts(skeleton)
    used = {material for part in parts.values() for material in part.materials}
    assert used == set(core("blender.skier.paints").PALETTE)


def test_a_material_is_made_once(materials) -> None:
    first = materials.paint_material("jacket")
    assert materials.paint_material("jacket") == first
    assert first.name == "Ski jacket"


def test_a_material_looks_the_same_in_the_viewport(core, materials) -> None:
    paints = core("blender.skier.paints")
    for name, paint in (paints.PALETTE | paints.OTHER_FIGURES).items():
        material = materials.paint_material(name)
        shader = next(node for node in material.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
        assert tuple(material.diffuse_color) == pytest.approx(tuple(shader.inputs["Base Color"].default_value))
        assert material.roughness == pytest.approx(paint.roughness)
        assert shader.inputs["Metallic"].default_value == pytest.approx(paint.metallic)


def test_snow_is_white_and_rough_and_shared(core, scene) -> None:
    slope = core("blender.slope")
    snow = slope.snow_material()
    shader = next(node for node in snow.node_tree.nodes if node.type == "BSDF_PRINCIPLED")
    assert min(tuple(shader.inputs["Base Color"].default_value)[:3]) > 0.8
    assert shader.inputs["Normal"].is_linked
    assert slope.snow_material() == snow


def test_a_material_of_the_user_by_that_name_is_used(core, materials) -> None:
    """So a look that was changed survives the next bake."""
    import bpy

    materials.paint_material("jacket").diffuse_color = (0.1, 0.2, 0.3, 1.0)
    skeleton = core("body").build_skeleton(core("spec").SkierSpec())
    core("blender.rig").build_rig(skeleton, bpy.context.scene)
    assert tuple(bpy.data.materials["Ski jacket"].diffuse_color) == pytest.approx((0.1, 0.2, 0.3, 1.0))
