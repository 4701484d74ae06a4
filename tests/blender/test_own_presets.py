"""The user's own presets beside the shipped ones: kept, applied, replaced, removed, never executed."""

from __future__ import annotations

import pytest


@pytest.fixture
def presets(core, scene, tmp_path, monkeypatch):
    module = core("blender.own_presets")
    monkeypatch.setattr(module, "own_folder", lambda kind: tmp_path / kind)
    return module


@pytest.mark.parametrize("kind", ["runs", "courses", "skiers", "snow", "styles"])
def test_what_is_saved_comes_back(core, ski, presets, kind) -> None:
    import bpy

    properties = core("blender.properties")
    before = properties.preset_specs()["s_curve"].with_part(presets.find_preset("snow", "icy").path)
    properties.write_spec(ski, before)
    assert bpy.ops.ski.save_preset(kind=kind, name="Mine, all mine") == {"FINISHED"}
    (own,) = presets.own_presets(kind)
    assert (own.identifier, own.name) == ("own/mine_all_mine", "Mine, all mine")
    properties.write_spec(ski, properties.preset_specs()["slalom"])
    assert bpy.ops.ski.apply_preset(kind=kind, preset=own.identifier) == {"FINISHED"}
    after = properties.read_spec(ski)
    for section in {"runs": (*core("spec").SECTIONS, "point")}.get(kind, presets.SECTIONS_OF.get(kind, ())):
        assert getattr(after, section) == getattr(before, section), section


def test_saving_again_replaces_it(ski, presets) -> None:
    import bpy

    bpy.ops.ski.save_preset(kind="snow", name="Mine")
    ski.snow.friction = 0.12
    bpy.ops.ski.save_preset(kind="snow", name="Mine")
    (own,) = presets.own_presets("snow")
    assert "friction = 0.12" in own.path.read_text(encoding="utf-8")


def test_it_can_be_removed(ski, presets) -> None:
    import bpy

    bpy.ops.ski.save_preset(kind="styles", name="Mine")
    assert bpy.ops.ski.remove_preset(kind="styles", preset="own/mine") == {"FINISHED"}
    assert presets.own_presets("styles") == ()
    with pytest.raises(RuntimeError, match="there is no such preset"):
        bpy.ops.ski.remove_preset(kind="styles", preset="own/mine")


def test_a_shipped_one_stays(ski, presets) -> None:
    import bpy

    with pytest.raises(RuntimeError, match="only your own presets can be removed"):
        bpy.ops.ski.remove_preset(kind="snow", preset="icy")
    assert presets.find_preset("snow", "icy").path.is_file()


def test_a_name_without_letters_is_refused(ski, presets) -> None:
    import bpy

    with pytest.raises(RuntimeError, match="give the preset another name"):
        bpy.ops.ski.save_preset(kind="snow", name=" ?! ")


def test_a_damaged_file_is_left_out_of_the_menu_and_changes_nothing(core, ski, presets, tmp_path) -> None:
    import bpy

    (tmp_path / "snow").mkdir()
    (tmp_path / "snow" / "broken.toml").write_text("friction = = 1")
    (tmp_path / "snow" / "odd.toml").write_text('name = "Odd"\n[snow]\nfriction = 7\n')
    assert [preset.identifier for preset in presets.own_presets("snow")] == ["own/odd"]
    before = core("blender.properties").read_spec(ski)
    with pytest.raises(RuntimeError, match=r"odd\.toml line 3: snow\.friction = 7"):
        bpy.ops.ski.apply_preset(kind="snow", preset="own/odd")
    assert core("blender.properties").read_spec(ski) == before


def test_a_folder_that_takes_no_files_is_named(ski, presets, tmp_path) -> None:
    import bpy

    (tmp_path / "snow").write_text("in the way")
    with pytest.raises(RuntimeError, match="snow"):
        bpy.ops.ski.save_preset(kind="snow", name="Mine")
