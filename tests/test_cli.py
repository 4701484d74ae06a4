"""The command line with a stand-in for the simulation: files, streams and exit codes."""

from __future__ import annotations

import importlib.util
import json
import os
import signal

import pytest

from ski_addon import cli, environment, results
from ski_addon.errors import PlanInfeasible, RecordingError
from ski_addon.spec import PART_KINDS, RunSpec, find_document
from tests.synthetic_recording import synthetic_recording

WRITTEN = ["recording.npz", "recording.task.json", "spec.toml", "summary.json"]
SUMMARY = {"status": "finished", "duration_s": 12.0, "speed_max": 9.0, "torque_ratio_max": float("nan"), "steps": 12000}


class FakeSimulation:
    """Takes the place of planning and simulating; remembers the spec it was given."""

    def __init__(self):
        self.spec = None
        self.status, self.detail, self.failure = "finished", {}, None

    def __call__(self, spec, progress, checkpoints=None):
        self.spec = spec
        progress(0.5, "simulating")
        if self.failure:
            raise self.failure
        self.recording = synthetic_recording(spec, status=self.status, detail=self.detail)
        return self.recording, {**SUMMARY, "status": self.status}


@pytest.fixture
def simulation(monkeypatch):
    fake = FakeSimulation()
    monkeypatch.setattr(results, "simulate_run", fake)
    return fake


@pytest.fixture
def without(monkeypatch):
    find = importlib.util.find_spec

    def hide(*names):
        monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name in names else find(name))

    return hide


@pytest.fixture
def run(capsys):
    def call(*arguments):
        code = cli.main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


def files(folder):
    return sorted(path.name for path in folder.iterdir())


def refused(outcome, code, words):
    """Assert a failure: its code, nothing on stdout but progress, one line on stderr."""
    assert outcome[0] == code
    assert outcome[2].count("\n") == 1 and outcome[2].endswith("\n") and words in outcome[2], outcome[2]


def test_run_writes_all_four_files_whole(run, simulation, tmp_path):
    code, out, err = run("run", "paper_main", "-o", tmp_path / "out")
    assert (code, err) == (0, "")
    assert files(tmp_path / "out") == [*WRITTEN[:2], "report.png", *WRITTEN[2:]]
    assert RunSpec.from_toml(tmp_path / "out" / "spec.toml") == simulation.spec
    summary = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert summary["status"] == "finished" and summary["torque_ratio_max"] is None
    assert (tmp_path / "out" / "report.png").read_bytes().startswith(b"\x89PNG")
    assert "13.5 s of skiing" in out and "simulating:  50%" in out and "fastest" in out


def test_simulate_draws_no_report_and_removes_one_of_another_recording(run, simulation, tmp_path):
    (tmp_path / "report.png").write_text("of an earlier run")
    assert run("simulate", "paper_main", "-o", tmp_path)[0] == 0
    assert files(tmp_path) == WRITTEN


def test_parts_come_before_single_keys(run, simulation, tmp_path):
    arguments = ["--set", "snow.friction=0.09", "--part", "soft", "--set", "technique.angulation=-0.25"]
    assert run("simulate", "paper_main", *arguments, "-o", tmp_path, "--quiet")[0] == 0
    soft = RunSpec().with_part(find_document("soft", PART_KINDS)).snow
    assert simulation.spec.snow.friction == 0.09 and simulation.spec.snow.hardness == soft.hardness
    assert simulation.spec.technique.angulation == -0.25


def test_json_is_all_there_is_on_stdout(run, simulation, tmp_path):
    code, out, err = run("simulate", "paper_main", "-o", tmp_path, "--json")
    assert (code, err) == (0, "")
    assert json.loads(out) == json.loads((tmp_path / "summary.json").read_text())


def test_quiet_says_nothing(run, simulation, tmp_path):
    assert run("simulate", "paper_main", "-o", tmp_path, "--quiet") == (0, "", "")


def test_without_matplotlib_the_run_goes_on_and_says_so(run, simulation, without, tmp_path):
    without("matplotlib")
    code, out, err = run("run", "paper_main", "-o", tmp_path)
    assert (code, err) == (0, "") and "no report.png: matplotlib is not installed" in out
    assert files(tmp_path) == WRITTEN
    refused(run("report", tmp_path), 3, "pip install matplotlib")


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        ([], 2, "the following arguments are required: COMMAND"),
        (["fly"], 2, "invalid choice: 'fly'"),
        (
            ["run", "paper_main"],
            2,
            "the following arguments are required: -o/--output (see python -m ski_addon run --help)",
        ),
        (["run", "paper_main", "-o", "OUT", "--fast"], 2, "unrecognized arguments: --fast"),
        (["run", "paper_mian", "-o", "OUT"], 3, "did you mean paper_main?"),
        (["run", "nothing.toml", "-o", "OUT"], 3, "cannot read nothing.toml"),
        (["run", "paper_main", "--set", "course.turn_radus=3", "-o", "OUT"], 2, "did you mean course.turn_radius?"),
        (
            ["run", "paper_main", "--set", "course.turn_count=0", "-o", "OUT"],
            2,
            "course.turn_count = 0 is outside 1..500",
        ),
        (["run", "paper_main", "--set", "course.turn_radius", "-o", "OUT"], 2, "write --set key=value"),
        (["run", "paper_main", "--set", "snow.friction=nan", "-o", "OUT"], 2, "not a finite number"),
        (["run", "paper_main", "--part", "softt", "-o", "OUT"], 3, "did you mean soft?"),
        (["run", "paper_main", "-o", "/proc/nothing"], 3, "cannot write /proc/nothing"),
        (["bake", "nothing.npz", "--part", "soft", "-o", "OUT/a.blend"], 3, "nothing.npz"),
        (["report", "paper_main"], 3, "it is not a recording"),
    ],
)
def test_bad_input_is_one_line_and_leaves_nothing(run, simulation, monkeypatch, tmp_path, arguments, code, words):
    monkeypatch.setattr(results, "check_blender", lambda needed_for: None)
    monkeypatch.setattr(
        results, "load_recording", lambda path: (_ for _ in ()).throw(RecordingError(path, "truncated"))
    )
    outcome = run(*[argument.replace("OUT", str(tmp_path / "out")) for argument in arguments])
    refused(outcome, code, words)
    assert files(tmp_path) == [] and simulation.spec is None


def test_infeasible_plan_leaves_nothing(run, simulation, tmp_path):
    simulation.failure = PlanInfeasible("turn 3, 41 m along the track", 9.1, "58 degrees of lean are needed")
    refused(run("run", "paper_main", "-o", tmp_path / "out"), 2, "a speed of 9.1 m/s there would work")
    assert files(tmp_path) == []


def test_fall_keeps_what_was_skied_and_says_what_where_when_and_why(run, simulation, monkeypatch, tmp_path):
    simulation.status = "fell"
    simulation.detail = {"what": "the head touched the snow", "where": 31.4, "time": 4.2, "why": "sideways push"}
    outcome = run("run", "paper_main", "-o", tmp_path)
    refused(outcome, 5, "the skier fell at 4.20 s, 31.4 m along the track: the head touched the snow; sideways push")
    assert files(tmp_path) == [*WRITTEN[:2], "report.png", *WRITTEN[2:]]
    monkeypatch.setattr(results, "load_recording", lambda path: simulation.recording)
    code, out, _ = run("run", "paper_main", "-o", tmp_path, "--json")
    assert code == 5 and json.loads(out)["status"] == "fell"


def test_divergence_without_details_still_says_where(run, simulation, tmp_path):
    simulation.status = "diverged"
    refused(
        run("simulate", "paper_main", "-o", tmp_path), 5, "the simulation diverged at 11.99 s, 95.9 m along the track"
    )


def test_long_run_is_refused_before_it_starts_unless_forced(run, simulation, tmp_path):
    long = ["--set", "course.turn_count=500", "--set", "course.turn_duration=20"]
    refused(run("run", "paper_main", *long, "-o", tmp_path / "out"), 2, "2.99 h of skiing, 10748500 steps")
    assert files(tmp_path) == [] and simulation.spec is None
    assert run("simulate", "paper_main", *long, "-o", tmp_path / "out", "--force")[0] == 0


def test_unexpected_failure_is_one_line_too(run, simulation, tmp_path, monkeypatch):
    simulation.failure = ZeroDivisionError("a\nb")
    refused(run("run", "paper_main", "-o", tmp_path / "out"), 1, "unexpected ZeroDivisionError: a b")
    monkeypatch.setenv(environment.TRACEBACK, "1")
    assert "Traceback" in run("run", "paper_main", "-o", tmp_path / "out")[2]


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupt_leaves_nothing_and_exits_130(run, simulation, tmp_path, monkeypatch, number):
    before = signal.getsignal(number)
    monkeypatch.setattr(results, "simulate_run", lambda *_: os.kill(os.getpid(), number))
    refused(run("run", "paper_main", "-o", tmp_path / "out", "--quiet"), 130, "interrupted")
    assert files(tmp_path) == [] and signal.getsignal(number) is before


def test_failure_while_writing_leaves_the_earlier_results(run, simulation, tmp_path, monkeypatch):
    assert run("simulate", "paper_main", "-o", tmp_path)[0] == 0
    before = {name: (tmp_path / name).read_bytes() for name in files(tmp_path)}

    def fail(self, path):
        path.write_text("half")
        raise OSError(28, "No space left on device", str(path))

    monkeypatch.setattr("tests.synthetic_recording.SyntheticRecording.save", fail)
    refused(run("run", "paper_r10", "-o", tmp_path), 3, "No space left on device")
    assert {name: (tmp_path / name).read_bytes() for name in files(tmp_path)} == before


def test_validate_says_one_line_for_each_and_exits_with_the_first_failure(run, tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text("[course]\nturn_radius = 1\n")
    code, out, err = run("validate", "paper_main", bad, "paper_r10")
    assert code == 2 and out.count("\n") == 2 and "13.5 s of skiing" in out
    assert err.count("\n") == 1 and str(bad) in err
    code, out, _ = run("validate", "paper_main", "nowhere", "--json")
    assert code == 3 and [found["valid"] for found in json.loads(out)] == [True, False]


def test_version_and_help_are_no_failures(run):
    assert run("--version") == (0, "Ski Addon 0.1.0\n", "")
    code, out, err = run("run", "--help")
    assert (code, err) == (0, "") and "--set KEY=VALUE" in out
    assert "exit codes" in run("--help")[1]
