"""Full disks and places where nothing can be written: said in the tab and by report, and no simulation is lost."""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.blender.test_slope_taking import hill

resource = pytest.importorskip("resource", reason="limits of a file's size are set by POSIX")
LIMIT = 4096
"""Size that files can have on the full disk [bytes]: an empty one can be made, no recording fits."""


@contextlib.contextmanager
def full_disk(limit: int = LIMIT) -> Iterator[None]:
    """Let every file that grows beyond `limit` [bytes] fail, as on a disk that is full."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, before[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


@pytest.fixture
def ski(core: Any, scene: Any) -> Any:
    """The settings of a short run that can be skied."""
    settings = core("blender.skiers").add_skier(scene, preset="paper_main").ski
    settings.course.turn_count = 1
    settings.course.turn_duration, settings.course.transition_duration = 0.4, 0.5
    return settings


@pytest.fixture
def chosen(core: Any, extension: str) -> Iterator[Any]:
    """A function that chooses the folder of recordings in the preferences."""
    known = core("blender.preferences").preferences()

    def choose(folder: Path) -> None:
        known.cache_folder = str(folder)

    yield choose
    known.cache_folder = ""


@pytest.fixture
def own_cache(core: Any, extension: str) -> Path:
    """The add-on's own folder, empty."""
    folder = core("blender.preferences").user_folder("cache")
    shutil.rmtree(folder, ignore_errors=True)
    return folder


def test_a_full_disk_loses_no_simulation(core, ski, own_cache: Path, capfd) -> None:
    import bpy

    with full_disk():
        assert bpy.ops.ski.simulate() == {"FINISHED"}
    *lines, note = ski.simulation_text.split("\n")
    assert lines[0].startswith("Skied to the end") and not ski.simulation_failed
    assert note.startswith("Note: cannot write ") and "File too large" in note
    assert note.endswith("held until Blender is closed: bake it now, or make room and simulate again")
    assert "Warning: Skied to the end" in capfd.readouterr().out
    assert list(own_cache.iterdir()) == [], "no part of a file stays"
    assert bpy.ops.ski.bake() == {"FINISHED"}
    assert ski.id_data.animation_data.action is not None
    assert bpy.ops.ski.simulate() == {"FINISHED"}, "and there is room again"
    assert Path(ski.recording).parent == own_cache and "Note" not in ski.simulation_text


def test_a_held_recording_is_gone_with_blender(core, ski, own_cache: Path) -> None:
    import bpy

    with full_disk():
        bpy.ops.ski.simulate()
    core("blender.cache")._held.clear()  # what closing Blender does
    with pytest.raises(RuntimeError, match="held in memory and is gone: press Simulate again"):
        bpy.ops.ski.bake()


def test_the_earlier_recording_stays_whole(core, ski, tmp_path: Path, own_cache: Path) -> None:
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    bpy.ops.ski.simulate()
    path = Path(bpy.path.abspath(ski.recording))
    before = path.read_bytes()
    with full_disk():
        bpy.ops.ski.simulate()
    assert path.read_bytes() == before
    assert sorted(found.name for found in path.parent.iterdir()) == [path.name]


PLACES = ["/proc/ski_addon", "/sys/ski_addon", "a file"]


@pytest.mark.parametrize("place", PLACES)
def test_a_chosen_folder_that_cannot_be_written_is_named(ski, chosen, own_cache, tmp_path: Path, place: str) -> None:
    """Being root does not help with these."""
    import bpy

    folder = Path(place)
    if place == "a file":
        folder = tmp_path / "recordings"
        folder.write_text("in the way")
    elif not folder.parent.is_dir():
        pytest.skip(f"there is no {folder.parent}")
    chosen(folder)
    assert bpy.ops.ski.simulate() == {"FINISHED"}
    assert Path(ski.recording).parent == own_cache
    note = ski.simulation_text.split("\n")[-1]
    assert note.startswith(f"Note: cannot write {folder}: ") and note.endswith(f"kept in {own_cache} instead")
    assert bpy.ops.ski.bake() == {"FINISHED"}


def test_a_saved_file_in_a_place_without_room_says_where_the_recording_is(ski, tmp_path: Path, own_cache) -> None:
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot.blend"))
    (tmp_path / "ski_cache").write_text("in the way")
    assert bpy.ops.ski.simulate() == {"FINISHED"}
    assert Path(ski.recording).parent == own_cache
    assert "ski_cache: it is a file, not a folder; kept in" in ski.simulation_text


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    """A disk of 64 kB."""
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = shutil.which("mount")
    command = [mount or "mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(folder)]
    if mount is None or os.geteuid() != 0 or subprocess.run(command, capture_output=True, check=False).returncode:
        pytest.skip("no disk can be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_a_small_disk_runs_full(ski, chosen, own_cache: Path, small_disk: Path) -> None:
    import bpy

    chosen(small_disk)
    assert bpy.ops.ski.simulate() == {"FINISHED"}
    assert "No space left on device" in ski.simulation_text and Path(ski.recording).parent == own_cache
    assert list(small_disk.iterdir()) == []


def test_a_slope_is_not_taken_on_a_full_disk(core, ski, scene, own_cache: Path) -> None:
    import bpy

    ski.slope_mesh = hill(scene)
    before, stood = core("blender.properties").read_spec(ski), ski.start.matrix_world.copy()
    with full_disk(), pytest.raises(RuntimeError, match=r"cannot write .*_slope\.npz: File too large"):
        bpy.ops.ski.sample_slope()
    assert core("blender.properties").read_spec(ski) == before and ski.start.matrix_world == stood
    assert ski.slope_failed and "File too large" in ski.slope_said
    assert list(own_cache.iterdir()) == []
    bpy.ops.ski.sample_slope()
    assert not ski.slope_failed and "samples" in ski.slope_said


def test_a_preset_is_whole_or_not_there(core, ski) -> None:
    import bpy

    folder = core("blender.preferences").user_folder("presets")
    with full_disk(64), pytest.raises(RuntimeError, match=r"cannot write .*\.toml: File too large"):
        bpy.ops.ski.save_preset(name="Full")
    assert [path for path in folder.rglob("*") if "ull" in path.name] == []
