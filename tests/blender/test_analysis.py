"""The report as an image of the .blend: one for each scene, packed, as drawn."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from tests.synthetic_recording import synthetic_recording

SIZE = (400, 300)


@pytest.fixture
def recording(core, scene):
    return synthetic_recording(core("spec").RunSpec(name="Test run"), duration=4.0, gates=2)


def shown(image):
    """The pixels of an image, top row first."""
    values = np.empty(image.size[0] * image.size[1] * 4, dtype=np.float32)
    image.pixels.foreach_get(values)
    return values.reshape(image.size[1], image.size[0], 4)[::-1]


def test_image_shows_the_report_the_right_way_up(core, scene, recording) -> None:
    image = core("blender.analysis").show_report(recording, scene, size=SIZE)
    assert image.name == "Ski report Scene"
    assert tuple(image.size) == SIZE
    np.testing.assert_allclose(shown(image), core("report.plots").draw_report(recording, SIZE), atol=0.5 / 255 + 1e-6)


def test_default_size_is_that_of_the_report(core, scene, recording) -> None:
    assert tuple(core("blender.analysis").show_report(recording, "Run").size) == (1600, 1200)


def test_next_call_draws_the_same_image_anew(core, scene, recording) -> None:
    import bpy

    show = core("blender.analysis").show_report
    first = show(recording, scene, size=SIZE)
    count, pointer = len(bpy.data.images), first.as_pointer()
    first.name = "My plots"  # it is found by whose it is, not by its name
    before = shown(first).copy()
    changed = dataclasses.replace(recording, speed=recording.speed**2)
    again = show(changed, scene, size=SIZE)
    assert again.as_pointer() == pointer and again.name == "My plots"
    assert len(bpy.data.images) == count
    assert np.abs(shown(again) - before).max() > 0.5
    larger = show(changed, scene, size=(480, 360))
    assert larger.as_pointer() == pointer and tuple(larger.size) == (480, 360)


def test_every_scene_has_its_own(core, scene, recording) -> None:
    import bpy

    show = core("blender.analysis").show_report
    other = bpy.data.scenes.new("Other")
    images = [show(recording, place, size=SIZE) for place in (scene, other, "A run")]
    assert [image.name for image in images] == ["Ski report Scene", "Ski report Other", "Ski report A run"]
    assert core("blender.analysis").find_report("Other") == images[1]
    assert core("blender.analysis").find_report("None such") is None


def test_image_survives_saving_and_is_found_after_it(core, scene, recording, tmp_path) -> None:
    import bpy

    show = core("blender.analysis").show_report
    image = show(recording, scene, size=SIZE)
    show(recording, scene, size=SIZE)
    image.use_fake_user = True  # an editor that shows it would be a user
    before = shown(image).copy()
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    image = bpy.data.images["Ski report Scene"]
    assert image.packed_file is not None
    assert tuple(image.size) == SIZE
    np.testing.assert_array_equal(shown(image), before)
    count = len(bpy.data.images)
    assert show(recording, bpy.context.scene, size=SIZE) == image
    assert len(bpy.data.images) == count


def test_image_whose_pixels_are_lost_is_replaced(core, scene, recording) -> None:
    import bpy

    analysis = core("blender.analysis")
    lost = bpy.data.images.new("Lost", 8, 8)
    lost.source, lost.filepath = "FILE", "/nowhere/lost.png"
    lost[analysis.REPORT_PROPERTY] = scene.name
    brush = bpy.data.textures.new("User", "IMAGE")
    brush.image = lost
    image = analysis.show_report(recording, scene, size=SIZE)
    assert brush.image == image and image.name == "Lost"
    assert tuple(image.size) == SIZE


def test_empty_recording_leaves_no_image(core, scene, recording) -> None:
    import bpy

    empty = dataclasses.replace(recording, time=np.zeros(0))
    with pytest.raises(core("errors").RecordingError, match="no steps"):
        core("blender.analysis").show_report(empty, scene)
    assert not [image for image in bpy.data.images if image.name.startswith("Ski report")]
