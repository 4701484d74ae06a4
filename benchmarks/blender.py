"""Blender's share: `python -m benchmarks.blender` prints how long enabling the add-on and baking take.

Needs Blender's Python module. Enabling is timed in new processes, in turn with an empty extension, and the difference
counts; a run of ten seconds is baked at 60 frames a second onto a skier that is there already.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
ROUNDS = 7
MANIFEST = """schema_version = "1.0.0"
id = "empty"
version = "0.1.0"
name = "Empty"
tagline = "Nothing at all"
maintainer = "Nobody"
type = "add-on"
blender_version_min = "4.5.0"
license = ["SPDX:GPL-3.0-or-later"]
"""
ENABLE = """
import os, sys, time
import bpy, addon_utils
begin = time.perf_counter()
addon_utils.enable("bl_ext.user_default." + sys.argv[1], default_set=True)
print("SECONDS", time.perf_counter() - begin)
sys.stdout.flush()
os._exit(0)
"""
BAKE_SECONDS, RATE = 10.0, 60


def user_folder() -> Path:
    """Return a new user folder of Blender with this add-on and an empty one in it."""
    folder = Path(tempfile.mkdtemp(prefix="ski_addon_benchmark_"))
    extensions = folder / "extensions" / "user_default"
    (extensions / "empty").mkdir(parents=True)
    (extensions / "empty" / "__init__.py").write_text("def register(): pass\ndef unregister(): pass\n")
    (extensions / "empty" / "blender_manifest.toml").write_text(MANIFEST)
    (extensions / "ski_addon").symlink_to(ROOT, target_is_directory=True)
    return folder


def enabling(name: str, folder: Path) -> float:
    """Return how long enabling an extension takes in a new process [s]."""
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(folder)}
    command = [sys.executable, "-c", ENABLE, name]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=True)
    return float(done.stdout.split("SECONDS")[1].split()[0])


def baking() -> tuple[float, int]:
    """Return how long the bake of a run takes [s], and its number of frames."""
    import bpy

    from ski_addon.blender.bake import bake_recording
    from ski_addon.body import build_skeleton
    from ski_addon.spec import RunSpec
    from tests.synthetic_motion import synthetic_motion

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.fps = RATE
    spec = RunSpec()
    recording = synthetic_motion(build_skeleton(spec.skier), spec, duration=BAKE_SECONDS)
    armature = bake_recording(recording, scene).armature
    seconds = []
    for _ in range(ROUNDS):
        begin = time.perf_counter()
        result = bake_recording(recording, scene, armature=armature)
        seconds.append(time.perf_counter() - begin)
    return float(np.median(seconds)), int(result.frame_last - result.frame_first + 1)


def main() -> None:
    """Print the figures."""
    folder = user_folder()
    for name in ("empty", "ski_addon"):
        enabling(name, folder)  # compiled files and Blender's own list of extensions are made once
    pairs = np.array([(enabling("empty", folder), enabling("ski_addon", folder)) for _ in range(ROUNDS)])
    empty, ours = 1e3 * np.median(pairs, axis=0)
    more = 1e3 * float(np.median(pairs[:, 1] - pairs[:, 0]))
    print(f"enabling: {ours:.0f} ms, an empty one {empty:.0f} ms, more {more:.0f} ms")
    seconds, frames = baking()
    print(f"bake: {frames} frames of a run of {BAKE_SECONDS:g} s at {RATE} fps in {seconds:.2f} s")
    sys.stdout.flush()
    os._exit(0)  # Blender's module may hang when Python shuts down


if __name__ == "__main__":
    main()
