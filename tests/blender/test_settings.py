"""`ski`: the run document as Blender properties, there and back without loss."""

from __future__ import annotations

import math

import pytest


@pytest.fixture
def properties(core, scene):
    return core("blender.properties")


def test_every_preset_goes_in_and_comes_out_the_same(core, ski, properties) -> None:
    specs = properties.preset_specs()
    assert len(specs) >= 8
    for name, spec in specs.items():
        properties.write_spec(ski, spec)
        assert properties.read_spec(ski).to_toml() == spec.to_toml(), name
        assert properties.read_spec(ski).content_hash() == spec.content_hash()


def test_rows_of_a_run_go_in_and_come_out_the_same(core, ski, properties, tmp_path) -> None:
    import bpy

    gates = [{"x": 12.3456789, "y": -3}, {"x": 25, "y": 4, "radius": 12.1, "side": "left"}]
    push = {"body": "ski.R", "direction": "up", "force": 100, "start": 2}
    points = [{"x": i / 7, "y": i / 3} for i in range(3000)]
    spec = core("spec").RunSpec.from_dict({"name": "Gates", "gate": gates, "point": points, "push": [push]})
    properties.write_spec(ski, spec)
    assert properties.read_spec(ski).content_hash() == spec.content_hash()
    path = tmp_path / "gates.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert properties.read_spec(bpy.context.scene.ski_skier.ski).to_toml() == spec.to_toml()


def test_rows_go_when_a_preset_without_rows_is_chosen(core, ski, properties) -> None:
    properties.write_spec(ski, core("spec").RunSpec.from_dict({"gate": [{"x": 1, "y": 2}]}))
    properties.write_spec(ski, properties.preset_specs()["paper_main"])
    assert properties.read_spec(ski) == properties.preset_specs()["paper_main"]


def test_rows_damaged_by_hand_are_refused(core, ski, properties) -> None:
    for text, words in (
        ("[[point]", "the points of this skier is not valid TOML"),
        ("[[point]]\nx = 1", "point 1: y is"),
    ):
        ski.rows = text
        with pytest.raises(core("errors").SpecError, match=words):
            properties.read_spec(ski)


def test_a_new_scene_asks_for_the_shown_preset(core, ski, properties) -> None:
    assert properties.read_spec(ski) == properties.preset_specs()[ski.preset]


def test_every_key_of_the_run_document_has_a_property_with_its_range(core, ski) -> None:
    for key, info in core("spec").field_table().items():
        if not info.section:
            continue
        group = getattr(ski, info.section)
        shown = group.bl_rna.properties[info.name]
        assert shown.name == (info.label or info.name), key
        assert shown.description == info.doc
        if info.kind in ("number", "whole"):
            scale = math.radians(1.0) if info.unit == "deg" else 1.0
            assert shown.hard_min == pytest.approx(info.low * scale, rel=1e-6, abs=1e-6)
            assert shown.hard_max == pytest.approx(info.high * scale, rel=1e-6)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("snow.friction", 0.071),
        ("course.turn_duration", 0.1),
        ("course.turn_radius", 12.3456),
        ("snow.hardness", 1.2e8),
    ],
)
def test_numbers_stay_as_they_were_typed(core, ski, properties, key: str, value: float) -> None:
    section, _, name = key.partition(".")
    setattr(getattr(ski, section), name, value)
    assert core("spec.table").get_value(properties.read_spec(ski), key) == value


@pytest.mark.parametrize("degrees", [0.0, 5.0, 8.0, 10.0, 12.5, 33.3, 45.0])
def test_angles_are_radians_in_blender_and_degrees_in_the_document(core, ski, properties, degrees: float) -> None:
    ski.slope.angle_deg = math.radians(degrees)
    assert properties.read_spec(ski).slope.angle_deg == degrees


def test_a_word_can_be_switched_on_and_off(core, ski, properties) -> None:
    properties.write_spec(ski, properties.preset_specs()["paper_main"])
    skier = ski.skier
    assert properties.read_spec(ski).skier.ski_length == "auto"
    skier.ski_length_word = False
    skier.ski_length = 1.65
    assert properties.read_spec(ski).skier.ski_length == 1.65


def test_out_of_range_is_held_at_the_range(core, ski, properties) -> None:
    ski.skier.height = 9.0
    ski.slope.angle_deg = math.radians(80.0)
    spec = properties.read_spec(ski)
    assert (spec.skier.height, spec.slope.angle_deg) == (2.1, 45.0)


def test_settings_are_saved_with_the_file(core, ski, properties, tmp_path) -> None:
    import bpy

    ski.course.turn_radius = 23.0
    path = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert properties.read_spec(bpy.context.scene.ski_skier.ski).course.turn_radius == 23.0


def test_a_file_beside_the_blend_file_is_found_by_the_run(core, ski, properties, tmp_path) -> None:
    """Blender's file browser writes paths relative to the saved file, with two slashes in front."""
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    settings = bpy.context.scene.ski_skier.ski
    assert settings.slope.bl_rna.properties["grid_file"].subtype == "FILE_PATH"
    settings.slope.grid_file = "//grounds/hill.npz"
    assert properties.read_spec(settings).slope.grid_file == str(tmp_path / "grounds" / "hill.npz")
    for untouched in ("/data/hill.npz", "rolling_hill", ""):
        settings.slope.grid_file = untouched
        assert properties.read_spec(settings).slope.grid_file == untouched
