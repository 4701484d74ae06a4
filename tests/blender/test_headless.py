"""A .blend written without a window opens in a Blender that does not know the add-on."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from tests.blender.blender_tools import body_matrices, make_recording

OPEN_PLAIN = """
import json, os, sys
import bpy
bpy.ops.wm.open_mainfile(filepath={path!r}, load_ui=False)
import addon_utils
assert not [name for name in bpy.context.preferences.addons.keys() if "ski_addon" in name]
scene = bpy.context.scene
armature = next(obj for obj in scene.objects if obj.type == "ARMATURE")
scene.frame_set({frame})
evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
bone = armature.data.bones["ski.L"]
world = evaluated.matrix_world @ evaluated.pose.bones["ski.L"].matrix @ bone.matrix_local.inverted()
told = dict(
    fps=scene.render.fps / scene.render.fps_base,
    frames=[scene.frame_start, scene.frame_end],
    camera=scene.camera is not None,
    speed=armature["speed"],
    rotation=[list(row)[:3] for row in world][:3],
    objects=len(scene.objects),
    libraries=len(bpy.data.libraries),
    handlers=len(bpy.app.handlers.frame_change_post) + len(bpy.app.handlers.frame_change_pre),
    scripts=len(bpy.data.texts),
    missing=[image.filepath for image in bpy.data.images if image.filepath],
    drivers=sum(len(o.animation_data.drivers) for o in bpy.data.objects if o.animation_data),
)
print("TOLD" + json.dumps(told))
sys.stdout.flush()
os._exit(0)
"""


@pytest.fixture
def baked(core, scene, tmp_path: Path):
    recording = make_recording(core, **{"bake.fps": 23.976})
    target = tmp_path / "skier.blend"
    core("blender.headless").bake_file(recording, core("blender.bake").recorded_run(recording), target)
    return target, recording


def opened_plainly(path: Path, frame: int, user: Path) -> dict:
    """What a new Blender with factory settings and no add-on finds in the file."""
    environment = {**os.environ, "BLENDER_USER_RESOURCES": str(user)}
    code = OPEN_PLAIN.format(path=str(path), frame=frame)
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=120, env=environment, check=False
    )
    assert "TOLD" in done.stdout, done.stdout[-1000:] + done.stderr[-2000:]
    return json.loads(done.stdout.split("TOLD", 1)[1].splitlines()[0])


def test_the_file_opens_without_the_add_on(core, baked, tmp_path: Path) -> None:
    path, recording = baked
    found = opened_plainly(path, 13, tmp_path / "user")
    assert found["fps"] == pytest.approx(23.976, rel=1e-6)
    assert found["frames"] == [1, 24]
    assert found["camera"]
    assert found["libraries"] == found["handlers"] == found["scripts"] == found["drivers"] == 0
    assert found["missing"] == []
    time = 12 / 23.976
    want = body_matrices(core, recording, time)["ski.L"]
    np.testing.assert_allclose(np.array(found["rotation"]), want[:3, :3], atol=1e-5)
    assert found["speed"] == pytest.approx(6.0 + np.sin(2 * np.pi * time / 3.0) ** 2, rel=1e-4)


def test_the_file_has_slope_tracks_light_and_camera(baked) -> None:
    import bpy

    path, _ = baked
    bpy.ops.wm.open_mainfile(filepath=str(path))
    names = set(bpy.context.scene.objects.keys())
    assert {"Skier", "Skier body", "Skier ski.L", "Skier pole.R", "Slope", "Ski track L", "Ski track R", "Sun"} <= names
    assert bpy.context.scene.world is not None
    slope = bpy.data.objects["Slope"].data
    heights = {(round(v.co.x, 3), round(v.co.z + v.co.x * np.tan(np.radians(10.0)), 3)) for v in slope.vertices}
    assert {z for _, z in heights} == {0.0}


def test_nothing_is_left_beside_the_file(baked) -> None:
    path, _ = baked
    assert [entry.name for entry in path.parent.iterdir() if entry.is_file()] == ["skier.blend"]


def test_a_file_that_cannot_be_written_is_named_and_leaves_nothing(core, scene, tmp_path: Path) -> None:
    recording = make_recording(core, duration=0.1)
    spec = core("blender.bake").recorded_run(recording)
    target = tmp_path / "nowhere" / "skier.blend"
    with pytest.raises(core("errors").OutputError, match=r"skier\.blend"):
        core("blender.headless").bake_file(recording, spec, target)
    assert list(tmp_path.iterdir()) == []


def test_an_older_file_stays_whole_when_baking_fails(core, scene, tmp_path: Path) -> None:
    recording = make_recording(core, duration=0.1)
    target = tmp_path / "skier.blend"
    target.write_bytes(b"old")
    broken = make_recording(core, duration=0.1)
    broken.qpos = broken.qpos[:, :5]
    with pytest.raises(Exception):  # noqa: B017 - whatever it is, the old file stays
        core("blender.headless").bake_file(broken, core("blender.bake").recorded_run(recording), target)
    assert target.read_bytes() == b"old"
    assert [path.name for path in tmp_path.iterdir()] == ["skier.blend"]


@pytest.mark.parametrize("rate", [24.0, 23.976, 29.97, 25.0, 59.94, 120.0, 1.0])
def test_any_rate_can_be_set(core, scene, rate: float) -> None:
    core("blender.headless").set_frame_rate(scene, rate)
    assert core("blender.bake").scene_rate(scene) == pytest.approx(rate, rel=1e-6)
