"""Enabling and disabling the extension."""

from __future__ import annotations

import subprocess
import sys

import pytest

OPERATORS = ("add_skier", "place_gates", "plan", "simulate", "bake", "show_report")


@pytest.mark.parametrize("name", OPERATORS)
def test_operator_is_registered(extension: str, name: str) -> None:
    import bpy

    assert hasattr(bpy.types, f"SKI_OT_{name}"), f"bpy.ops.ski.{name} is missing"


def test_settings_are_on_objects(scene) -> None:
    import bpy

    assert hasattr(bpy.types.Object, "ski")
    assert hasattr(scene, "ski_skier")


def test_disabling_takes_everything_out_and_enabling_brings_it_back(extension: str) -> None:
    import addon_utils
    import bpy

    before = {name for name in dir(bpy.types) if name.startswith("SKI_")}
    assert before
    addon_utils.disable(extension, default_set=True)
    try:
        left = {name for name in dir(bpy.types) if name.startswith("SKI_")}
        assert not left
        assert not hasattr(bpy.types.Object, "ski")
        assert not hasattr(bpy.types.Scene, "ski_skier")
    finally:
        addon_utils.enable(extension, default_set=True)
    assert {name for name in dir(bpy.types) if name.startswith("SKI_")} == before


def test_an_empty_file_keeps_the_extension(scene, extension: str) -> None:
    import bpy

    assert extension in bpy.context.preferences.addons


def test_a_baked_run_plays_without_the_extension(core, extension, scene, tmp_path) -> None:
    """Saved, opened with the extension disabled: keys, meshes and settings are there, and nothing complains."""
    import addon_utils
    import bpy

    bpy.ops.ski.add_skier(preset="beginner_turns")
    bpy.context.object.ski.course.turn_radius = 21.0
    bpy.ops.ski.bake(source="PREVIEW")
    path = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    addon_utils.disable(extension, default_set=True)
    try:
        bpy.ops.wm.open_mainfile(filepath=str(path))
        skier, places = bpy.data.objects["Skier"], []
        for frame in (1, 60, 120):
            bpy.context.scene.frame_set(frame)
            places.append(tuple(skier.matrix_world @ skier.pose.bones["pelvis"].head))
        assert places[0][0] < places[1][0] < places[2][0]
        assert places[0][2] > places[2][2]
        bpy.ops.wm.save_as_mainfile(filepath=str(path))
    finally:
        addon_utils.enable(extension, default_set=True)
    bpy.ops.wm.open_mainfile(filepath=str(path))
    assert bpy.data.objects["Skier"].ski.course.turn_radius == 21.0  # kept all the while


def test_a_file_renamed_between_sessions_finds_its_recording(core, scene, tmp_path) -> None:
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "one.blend"))
    bpy.ops.ski.add_skier(preset="paper_main")
    settings = bpy.context.object.ski
    settings.course.turn_count, settings.course.turn_duration = 1, 0.4
    bpy.ops.ski.simulate()
    bpy.ops.wm.save_mainfile()
    (tmp_path / "one.blend").rename(tmp_path / "other name.blend")
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "other name.blend"))
    assert bpy.ops.ski.bake() == {"FINISHED"}


ENABLE_ALONE = """
import os, sys
import bpy, addon_utils
addon_utils.enable({package!r}, default_set=True)
assert {package!r} in bpy.context.preferences.addons
heavy = [name for name in ("mujoco", "osqp", "scipy", "matplotlib") if name in sys.modules]
print("HEAVY", *heavy)
sys.stdout.flush()
os._exit(0)
"""


def test_enabling_loads_no_heavy_library(extension: str) -> None:
    code = ENABLE_ALONE.format(package=extension)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert "HEAVY" in done.stdout, done.stderr[-2000:]
    assert done.stdout.split("HEAVY", 1)[1].split() == []
