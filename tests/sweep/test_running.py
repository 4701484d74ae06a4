"""A sweep of short runs: its table, what is kept, and what goes on."""

from __future__ import annotations

import csv
import json

import pytest

from ski_addon import cli

SHORT = [
    f"--set={change}"
    for change in ("course.turn_count=1", "course.turn_duration=0.3", "course.transition_duration=0.4",
                   "simulation.time_step=0.002")
]  # fmt: skip


def sweep(folder, *words):
    return cli.main(["sweep", "paper_main", *SHORT, "-o", str(folder), *words])


@pytest.fixture(scope="module")
def swept(tmp_path_factory):
    """A sweep over two processes, one of whose runs cannot be skied."""
    folder = tmp_path_factory.mktemp("sweep")
    values = ("--vary", "course.start_speed=9,20", "--vary", "skier.mass=60,80")
    assert sweep(folder, *values, "--jobs", "2", "--quiet") == 0
    return folder


def test_every_run_has_a_folder_and_a_row(swept):
    table = json.loads((swept / "sweep.json").read_text())
    assert table["keys"] == ["course.start_speed", "skier.mass"] and table["runs"] == 4 and table["kept"] == 0
    assert table["statuses"]["finished"] >= 2
    for row in table["rows"]:
        done = (swept / row["folder"] / "recording.npz").exists()
        assert done == (row["status"] != "impossible")
    with open(swept / "sweep.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [row["skier.mass"] for row in rows] == ["60", "80"] * 2
    assert float(rows[0]["speed_max"]) == pytest.approx(table["rows"][0]["speed_max"])


def test_run_that_cannot_be_skied_is_a_row_that_says_why(swept):
    rows = json.loads((swept / "sweep.json").read_text())["rows"]
    refused = [row for row in rows if row["status"] == "impossible"]
    assert refused and all("the track cannot be skied at" in row["detail"] for row in refused)
    assert all(row["speed_max"] is None for row in refused)


def test_finished_runs_are_kept_and_new_values_join(swept, capsys):
    recording = swept / "start_speed=9,mass=60" / "recording.npz"
    before = recording.stat().st_mtime_ns
    assert sweep(swept, "--vary", "course.start_speed=9", "--vary", "skier.mass=60,70", "--jobs", "1") == 0
    out = capsys.readouterr().out
    assert "2 runs: 2 finished, 1 of them up to date" in out and recording.stat().st_mtime_ns == before
    assert (swept / "start_speed=9,mass=70" / "recording.npz").exists()


def test_run_of_a_sweep_is_the_run_itself(swept, tmp_path):
    spec = swept / "start_speed=9,mass=80" / "spec.toml"
    assert cli.main(["simulate", str(spec), "-o", str(tmp_path), "--quiet"]) == 0
    assert (tmp_path / "recording.npz").read_bytes() == spec.with_name("recording.npz").read_bytes()


def test_without_values_one_line(tmp_path, capsys):
    assert cli.main(["sweep", "paper_main", "-o", str(tmp_path / "out")]) == 2
    assert "--vary" in capsys.readouterr().err and not (tmp_path / "out").exists()


def cut(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def edited(path):
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(bytes(data))


@pytest.mark.parametrize("spoil", [lambda path: path.unlink(), cut, edited], ids=["deleted", "cut off", "edited"])
@pytest.mark.parametrize("name", ["recording.npz", "summary.json", "spec.toml", "recording.task.json", "../sweep.json"])
def test_file_that_was_touched_is_made_again(tmp_path, capsys, name, spoil):
    values = ("--vary", "skier.mass=60,70", "--jobs", "1")
    assert sweep(tmp_path, *values) == 0
    recording = tmp_path / "mass=60" / "recording.npz"
    other = (tmp_path / "mass=70" / "recording.npz").stat().st_mtime_ns
    whole = recording.read_bytes()
    spoil(tmp_path / "mass=60" / name)
    assert sweep(tmp_path, *values) == 0
    assert recording.read_bytes() == whole and (tmp_path / "mass=70" / "recording.npz").stat().st_mtime_ns == other
    assert json.loads((tmp_path / "sweep.json").read_text())["statuses"] == {"finished": 2}
    assert capsys.readouterr().err == ""
