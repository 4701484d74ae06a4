"""Blender's share: `python -m benchmarks.blender` prints how long enabling the add-on and baking take.

Needs Blender's Python module. Enabling is timed in new processes, in turn with an empty extension, and the difference
counts; a run of ten seconds is baked at 60 frames a second onto a skier that is there already, beside the same number
of keys written into curves by Blender alone.
"""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measuring import ROOT, How, Measurement, NotMeasuredError, Samples, in_turn

SUBJECT = "bake"
ROUNDS = 7
TIMEOUT = 120.0
"""Seconds for a Blender that bakes."""
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
import gc, os, sys, time
import bpy, addon_utils
gc.collect()  # else Blender's own rubbish is collected while some extension is enabled, or is not
begin, used = time.perf_counter(), time.process_time()
addon_utils.enable("bl_ext.user_default." + sys.argv[1], default_set=True)
print("SECONDS", time.perf_counter() - begin, time.process_time() - used)
sys.stdout.flush()
os._exit(0)
"""
BAKE_SECONDS, RATE = 10.0, 60


def user_folder(name: str) -> Path:
    """Return a new user folder of Blender with one extension: "ski_addon", or "empty"."""
    folder = Path(tempfile.mkdtemp(prefix="ski_addon_benchmark_"))
    extensions = folder / "extensions" / "user_default"
    extensions.mkdir(parents=True)
    if name == "ski_addon":
        (extensions / name).symlink_to(ROOT, target_is_directory=True)
        return folder
    (extensions / name).mkdir()
    (extensions / name / "__init__.py").write_text("def register(): pass\ndef unregister(): pass\n")
    (extensions / name / "blender_manifest.toml").write_text(MANIFEST)
    return folder


def enabling(name: str, folder: Path) -> tuple[float, float]:
    """Return the time that enabling a compiled extension takes in a new process, and of the processor [s]."""
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(folder), "PYTHONPYCACHEPREFIX": str(folder / "compiled")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    command = [sys.executable, "-c", ENABLE, name]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=120, check=True)
    words = done.stdout.split("SECONDS")[1].split()
    return float(words[0]), float(words[1])


def bake_work() -> tuple[Callable[[], Any], Callable[[], Any], int, int]:
    """Return what bakes a run again, what writes as many keys plainly, the number of frames and that of keys."""
    import bpy

    from ski_addon.blender.bake import bake_recording
    from ski_addon.body import build_skeleton
    from ski_addon.spec import RunSpec
    from tests.synthetic_motion import synthetic_motion

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.render.fps = RATE
    spec = RunSpec()
    recording: Any = synthetic_motion(build_skeleton(spec.skier), spec, duration=BAKE_SECONDS)
    result = bake_recording(recording, scene)
    armature, slot = result.armature, result.armature.animation_data.action_slot
    curves = result.action.layers[0].strips[0].channelbag(slot).fcurves
    count, frames = len(curves), int(result.frame_last - result.frame_first + 1)
    return (
        lambda: bake_recording(recording, scene, armature=armature),
        plain_keys(count, frames),
        frames,
        count * frames,
    )


def plain_keys(count: int, frames: int) -> Callable[[], Any]:
    """Return what writes `count` curves of `frames` keys each into a new action, as quickly as Blender lets us."""
    import bpy

    keys = np.empty((frames, 2), dtype=np.float32)
    keys[:, 0] = np.arange(frames)
    keys[:, 1] = np.sin(keys[:, 0])
    flat = keys.ravel()

    def write() -> None:
        action = bpy.data.actions.new("plain")
        bag = (
            action.layers.new("Layer")
            .strips.new(type="KEYFRAME")
            .channelbag(action.slots.new(id_type="OBJECT", name="plain"), ensure=True)
        )
        for index in range(count):
            curve = bag.fcurves.new("location", index=index)
            curve.keyframe_points.add(frames)
            curve.keyframe_points.foreach_set("co", flat)
            curve.update()
        bpy.data.actions.remove(action)

    return write


def baked(rounds: int) -> tuple[dict[str, Samples], int, int]:
    """Return the samples of `bake` and of `plain` keys, the number of frames and that of keys."""
    bake, plain, frames, keys = bake_work()
    return in_turn({"bake": bake, "plain": plain}, rounds), frames, keys


def bake_rows(rounds: int) -> list[Measurement]:
    """Return the rows of a bake; runs in Blender's Python."""
    samples, frames, keys = baked(rounds)
    ours, theirs = samples["bake"], samples["plain"]
    more = {"peer": "foreach_set", "peer_ratio": ours.over(theirs)}
    return [
        ours.row(SUBJECT, "each key", "us", 1.0 / keys, **more),
        ours.row(SUBJECT, "each frame", "us", 1.0 / frames, checked=False),
        ours.row(SUBJECT, "all of it", "ms"),
    ]


def measurements(how: How) -> list[Measurement]:
    """Return the rows of a bake, made in a Python of its own: Blender's module may hang when Python shuts down."""
    if importlib.util.find_spec("bpy") is None:
        raise NotMeasuredError("there is no bpy here")
    command = [sys.executable, "-m", "benchmarks.blender", "--rows", str(how.rounds(ROUNDS, 4))]
    try:
        done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=TIMEOUT, check=False)
    except subprocess.TimeoutExpired:
        raise NotMeasuredError(f"Blender did not end within {TIMEOUT:.0f} s") from None
    lines = [line for line in done.stdout.splitlines() if line.startswith("ROWS ")]
    if not lines:
        last = (done.stderr.strip().splitlines() or ["it said nothing"])[-1]
        raise NotMeasuredError(f"Blender ended with code {done.returncode}: {last}")
    return [Measurement(**row) for row in json.loads(lines[-1][5:])]


def main() -> None:
    """Print the figures."""
    folders = {name: user_folder(name) for name in ("empty", "ski_addon")}
    for name, folder in folders.items():
        enabling(name, folder)  # compiled files and Blender's own list of extensions are made once
    pairs = np.array([[enabling(name, folder) for name, folder in folders.items()] for _ in range(ROUNDS)])
    for index, clock in enumerate(("", " of the processor")):
        empty, ours = 1e3 * np.median(pairs[..., index], axis=0)
        more = 1e3 * float(np.median(pairs[:, 1, index] - pairs[:, 0, index]))
        print(f"enabling: {ours:.0f} ms{clock}, an empty one {empty:.0f} ms, more {more:.0f} ms")
    samples, frames, keys = baked(ROUNDS)
    seconds, plain = (float(np.median(samples[name].all)) for name in ("bake", "plain"))
    print(f"bake: {frames} frames of a run of {BAKE_SECONDS:g} s at {RATE} fps in {seconds:.2f} s")
    print(f"{1e6 * seconds / keys:.2f} us for each of {keys} keys; Blender alone {1e6 * plain / keys:.2f} us")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--rows"]:
        print("ROWS", json.dumps([asdict(row) for row in bake_rows(int(sys.argv[2]))]))
    else:
        main()
    sys.stdout.flush()
    os._exit(0)  # Blender's module may hang when Python shuts down
