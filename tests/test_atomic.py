"""Writing whole files or none, and finding out first whether a folder can be written."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from ski_addon import atomic
from ski_addon.errors import OutputError


def names(folder):
    return sorted(path.name for path in folder.iterdir())


def test_file_appears_only_when_the_block_ends_well(tmp_path):
    target = tmp_path / "a.npz"
    with atomic.atomic_path(target) as temporary:
        assert temporary.parent == tmp_path and temporary.suffix == ".npz" and temporary != target
        temporary.write_text("new")
        assert not target.exists()
    assert target.read_text() == "new" and names(tmp_path) == ["a.npz"]


@pytest.mark.parametrize("failure", [ValueError, KeyboardInterrupt])
def test_failure_leaves_the_old_file_and_nothing_else(tmp_path, failure):
    target = tmp_path / "a.txt"
    target.write_text("old")
    with pytest.raises(failure), atomic.atomic_path(target) as temporary:
        temporary.write_text("half")
        raise failure
    assert target.read_text() == "old" and names(tmp_path) == ["a.txt"]


def test_full_disk_is_an_output_error_that_names_the_file(tmp_path):
    target = tmp_path / "a.txt"
    with pytest.raises(OutputError, match="a.txt: No space left"), atomic.atomic_path(target) as temporary:
        temporary.write_text("half")
        raise OSError(28, "No space left on device")
    assert names(tmp_path) == []


def test_folder_is_not_replaced_by_a_file(tmp_path):
    with pytest.raises(OutputError, match="it is a folder"):
        atomic.write_text(tmp_path, "x")


def test_text_is_utf8_with_unix_line_ends(tmp_path):
    atomic.write_text(tmp_path / "a.txt", "é\n")
    assert (tmp_path / "a.txt").read_bytes() == b"\xc3\xa9\n"


def test_writable_folder_is_made_and_left_empty(tmp_path):
    folder = tmp_path / "a" / "b"
    atomic.check_writable_folder(folder)
    assert folder.is_dir() and names(folder) == []


@pytest.mark.parametrize("where", ["file", "file/below", "/proc/nothing", "bad\0name"])
def test_folder_that_cannot_be_written_is_found_out(tmp_path, where):
    (tmp_path / "file").write_text("")
    with pytest.raises(OutputError) as caught:
        atomic.check_writable_folder(os.path.join(tmp_path, where))
    assert caught.value.exit_code == 3 and "\n" not in str(caught.value)


def test_output_folder_goes_again_if_nothing_was_put_in(tmp_path):
    with pytest.raises(ValueError, match="stop"), atomic.output_folder(tmp_path / "a" / "b"):
        raise ValueError("stop")
    assert names(tmp_path) == []


def test_output_folder_that_was_there_stays_with_all_in_it(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    with pytest.raises(ValueError, match="stop"), atomic.output_folder(tmp_path):
        raise ValueError("stop")
    with atomic.output_folder(tmp_path / "new") as folder:
        (folder / "result").write_text("x")
    assert names(tmp_path) == ["mine.txt", "new"] and names(tmp_path / "new") == ["result"]


def test_move_all_replaces_files_of_the_same_names(tmp_path):
    stage = tmp_path / "stage"
    stage.mkdir()
    (stage / "a").write_text("new")
    (tmp_path / "a").write_text("old")
    atomic.move_all(stage, tmp_path)
    assert (tmp_path / "a").read_text() == "new" and names(stage) == []


def test_move_all_onto_a_folder_names_it(tmp_path):
    stage, folder = tmp_path / "stage", tmp_path / "out"
    (folder / "a").mkdir(parents=True)
    stage.mkdir()
    (stage / "a").write_text("new")
    with pytest.raises(OutputError, match=str(folder / "a")):
        atomic.move_all(stage, folder)


def left_by(process: int, name: str, computer: str | None = None) -> str:
    """The temporary name under which a process writes a file."""
    path = Path(name)
    return f".{path.stem}.{computer or atomic._computer()}.{process}.tmp{path.suffix}"


def ended_process() -> int:
    with subprocess.Popen([sys.executable, "-c", ""]) as process:
        process.wait()
    return process.pid


def test_what_a_killed_process_left_of_a_file_goes_when_it_is_written_again(tmp_path):
    gone, kept = ended_process(), [left_by(os.getpid(), "other.blend"), left_by(1, "a.blend"), ".a.notes.tmp.blend"]
    kept.append(left_by(gone, "a.blend", "elsewhere"))
    for name in (left_by(gone, "a.blend"), left_by(gone, "a.blend") + "@", *kept):
        (tmp_path / name).write_text("half")
    with atomic.atomic_path(tmp_path / "a.blend") as temporary:
        temporary.write_text("whole")
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(["a.blend", *kept])


def test_folders_that_a_killed_process_collected_files_in_go_too(tmp_path):
    stage = tmp_path / f"{atomic.STAGE}{atomic._computer()}.{ended_process()}.abc"
    stage.mkdir()
    (stage / "recording.npz").write_text("half")
    with atomic.staging_folder(tmp_path) as own:
        assert sorted(path for path in tmp_path.iterdir()) == [own]
    assert list(tmp_path.iterdir()) == []
