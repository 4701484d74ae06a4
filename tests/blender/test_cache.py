"""Where recordings live between Simulate and Bake."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest


class Kept:
    """Stands for a recording: it can be saved."""

    header = {"spec_hash": "0123456789abcdef0123"}

    def save(self, path: Path) -> None:
        Path(path).write_bytes(b"recorded")


@pytest.fixture
def cache(core, scene):
    found = core("blender.cache")
    for path in found.user_cache().glob("*.npz"):
        path.unlink()
    return found


def test_an_unsaved_file_uses_the_user_s_folder(cache, scene) -> None:
    path = Path(cache.save_recording(Kept(), scene.name).path)
    assert path.parent == cache.user_cache()
    assert path.read_bytes() == b"recorded"
    assert "0123456789abcdef" in path.name


def test_a_saved_file_keeps_it_beside_itself_by_a_relative_path(cache, scene, tmp_path: Path) -> None:
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot 7.blend"))
    scene = bpy.context.scene
    scene.name = "Take/1"
    path, note = cache.save_recording(Kept(), scene.name)
    assert note == ""
    assert path == "//ski_cache/shot_7_Take_1.npz"
    assert Path(bpy.path.abspath(path)).read_bytes() == b"recorded"


def test_a_folder_that_takes_no_files_falls_back_to_the_user_s(cache, scene, tmp_path: Path) -> None:
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    (tmp_path / cache.FOLDER).write_text("in the way")
    kept = cache.save_recording(Kept(), "Scene")
    assert Path(kept.path).parent == cache.user_cache()
    assert "it is a file, not a folder; kept in" in kept.note


def test_only_the_newest_are_kept(cache, scene) -> None:
    folder = cache.user_cache()
    folder.mkdir(parents=True, exist_ok=True)
    for index in range(15):
        path = folder / f"Scene_{index:016x}.npz"
        path.write_bytes(b"old")
        os.utime(path, (1_000_000 + index, 1_000_000 + index))
    cache.save_recording(Kept(), scene.name)
    left = sorted(path.name for path in folder.glob("*.npz"))
    assert len(left) == cache.KEPT
    assert f"Scene_{14:016x}.npz" in left
    assert f"Scene_{0:016x}.npz" not in left


def test_only_recordings_are_ever_removed(core, cache, scene, tmp_path: Path) -> None:
    """The folder may be one of the user's own choice, with other files in it."""
    known = core("blender.preferences").preferences()
    known.cache_folder = str(tmp_path)
    try:
        others = [tmp_path / name for name in ("thesis.npz", "Skier_slope.npz")]
        for path in others:
            path.write_bytes(b"mine")
            os.utime(path, (1, 1))
        for index in range(15):
            (tmp_path / f"Scene_{index:016x}.npz").write_bytes(b"old")
        assert Path(cache.save_recording(Kept(), scene.name).path).parent == tmp_path
        assert all(path.is_file() for path in others)
        assert len(list(tmp_path.glob("Scene_*.npz"))) == cache.KEPT
    finally:
        known.cache_folder = ""


def test_nothing_simulated_yet_is_said(core, cache) -> None:
    with pytest.raises(core("errors").MissingInputError, match="press Simulate"):
        cache.load_recording("")


def test_a_recording_comes_back_as_it_was(core, cache, scene) -> None:
    run = (
        core("blender.properties")
        .preset_specs()["paper_main"]
        .with_overrides({"course.turn_count": 1, "course.turn_duration": 0.1, "course.transition_duration": 0.3})
    )
    jobs = core("blender.jobs")
    recording = jobs.run_to_end(jobs.simulation_job(run))
    found = cache.load_recording(cache.save_recording(recording, "Skier").path)
    np.testing.assert_array_equal(found.qpos, recording.qpos)
    assert found.header == recording.header
