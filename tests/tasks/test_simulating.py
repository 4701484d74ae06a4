"""`simulate`, `bake` and `report` as tasks, on a run of one short turn: skipped, rebuilt, killed and gone on with."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from ski_addon import cli, environment

ROOT = Path(__file__).resolve().parents[2]
SHORT = ["paper_main", "--set=course.turn_count=1", "--set=course.turn_duration=0.3",
         "--set=course.transition_duration=0.4", "--set=simulation.time_step=0.002"]  # fmt: skip
LONGER = ["paper_main", "--set=course.turn_count=3", "--set=simulation.time_step=0.002"]
FILES = ["recording.npz", "recording.task.json", "spec.toml", "summary.json"]


@pytest.fixture
def simulate(capsys):
    def call(folder, *words):
        code = cli.main(["simulate", *SHORT, "-o", str(folder), *words])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


def files(folder):
    return sorted(path.name for path in folder.iterdir())


def test_finished_run_is_not_made_again(simulate, tmp_path):
    first = simulate(tmp_path, "--json")
    stamps = {name: (tmp_path / name).stat().st_mtime_ns for name in FILES}
    again = simulate(tmp_path, "--json")
    assert first == again and files(tmp_path) == FILES
    assert {name: (tmp_path / name).stat().st_mtime_ns for name in FILES} == stamps
    assert f"{tmp_path / 'recording.npz'}: up to date" in simulate(tmp_path)[1]


@pytest.mark.parametrize("name", FILES)
@pytest.mark.parametrize("way", ["removed", "cut", "edited"])
def test_file_that_was_touched_is_made_again(simulate, tmp_path, name, way):
    simulate(tmp_path)
    whole = {each: (tmp_path / each).read_bytes() for each in FILES[::2]}
    path = tmp_path / name
    content = path.read_bytes()
    if way == "removed":
        path.unlink()
    else:
        middle = len(content) // 2
        path.write_bytes(content[:middle] + (b"" if way == "cut" else b"\x01" + content[middle + 1 :]))
    code, out, err = simulate(tmp_path)
    assert (code, err) == (0, "") and files(tmp_path) == FILES
    if (name, way) != ("recording.task.json", "edited"):  # an edit may hit what does not count
        assert "made again" in out or name == "recording.npz"
    assert {each: (tmp_path / each).read_bytes() for each in FILES[::2]} == whole
    assert "up to date" in simulate(tmp_path)[1]


def test_another_run_takes_the_place_of_the_first(simulate, tmp_path):
    simulate(tmp_path)
    code, out, _ = simulate(tmp_path, "--set", "skier.mass=70")
    assert code == 0 and "recording.npz was made from something else, made again" in out
    assert simulate(tmp_path, "--redo", "--set", "skier.mass=70")[1].count("asked for, made again") == 1


def test_report_joins_a_finished_run(simulate, tmp_path, capsys):
    pytest.importorskip("matplotlib")
    simulate(tmp_path)
    assert cli.main(["run", *SHORT, "-o", str(tmp_path)]) == 0
    assert "up to date" in capsys.readouterr().out and (tmp_path / "report.png").exists()
    assert cli.main(["report", str(tmp_path)]) == 0
    assert f"{tmp_path / 'report.png'}: up to date" in capsys.readouterr().out


def test_farm_gets_its_lines_on_stdout(simulate, tmp_path, monkeypatch):
    code, out, err = simulate(tmp_path, "--openjd", "--quiet")
    lines = out.splitlines()
    assert (code, err) == (0, "") and re.search(r"^simulate \S+: key [0-9a-f]{16}, seed 0, ski_addon ", out, re.M)
    percents = [float(line.split()[1]) for line in lines if line.startswith("openjd_progress: ")]
    assert percents == sorted(percents) and percents[0] == 0.0 and percents[-1] <= 100.0
    assert [line for line in lines if line.startswith("openjd_status: ")]
    monkeypatch.setenv(environment.OPENJD, "1")
    assert "up to date, key" in simulate(tmp_path, "--quiet")[1]
    code, out, err = simulate(tmp_path, "--json", "--quiet")
    assert json.loads(out)["status"] == "finished" and "up to date, key" in err


@pytest.mark.parametrize(
    ("words", "code"), [(["fly"], 2), (["simulate", "paper_mian", "-o", "x"], 3), (["validate", "nowhere"], 0)]
)
def test_failure_is_one_line_for_people_and_one_for_a_farm(capsys, tmp_path, monkeypatch, words, code):
    monkeypatch.chdir(tmp_path)
    if code:
        assert cli.main([*words, "--openjd"]) == code
        out, err = capsys.readouterr()
        assert err.count("\n") == 1 and out.count("openjd_fail: ") == 1 and out.count("\n") == 1
    assert files(tmp_path) == []


def test_log_holds_key_versions_seed_host_and_failures(simulate, tmp_path, monkeypatch):
    log = tmp_path / "ski.log"
    simulate(tmp_path / "out", "--log", str(log))
    monkeypatch.setenv(environment.LOG, str(log))
    assert simulate(tmp_path / "out", "--set", "skier.mass=1")[0] == 2
    text = log.read_text()
    assert re.search(r"^\d{4}-\d\d-\d\dT[\d:]{8}Z simulate \S+: key [0-9a-f]{16}, seed 0, .*mujoco \d", text, re.M)
    assert "on name " in text and ": done in " in text and "failed: " in text and "skier.mass" in text
    assert simulate(tmp_path / "out", "--log", str(tmp_path / "no" / "log"))[0] == 3


def start(folder, *words, **more):
    return subprocess.Popen(
        [sys.executable, "-m", "ski_addon", "simulate", *LONGER, *words, "-o", str(folder)],
        cwd=ROOT, env=os.environ | more, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip


def wait_for(folder, process):
    """Wait for a checkpoint."""
    for line in process.stdout:
        if (folder / "checkpoint.npz").exists() and line.startswith("simulating"):
            return


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_killed_run_goes_on_and_ends_with_the_same_bytes(tmp_path, number):
    out, plain = tmp_path / "out", tmp_path / "plain"
    with start(out, **{environment.CHECKPOINT_SECONDS: "0.05"}) as process:
        wait_for(out, process)
        process.send_signal(number)
        _, err = process.communicate(timeout=60)
    assert process.returncode == (130 if number == signal.SIGTERM else -number)
    assert number == signal.SIGKILL or "the same command goes on from there" in err
    assert "recording.npz" not in files(out)
    with start(out) as process:
        said, err = process.communicate(timeout=120)
    assert (process.returncode, err) == (0, "") and re.search(r"^going on from \d\.\d\d s", said, re.M)
    assert cli.main(["simulate", *LONGER, "-o", str(plain), "--quiet"]) == 0
    assert files(out) == files(plain) == FILES
    assert (out / "recording.npz").read_bytes() == (plain / "recording.npz").read_bytes()


def test_damaged_checkpoint_is_one_line_and_the_run_begins_anew(simulate, tmp_path):
    (tmp_path / "checkpoint.npz").write_bytes(b"PK\x03\x04 half")
    code, out, err = simulate(tmp_path)
    assert (code, err) == (0, "") and out.count("begun anew, for ") == 1 and files(tmp_path) == FILES
