"""Pushed runs: what becomes of the skier, growing forces, and the command in processes of its own."""

from __future__ import annotations

import csv
import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ski_addon import cli
from ski_addon.errors import Cancelled
from ski_addon.robustness import Case, PushTable, Row, moments, running
from ski_addon.robustness.running import FELL, GROWTH, RECOVERED, grow_row, run_case
from tests.robustness.fake_results import result
from tests.ski_runs import preset

ROOT = Path(__file__).resolve().parents[2]
CHANGES = {"course.turn_duration": 0.3, "course.transition_duration": 0.4, "simulation.time_step": 0.004}
QUICK = [f"--set={key}={value}" for key, value in CHANGES.items()]
ROW = Row(8.0, "transition", "abdomen", "left")
TABLE = PushTable((20.0, 1500.0), ("abdomen",), ("left",), (8.0,), ("transition",), 0.2)
OPTIONS = (
    *("--forces=20,1500", "--bodies=abdomen", "--directions=left"),
    *("--speeds=8", "--moments=transition", "--duration=0.2"),
)


@pytest.fixture(scope="module")
def spec():
    return preset("paper_main", CHANGES)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The command with two runs in two processes: folder, exit code, stdout and stderr."""
    folder = tmp_path_factory.mktemp("table") / "out"
    done = start(*OPTIONS, "--jobs=2", "-o", folder, "--json")
    out, err = done.communicate(timeout=120)
    return folder, done.returncode, out, err


def start(*arguments):
    return subprocess.Popen(
        [sys.executable, "-m", "ski_addon", "robustness", "paper_main", *QUICK, *map(str, arguments)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


# -- single cases ----------------------------------------------------------------------


def test_a_small_push_is_recovered_from_and_a_huge_one_fells(spec, monkeypatch):
    monkeypatch.setattr(running, "WATCH", 1.5)
    small, huge = (run_case(spec, TABLE, case) for case in TABLE.cases)
    assert small.status == RECOVERED and 0.0 <= small.recovery_s <= 1.5 and small.detail == ""
    assert small.start_s >= moments.SETTLE and 5.0 < small.speed_at_push < 9.0
    assert 0.0 < small.ski_offset_max_m < 0.05 and small.torque_ratio_max < 1.0 and small.joint_margin_min_deg > 0.0
    assert huge.status == FELL and huge.recovery_s is None
    fell = float(re.search(r" at (\d+\.\d+) s; ", huge.detail)[1])
    assert huge.start_s == small.start_s < fell < small.start_s + 0.5
    assert huge.bound_n == small.bound_n > 0


def test_a_case_without_force_is_never_away_from_the_plan(spec, monkeypatch):
    monkeypatch.setattr(running, "WATCH", 0.5)
    none = run_case(spec, TABLE, Case(ROW, 0.0))
    assert none.status == RECOVERED and none.recovery_s == 0.0


def test_a_case_can_be_stopped(spec):
    with pytest.raises(Cancelled):
        run_case(spec, TABLE, TABLE.cases[0], stop=lambda: True)


# -- growing ----------------------------------------------------------------------------


@pytest.fixture
def falls_at(monkeypatch):
    """Stand-in for the runs of a row: fall at this force and above; remembers the forces tried."""

    def pretend(limit: float) -> list[float]:
        tried: list[float] = []

        def run(spec, table, case, stop):
            tried.append(case.force)
            return result(case, FELL if case.force >= limit else RECOVERED)

        monkeypatch.setattr(running, "run_case", run)
        return tried

    return pretend


@pytest.mark.parametrize(
    ("limit", "known", "tried"),
    [
        (260.0, {50.0: RECOVERED, 200.0: RECOVERED}, [225.0, 250.0, 275.0]),
        (120.0, {50.0: RECOVERED, 100.0: RECOVERED, 150.0: FELL}, [125.0]),
        (60.0, {100.0: FELL, 200.0: RECOVERED}, [25.0, 50.0, 75.0]),
        (120.0, {100.0: RECOVERED, 125.0: FELL}, []),
        (9e9, {450.0: RECOVERED}, [475.0, 500.0]),
        (9e9, {600.0: RECOVERED}, []),
    ],
)
def test_forces_grow_until_a_fall(falls_at, spec, limit, known, tried):
    seen = falls_at(limit)
    grown = grow_row(spec, TABLE, ROW, known)
    assert seen == tried == [outcome.case.force for outcome in grown]
    assert set(seen) <= set(GROWTH)


# -- the command --------------------------------------------------------------------------


def test_the_command_writes_its_files_and_says_the_same(finished):
    folder, code, out, err = finished
    assert (code, err) == (0, "")
    names = {path.name for path in folder.iterdir()}
    assert {"robustness.json", "robustness.csv"} <= names <= {"robustness.json", "robustness.csv", "robustness.png"}
    summary = json.loads(out)
    assert summary == json.loads((folder / "robustness.json").read_text())
    assert [run["status"] for run in summary["runs"]] == [RECOVERED, FELL]
    assert [row["largest_n"] for row in summary["rows"]] == [20.0]
    with (folder / "robustness.csv").open() as stream:
        assert [float(line["force_n"]) for line in csv.DictReader(stream)] == [20.0, 1500.0]


def test_a_run_in_a_worker_is_the_run_itself(finished, spec):
    data = json.loads((finished[0] / "robustness.json").read_text())["runs"][0]
    here = run_case(spec, TABLE, TABLE.cases[0])
    assert data["ski_offset_max_m"] == pytest.approx(here.ski_offset_max_m, rel=1e-6)
    assert data["recovery_s"] == pytest.approx(here.recovery_s, abs=0.005)


def test_interrupt_stops_all_processes_and_leaves_nothing(tmp_path):
    process = start("--jobs=2", "-o", tmp_path / "out")
    process.stdout.readline()  # "... pushed runs in 2 processes"
    children = []
    for _ in range(200):
        time.sleep(0.05)
        children = children_of(process.pid)
        if len(children) >= 3:  # two workers and what watches their semaphores
            break
    os.killpg(process.pid, signal.SIGINT)  # as a terminal does
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert err == "ski_addon: interrupted: no half-written file is left\n"
    assert list(tmp_path.iterdir()) == []
    time.sleep(0.5)
    assert children and not [child for child in children if is_running(child)]


def is_running(pid: int) -> bool:
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"  # ended but not collected
    except OSError:
        return False


def children_of(pid: int) -> list[int]:
    try:
        return [int(word) for word in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]
    except OSError:
        pytest.skip("needs Linux's /proc")


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["--set=snow.friction=0.5"], 2, "friction stops the skier"),
        (["--forces=x"], 2, '--forces = "x" is not a number'),
        (["--jobs=0"], 2, "--jobs = 0 is outside 1..1024"),
        (["-o", "/proc/nothing"], 3, "cannot write /proc/nothing"),
        (["--set=course.turn_radus=3"], 2, "did you mean course.turn_radius?"),
    ],
)
def test_failures_are_one_line_and_leave_nothing(tmp_path, capsys, arguments, code, words):
    output = [] if "-o" in arguments else ["-o", str(tmp_path / "out")]
    assert cli.main(["robustness", "paper_main", *QUICK, *OPTIONS, "--jobs=1", "--quiet", *output, *arguments]) == code
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and words in err, err
    assert list(tmp_path.iterdir()) == []


def test_without_matplotlib_the_table_is_there_and_says_so(tmp_path, capsys, monkeypatch):
    from ski_addon import results

    outcomes = [result(case) for case in TABLE.cases]
    monkeypatch.setattr("ski_addon.robustness.run_table", lambda *_arguments, **_options: outcomes)
    monkeypatch.setattr(results, "_has_matplotlib", lambda: False)
    assert cli.main(["robustness", "paper_main", *OPTIONS, "-o", str(tmp_path)]) == 0
    out = capsys.readouterr().out
    assert "no robustness.png: matplotlib is not installed" in out and "20 N: still up 1 of 1, back in time 1" in out
    assert sorted(path.name for path in tmp_path.iterdir()) == ["robustness.csv", "robustness.json"]
