"""Crowds that are run: the same in one process and in several, stopped and gone on with, and what is said of them."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from ski_addon import cli
from ski_addon.crowd.documents import read_crowd, write_crowd
from ski_addon.crowd.members import draw_member
from ski_addon.crowd.planning import load_plans, plan_member
from ski_addon.crowd.running import run_crowd, steps_here
from ski_addon.crowd.skiing import check_whole, kept_outcome, recording_name, ski_member
from ski_addon.crowd.tracks import STEP
from ski_addon.errors import Cancelled, OutputError, RecordingError, SkiAddonError
from ski_addon.pipeline import make_plan, run_simulation
from ski_addon.simulation import Recording
from tests.crowd.crowds import crowd_of

ROOT = Path(__file__).resolve().parents[2]
APART = {"crowd.apart": 3, "crowd.start_interval": 0, "crowd.start_variation": 0}


def quiet(_fraction, _text):
    return None


@pytest.fixture(scope="module")
def crowd():
    return crowd_of(3, APART)


@pytest.fixture(scope="module")
def here(tmp_path_factory, crowd):
    """The crowd in this process: its folder and summary."""
    folder = tmp_path_factory.mktemp("here")
    return folder, run_crowd(crowd, folder, 0, quiet)


@pytest.fixture(scope="module")
def command(tmp_path_factory, crowd):
    """The command in two processes: folder, exit code, stdout and stderr."""
    folder = tmp_path_factory.mktemp("command")
    document = write_crowd(crowd, folder)
    done = start(document, "--jobs=2", "-o", folder / "out", "--json")
    out, err = done.communicate(timeout=120)
    return folder / "out", done.returncode, out, err


def start(*arguments):
    return subprocess.Popen(
        [sys.executable, "-m", "ski_addon", "crowd", *map(str, arguments)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )


def recordings(folder):
    return {path.name: path.read_bytes() for path in sorted(folder.glob("member_*.npz"))}


def without_measures(summary):
    """A summary without what depends on the machine and its load."""
    measured = {"planning_s", "skiing_s", "throughput", "jobs", "wall_s", "process", "memory_bytes", "kept"}
    measured |= {"worker_memory_bytes", "main_memory_bytes"}
    plain = {key: value for key, value in summary.items() if key not in measured}
    plain["members"] = [{k: v for k, v in member.items() if k not in measured} for member in summary["members"]]
    return plain


def test_parallel_processes_give_the_same_bytes(here, command):
    folder, code, out, err = command
    assert (code, err) == (0, "")
    assert recordings(folder) == recordings(here[0]) and len(recordings(folder)) == 3
    assert without_measures(json.loads(out)) == without_measures(json.loads((here[0] / "crowd.json").read_text()))


def test_a_member_is_an_ordinary_run(here, crowd):
    spec = draw_member(crowd, 1).spec
    recording = run_simulation(make_plan(spec))[0]
    recording.save(here[0] / "alone.npz")
    assert (here[0] / "alone.npz").read_bytes() == (here[0] / "member_002.npz").read_bytes()


def test_the_folder_holds_what_is_promised(command):
    names = {path.name for path in command[0].iterdir()}
    assert names == {"crowd.json", "crowd.toml", "plans.npz", "run_1.toml", *(recording_name(k) for k in range(3))}
    assert json.loads((command[0] / "crowd.json").read_text()) == json.loads(command[2])


def test_the_skied_ways_are_as_far_apart_as_asked(here, crowd):
    """Measured anew, every millisecond, from the recordings alone. Ours looks on for the rest of a step at most."""
    folder, summary = here
    assert summary["finished"] == 3 and summary["least_distance_m"] >= 3.0
    clocks = []
    for member in summary["members"]:
        recording = Recording.load(folder / member["file"])
        assert member["delay_s"] == member["start_s"] and recording.header["spec_hash"] == member["spec_hash"]
        clocks.append((recording.time + member["start_s"], recording.com + (0.0, member["offset_m"], 0.0)))
    found = []
    for one in range(3):
        for other in range(one):
            moments = np.arange(0.0, 12.0, 0.001)
            (t, p), (u, q) = clocks[one], clocks[other]
            both = moments[(moments >= max(t[0], u[0])) & (moments <= min(t[-1], u[-1]) + crowd.crowd.linger)]
            apart = [np.interp(both, t, p[:, k]) - np.interp(both, u, q[:, k]) for k in range(3)]
            found.append(np.linalg.norm(apart, axis=0).min() if len(both) else np.inf)
    fastest = max(np.diff(place, axis=0).max() / (moment[1] - moment[0]) for moment, place in clocks)
    assert min(found) >= summary["least_distance_m"] - 0.02 >= 3.0 - 0.02
    assert min(found) <= summary["least_distance_m"] + fastest * STEP


def test_what_is_done_is_kept_and_said(here, crowd, tmp_path):
    for name, content in recordings(here[0]).items():
        if name != recording_name(1):
            (tmp_path / name).write_bytes(content)
    (tmp_path / recording_name(0)).write_bytes(recordings(here[0])[recording_name(0)][:-1000])  # damaged
    summary = run_crowd(crowd, tmp_path, 0, quiet)
    assert [member["kept"] for member in summary["members"]] == [False, False, True]
    assert recordings(tmp_path) == {k: v for k, v in recordings(here[0]).items() if k.startswith("member")}


def test_another_crowd_in_the_same_folder_keeps_only_its_own(here, crowd):
    member = draw_member(crowd, 1)
    assert kept_outcome(member, here[0]).status == "finished"
    assert kept_outcome(draw_member(crowd.with_values({"crowd.seed": 9}), 1), here[0]) is None
    more = crowd.with_values({"crowd.count": 4, "crowd.apart": 1})
    assert sorted(load_plans(here[0], more)) == [0, 1, 2]
    assert load_plans(here[0], crowd.with_values({"spread.height": 0.01})) == {}


def flip_a_byte(path):
    """Damage the middle of a file, where the archive's table of contents is not."""
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 0xFF
    path.write_bytes(bytes(content))


def test_a_recording_with_a_wrong_byte_is_skied_again(here, crowd, tmp_path):
    path = tmp_path / recording_name(0)
    path.write_bytes(recordings(here[0])[path.name])
    check_whole(path)
    assert kept_outcome(draw_member(crowd, 0), tmp_path).kept
    flip_a_byte(path)
    assert kept_outcome(draw_member(crowd, 0), tmp_path) is None
    with pytest.raises(RecordingError, match=r"member_001\.npz: .*damaged.*simulate the crowd again"):
        check_whole(path)
    for nothing in (b"", b"text", recordings(here[0])[path.name][:5000]):
        path.write_bytes(nothing)
        assert kept_outcome(draw_member(crowd, 0), tmp_path) is None
        with pytest.raises(RecordingError, match="simulate the crowd again"):
            check_whole(path)


def test_a_full_disk_is_one_line_and_what_is_done_is_kept(crowd, tmp_path, monkeypatch):
    from ski_addon.crowd import running

    real = running.ski_member

    def full(member, folder):
        if member.index == 1:
            raise OutputError(folder, "No space left on device")
        return real(member, folder)

    monkeypatch.setattr(running, "ski_member", full)
    with pytest.raises(OutputError, match="No space left"):
        run_crowd(crowd, tmp_path, 0, quiet)
    summary = json.loads((tmp_path / "crowd.json").read_text())
    assert [member["status"] for member in summary["members"]] == ["finished", "waiting", "waiting"]
    assert summary["stopped"] and list(recordings(tmp_path)) == ["member_001.npz"]


def test_a_crowd_that_is_killed_leaves_what_it_said_on_the_way(crowd, tmp_path, monkeypatch):
    from ski_addon.crowd import running

    (tmp_path / "crowd.json").write_text("of another crowd")
    real, seen = running.ski_member, []

    def watched(member, folder):
        path = folder / "crowd.json"
        seen.append([m["status"] for m in json.loads(path.read_text())["members"]] if path.exists() else None)
        return real(member, folder)

    monkeypatch.setattr(running, "ski_member", watched)
    monkeypatch.setattr(running, "SAVE_SECONDS", 0.0)
    monkeypatch.setattr(running, "SAVE_SHARE", 1e9)
    run_crowd(crowd, tmp_path, 0, quiet)
    assert seen == [None, ["finished", "waiting", "waiting"], ["finished", "finished", "waiting"]]


def test_steps_that_are_not_gone_on_with_leave_what_is_done(crowd, tmp_path):
    steps = steps_here(crowd, tmp_path)
    while not list(tmp_path.glob("member_*.npz")):
        next(steps)
    steps.close()
    summary = json.loads((tmp_path / "crowd.json").read_text())
    assert summary["stopped"] and summary["finished"] == 1


def test_steps_in_this_process_do_the_same(here, crowd, tmp_path):
    said = list(steps_here(crowd, tmp_path))
    assert recordings(tmp_path) == {k: v for k, v in recordings(here[0]).items() if k.startswith("member")}
    assert [fraction for fraction, _ in said] == sorted(fraction for fraction, _ in said) and len(said) == 6


def test_a_member_who_cannot_ski_is_drawn_anew(monkeypatch):
    from ski_addon import pipeline
    from ski_addon.errors import PlanInfeasible

    real, asked = pipeline.make_plan, []

    def refuse_twice(spec):
        asked.append(spec)
        if len(asked) < 3:
            raise PlanInfeasible("turn 1", None, "it is too steep")
        return real(spec)

    monkeypatch.setattr(pipeline, "make_plan", refuse_twice)
    plan = plan_member(crowd_of(2), 0)
    assert plan.member == draw_member(crowd_of(2), 0, 3) and plan.way is not None
    asked.clear()
    plan = plan_member(crowd_of(2, {"crowd.tries": 2}), 0)
    assert plan.way is None and "cannot be skied at turn 1: it is too steep" in plan.problem


def test_members_left_out_are_named_and_the_others_done(tmp_path, capsys):
    changes = {**APART, "crowd.apart": 50, "crowd.delay_max": 0.5, "crowd.count": 2}
    document = write_crowd(crowd_of(2, changes), tmp_path)
    assert cli.main(["crowd", str(document), "-o", str(tmp_path / "out"), "--jobs", "1"]) == 2
    said = capsys.readouterr()
    assert "member 2: no start within 0.5 s keeps it 50 m apart (at best" in said.out
    assert said.err == "ski_addon: 1 of 2 members could not be placed; the others are done\n"
    summary = json.loads((tmp_path / "out" / "crowd.json").read_text())
    assert [member["status"] for member in summary["members"]] == ["finished", "no room"]
    assert list(recordings(tmp_path / "out")) == ["member_001.npz"]


def test_a_crowd_nobody_of_whom_can_ski_says_why(tmp_path, capsys):
    document = write_crowd(crowd_of(2, {"crowd.tries": 1}, course__turn_radius=4, course__start_speed=15), tmp_path)
    assert cli.main(["crowd", str(document), "-o", str(tmp_path / "out"), "--jobs", "1"]) == 2
    said = capsys.readouterr()
    assert "member 1: cannot ski its course" in said.out and "cannot be skied at turn 1" in said.out
    assert said.err == "ski_addon: 2 of 2 members could not be placed; the others are done\n"


def test_a_fall_is_recorded_and_has_its_exit_code(tmp_path, capsys):
    weak = {"skier__strength": 0.42, "technique__balance": "tracking", "course__start_speed": 12}
    weak |= {"course__turn_count": 2, "course__turn_duration": 1.0, "course__transition_duration": 1.5}
    document = write_crowd(crowd_of(1, {"spread.strength": 0, "spread.mass": 0}, **weak), tmp_path)
    assert cli.main(["crowd", str(document), "-o", str(tmp_path / "out"), "--jobs", "1"]) == 5
    said = capsys.readouterr()
    assert "1 of 1 members fell" in said.err and "member 1: " in said.out
    assert Recording.load(tmp_path / "out" / "member_001.npz").status == "fell"


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupt_leaves_no_half_file_and_can_be_gone_on_from(tmp_path, here, crowd, number):
    document = write_crowd(crowd_of(8, APART), tmp_path)
    out = tmp_path / "out"
    process = start(document, "--jobs=2", "-o", out)
    for _ in range(1200):
        if list(out.glob("member_*.npz")) or process.poll() is not None:
            break
        time.sleep(0.05)
    os.killpg(process.pid, number)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    done = len(recordings(out))
    assert 1 <= done < 8 and err.startswith("ski_addon: interrupted: ") and "of 8 members are skied and kept" in err
    assert not [path.name for path in out.iterdir() if ".tmp" in path.name]
    first = recordings(here[0])
    assert all(content == first[name] for name, content in recordings(out).items() if name in first)
    summary = json.loads((out / "crowd.json").read_text())
    assert summary["stopped"] and "waiting" in {member["status"] for member in summary["members"]}
    again = run_crowd(read_crowd(document), out, 0, quiet)
    assert again["kept"] >= done and again["finished"] == 8 and not again["stopped"]


def test_a_member_can_be_stopped_and_writes_nothing(tmp_path, crowd):
    with pytest.raises(Cancelled):
        ski_member(draw_member(crowd, 0), tmp_path, stop=lambda: True)
    assert list(tmp_path.iterdir()) == []


def test_files_of_killed_processes_are_cleaned_up(tmp_path, crowd):
    (tmp_path / ".member_001.99.tmp.npz").write_bytes(b"half")
    next(steps_here(crowd, tmp_path))
    assert not list(tmp_path.glob(".member_*"))


@pytest.mark.parametrize(
    ("arguments", "code", "words"),
    [
        (["medium_carving", "--count=0"], 2, "crowd.count = 0 is outside 1..999 skiers"),
        (["medium_carving", "--count=-3"], 2, "crowd.count = -3 is outside 1..999 skiers"),
        (["medium_carving", "--count=1000"], 2, "crowd.count = 1000 is outside 1..999 skiers"),
        (["medium_carving", "--set=spread.height=0.4"], 2, "spread.height = 0.4 is outside 0..0.3 m"),
        (["medium_carving", "--set=spread.women=1.5"], 2, "spread.women = 1.5 is outside 0..1"),
        (["medium_carving", "--apart=-1"], 2, "crowd.apart = -1 is outside 0..50 m"),
        (["medium_carving", "--interval=nan"], 2, "crowd.start_interval = nan"),
        (["medium_carving", "--part=natrual"], 3, "did you mean natural?"),
        (["snowboard_carving"], 2, 'figure.kind = "snowboard" has no whole physics'),
        (["free_skeing"], 3, "did you mean free_skiing"),
        (["medium_carving", "--count=999", "--set=course.turn_count=500"], 3, "the crowd would take"),
        (["medium_carving", "--seed=x"], 2, 'crowd.seed = "x" is not a whole number'),
        (["medium_carving", "--jobs=0"], 2, "--jobs = 0 is outside 1..1024"),
        (["medium_carving", "--set=spread.hight=0.1"], 2, "did you mean spread.height?"),
        (["medium_carving", "--set=course.turn_radus=3"], 2, "did you mean course.turn_radius?"),
        (["nobody.toml"], 3, "cannot read nobody.toml"),
        (["medium_carving", "-o", "/proc/nothing"], 3, "cannot write /proc/nothing"),
    ],
)
def test_failures_are_one_line_and_leave_nothing(tmp_path, capsys, arguments, code, words):
    output = [] if "-o" in arguments else ["-o", str(tmp_path / "out")]
    assert cli.main(["crowd", *arguments, *output, "--quiet"]) == code
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and words in err, err
    assert list(tmp_path.iterdir()) == []


def test_a_process_that_is_killed_is_told_of(tmp_path, monkeypatch, crowd):
    from concurrent.futures.process import BrokenProcessPool

    from ski_addon.crowd import running

    def broken(*_arguments):
        raise BrokenProcessPool

    monkeypatch.setattr(running, "run_all", broken)
    with pytest.raises(SkiAddonError, match="a process ended unexpectedly"):
        run_crowd(crowd, tmp_path, 1, quiet)
