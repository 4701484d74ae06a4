"""Bone maps of foreign armatures: shipped ones, names with a prefix, and what a bad one is answered."""

from __future__ import annotations

import textwrap
import tomllib

import pytest

from ski_addon.animation.bone_map import BoneEntry, BoneMap, BoneSetting
from ski_addon.animation.target import REQUIRED, main_bones
from ski_addon.body.skeleton import BODY_NAMES
from ski_addon.errors import SpecError
from ski_addon.spec import find_document

MAPS = find_document("giant_slalom").parents[1] / "bone_maps"
SHIPPED = ("skier", "rigify_metarig", "rigify_rig", "mixamo", "unreal_mannequin")


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_maps_have_what_a_figure_needs(name: str) -> None:
    bone_map = BoneMap.load(MAPS / f"{name}.toml")
    bone_map.check(bone_map.bones, BODY_NAMES)
    assert set(REQUIRED) <= set(main_bones(bone_map))
    sides = [entry for entry in bone_map.entries if entry.body.endswith(".L")]
    assert len(sides) == len([entry for entry in bone_map.entries if entry.body.endswith(".R")])
    carriers = {entry.parent for entry in bone_map.entries} - {"", bone_map.root}
    assert carriers <= set(bone_map.bones)


def test_the_folder_has_no_other_maps() -> None:
    assert sorted(path.stem for path in MAPS.glob("*.toml")) == sorted(SHIPPED)


def test_details_of_an_entry_are_read() -> None:
    document = {
        "name": "Mine",
        "root": "master",
        "bones": {"back": {"body": "chest", "share": 1, "parent": "hip", "optional": True}},
        "settings": {"arm": {"IK_FK": 1, "follow": False}},
    }
    bone_map = BoneMap.from_document(document)
    assert bone_map.entries == (BoneEntry("back", "chest", False, 1, "hip", True),)
    assert bone_map.root == "master"
    assert bone_map.settings == (BoneSetting("arm", "IK_FK", 1.0), BoneSetting("arm", "follow", 0.0))


@pytest.mark.parametrize("prefix", ["", "mixamorig:", "mixamorig7:"])
def test_bones_may_have_a_prefix(prefix: str) -> None:
    bone_map = BoneMap.load(MAPS / "mixamo.toml")
    there = [prefix + bone for bone in bone_map.bones if bone != "LeftHand"]
    resolved, missing = bone_map.resolved(there)
    assert missing == ("LeftHand",)
    assert resolved.bones == tuple(there)


def test_missing_carriers_and_switches_are_named_and_optional_bones_are_not() -> None:
    bone_map = BoneMap.load(MAPS / "rigify_rig.toml")
    there = [bone for bone in bone_map.bones if bone not in ("chest", "toe_fk.L")]
    _, missing = bone_map.resolved([*there, "root"])
    assert set(missing) == {"chest", "thigh_parent.L", "thigh_parent.R", "upper_arm_parent.L", "upper_arm_parent.R"}


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("colour = 1\n[bones]\na = 'pelvis'", "colour is not one of"),
        ("root = 3\n[bones]\na = 'pelvis'", "root = 3 is not a name"),
        ("[bones]\na = { share = 0.5 }", r"bones\.a"),
        ("[bones]\na = { body = 'pelvis', share = 2 }", r"bones\.a\.share = 2 is outside 0\.\.1"),
        ("[bones]\na = { body = 'pelvis', share = true }", r"bones\.a\.share = True is not a number"),
        ("[bones]\na = { body = 'pelvis', location = 1 }", r"bones\.a\.location = 1 is not true or false"),
        ("[bones]\na = { body = 'pelvis', parent = 1 }", r"bones\.a\.parent = 1 is not a name"),
        ("settings = 1\n[bones]\na = 'pelvis'", "settings = 1"),
        ("[bones]\na = 'pelvis'\n[settings]\nb = 1", r"settings\.b = 1 is not a table"),
        ("[bones]\na = 'pelvis'\n[settings.b]\nIK = 'yes'", r'settings\.b\.IK = "yes" is not a number'),
    ],
)
def test_a_bad_map_says_what_is_wrong(tmp_path, text: str, named: str) -> None:
    path = tmp_path / "map.toml"
    path.write_text(text)
    with pytest.raises(SpecError, match=named):
        BoneMap.load(path)


def test_the_example_on_the_page_is_a_bone_map() -> None:
    page = (MAPS.parents[1] / "docs" / "baking.md").read_text(encoding="utf-8")
    block = page[page.index('    name = "My rig"') :].partition("\n\nPelvis, thighs")[0]
    bone_map = BoneMap.from_document(tomllib.loads(textwrap.dedent(block)))
    assert bone_map.root == "root"
    assert {entry.bone: entry.share for entry in bone_map.entries}["spine1"] == 0.5
    assert bone_map.settings == (BoneSetting("leg.L", "IK_FK", 1.0),)


@pytest.mark.parametrize("path", sorted(MAPS.glob("*.toml")), ids=lambda path: path.stem)
def test_a_shipped_map_is_written_and_read_again(path, tmp_path):
    whole = BoneMap.load(path)
    copy = tmp_path / "copy.toml"
    copy.write_text(whole.to_toml(), encoding="utf-8")
    assert BoneMap.load(copy) == whole
