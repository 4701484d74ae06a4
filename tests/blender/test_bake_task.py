"""The task `bake`: what it made is kept while it is as it was, and made again when it is not."""

from __future__ import annotations

import bpy
import pytest

from ski_addon import cli

RUN = ("paper_main", "--set", "course.turn_count=1", "--set", "course.turn_duration=0.3", "--set",
       "simulation.time_step=0.004")  # fmt: skip


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder of a short run."""
    folder = tmp_path_factory.mktemp("task") / "run"
    assert cli.main(["simulate", *RUN, "-o", str(folder), "--quiet"]) == 0
    return folder


def bake(run, capsys, *words):
    code = cli.main(["bake", str(run), *words])
    return code, capsys.readouterr()


def cut(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def edited(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 3] ^= 1
    path.write_bytes(bytes(data))


@pytest.mark.parametrize("spoil", [lambda path: path.unlink(), cut, edited], ids=["deleted", "cut off", "edited"])
@pytest.mark.parametrize("name", ["skier.blend", "skier.blend.task.json"])
def test_file_that_was_touched_is_made_again(run, capsys, name, spoil):
    bake(run, capsys)
    names = sorted(path.name for path in run.iterdir())
    if name not in names:  # whatever the receipt is called
        (name,) = [other for other in names if other.endswith(".task.json") and other.startswith("skier")]
    assert "up to date" in bake(run, capsys)[1].out
    spoil(run / name)
    code, said = bake(run, capsys)
    assert (code, said.err) == (0, "")
    assert sorted(path.name for path in run.iterdir()) == names
    bpy.ops.wm.open_mainfile(filepath=str(run / "skier.blend"))
    assert "Skier" in bpy.data.objects
    assert "up to date" in bake(run, capsys)[1].out


def test_recording_that_was_cut_off_is_one_line_and_the_old_file_stays(run, capsys):
    bake(run, capsys)
    before = (run / "skier.blend").read_bytes()
    whole = (run / "recording.npz").read_bytes()
    cut(run / "recording.npz")
    code, said = bake(run, capsys)
    assert code == 3 and said.err.count("\n") == 1 and "cannot read the recording" in said.err
    assert (run / "skier.blend").read_bytes() == before
    (run / "recording.npz").write_bytes(whole)
