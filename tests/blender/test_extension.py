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
