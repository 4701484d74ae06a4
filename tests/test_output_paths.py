"""Results at places of any kind: full disks, folders in the way, links, and names with all sorts of letters."""

from __future__ import annotations

import contextlib
import io
import json
import os
import resource
import sys
from pathlib import Path

import pytest

from ski_addon import atomic, cli, results
from ski_addon.errors import OutputError
from ski_addon.spec import RunSpec
from ski_addon.talk import Talk, json_text, write_line
from tests.synthetic_recording import synthetic_recording

RESULTS = ["recording.npz", "report.png", "spec.toml", "summary.json"]
NAMES = ["mit leer zeichen", "ä ö ü ß", "雪⛷", "-o", "100%", "$HOME", "a'b\"c", "x" * 250]


@pytest.fixture
def simulation(monkeypatch):
    """Takes the place of planning and simulating."""
    monkeypatch.setattr(
        results,
        "simulate_run",
        lambda spec, progress, checkpoints=None: (synthetic_recording(spec, duration=1.0), {"status": "finished"}),
    )


@contextlib.contextmanager
def disk_of(size: int):
    """Within it, writing more than `size` [bytes] to a file fails, as on a full disk."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, before[1]))
    try:
        yield
    finally:  # before the test runner writes to its own log
        resource.setrlimit(resource.RLIMIT_FSIZE, before)


def files(folder):
    return sorted(path.name for path in folder.iterdir())


def one_line(capsys) -> str:
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and err.startswith("ski_addon: "), err
    return err


@pytest.mark.parametrize("name", NAMES)
def test_folder_of_any_name_takes_the_results(simulation, tmp_path, capsys, name):
    assert cli.main(["simulate", "paper_main", f"--output={tmp_path / name}"]) == 0
    assert files(tmp_path / name) == ["recording.npz", "recording.task.json", "spec.toml", "summary.json"]
    assert f"results in {tmp_path / name}" in capsys.readouterr().out


@pytest.mark.parametrize("name", NAMES)
def test_file_of_any_name_is_written_whole(tmp_path, name):
    atomic.write_text(tmp_path / f"{name}.txt", "x")
    assert files(tmp_path) == [f"{name}.txt"]


def test_name_too_long_for_a_file_says_so_at_its_end(tmp_path):
    with pytest.raises(OutputError, match=r"cannot write \.\.\.x+\.txt: File name too long$"):
        atomic.write_text(tmp_path / ("x" * 300 + ".txt"), "x")
    with pytest.raises(OutputError, match="File name too long$"):
        atomic.check_writable_folder(tmp_path / "/".join(["deep"] * 2000))


def test_folder_deep_down_is_made(simulation, tmp_path):
    deep = tmp_path / "/".join(["deep"] * 40)
    assert cli.main(["simulate", "paper_main", "-o", str(deep), "--quiet"]) == 0
    assert len(files(deep)) == 4


def test_linked_folder_is_written_to(simulation, tmp_path):
    (tmp_path / "real").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "real")
    assert cli.main(["simulate", "paper_main", "-o", str(tmp_path / "link"), "--quiet"]) == 0
    assert (tmp_path / "link").is_symlink() and len(files(tmp_path / "real")) == 4


def test_link_to_nowhere_is_no_folder(simulation, tmp_path, capsys):
    (tmp_path / "link").symlink_to(tmp_path / "nowhere")
    assert cli.main(["simulate", "paper_main", "-o", str(tmp_path / "link"), "--quiet"]) == 3
    assert "link" in one_line(capsys) and files(tmp_path) == ["link"]


def test_link_in_the_place_of_a_result_is_replaced_and_what_it_pointed_to_stays(tmp_path):
    (tmp_path / "precious.txt").write_text("precious")
    (tmp_path / "a.txt").symlink_to(tmp_path / "precious.txt")
    atomic.write_text(tmp_path / "a.txt", "new")
    assert (tmp_path / "a.txt").read_text() == "new" and not (tmp_path / "a.txt").is_symlink()
    assert (tmp_path / "precious.txt").read_text() == "precious"


@pytest.mark.parametrize("name", ["recording.npz", "spec.toml", "summary.json"])
def test_folder_in_the_place_of_a_result_is_named_and_kept(simulation, tmp_path, capsys, name):
    (tmp_path / name).mkdir()
    (tmp_path / name / "mine.txt").write_text("mine")
    assert cli.main(["simulate", "paper_main", "-o", str(tmp_path), "--quiet"]) == 3
    assert f"cannot write {tmp_path / name}: Is a directory" in one_line(capsys)
    assert files(tmp_path / name) == ["mine.txt"] and not [left for left in files(tmp_path) if left.startswith(".")]


@pytest.mark.parametrize("target", ["/", ".", "..", ""])
def test_folder_is_no_target_for_a_file(target):
    with pytest.raises(OutputError, match="it is a folder"):
        atomic.write_text(target, "x")


def test_full_disk_leaves_the_old_text_and_no_half_one(tmp_path):
    target = tmp_path / "a.txt"
    atomic.write_text(target, "old")
    with disk_of(1000), pytest.raises(OutputError, match=r"a\.txt: File too large"):
        atomic.write_text(target, "x" * 5000)
    assert target.read_text() == "old" and files(tmp_path) == ["a.txt"]


@pytest.mark.parametrize("room", [100, 1000, 5000])
def test_disk_that_fills_up_while_writing_a_run_leaves_nothing(simulation, tmp_path, capsys, room):
    """The least takes no file at all, the most all but the report."""
    folder = tmp_path / "out"
    command = "run" if room == 5000 else "simulate"
    with disk_of(room):
        assert cli.main([command, "paper_main", "-o", str(folder), "--quiet"]) == 3
    assert capsys.readouterr().err == f"ski_addon: cannot write {folder}: File too large\n"
    assert files(tmp_path) == []


def test_disk_that_fills_up_while_drawing_leaves_no_picture(tmp_path):
    pytest.importorskip("matplotlib")
    from ski_addon.report import save_report

    recording = synthetic_recording(duration=1.0)
    save_report(recording, tmp_path / "warm_up.png")  # matplotlib writes its font cache when it is first used
    (tmp_path / "warm_up.png").unlink()
    with disk_of(5000), pytest.raises(OutputError, match=r"report\.png: File too large"):
        save_report(recording, tmp_path / "report.png")
    assert files(tmp_path) == []


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_folder_that_may_not_be_written_is_found_out_before_the_run(simulation, tmp_path, capsys):
    tmp_path.chmod(0o500)
    assert cli.main(["run", "paper_main", "-o", str(tmp_path / "out"), "--quiet"]) == 3
    assert "Permission denied" in one_line(capsys)


def test_file_system_that_takes_no_files_is_found_out_before_the_run(monkeypatch, capsys):
    monkeypatch.setattr(results, "simulate_run", lambda *_: pytest.fail("simulated first"))
    assert cli.main(["run", "paper_main", "-o", "/proc/self/out", "--quiet"]) == 3
    assert "cannot write /proc/self/out" in one_line(capsys)


def test_screen_that_lacks_letters_gets_their_codes():
    screen = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    write_line(screen, "Läufe \u26f7 \udcff")
    assert screen.buffer.getvalue() == b"L\\xe4ufe \\u26f7 \\udcff\n"
    screen = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    write_line(screen, "Läufe \udcff")
    assert screen.buffer.getvalue() == "Läufe \\udcff\n".encode()


@pytest.mark.parametrize("json_wanted", [False, True])
def test_run_goes_on_where_the_screen_lacks_letters(simulation, tmp_path, monkeypatch, json_wanted):
    path = tmp_path / "run.toml"
    path.write_text(RunSpec(name="Läufe ⛷").to_toml(), encoding="utf-8")
    screen = io.TextIOWrapper(io.BytesIO(), encoding="ascii")
    monkeypatch.setattr(sys, "stdout", screen)
    arguments = ["simulate", str(path), "-o", str(tmp_path / "雪")] + ["--json"] * json_wanted
    assert cli.main(arguments) == 0
    said = screen.buffer.getvalue().decode("ascii")
    assert json.loads(said) == {"status": "finished"} if json_wanted else "L\\xe4ufe \\u26f7: finished" in said


def test_folder_named_by_bytes_that_are_no_text_is_written_to(simulation, tmp_path, monkeypatch):
    screen = io.TextIOWrapper(io.BytesIO(), encoding="utf-8")
    monkeypatch.setattr(sys, "stdout", screen)
    folder = os.fsdecode(os.fsencode(tmp_path) + b"/\xff\xfe")
    assert cli.main(["simulate", "paper_main", "-o", folder]) == 0
    assert len(os.listdir(folder)) == 4 and b"\\udcff\\udcfe" in screen.buffer.getvalue()


def test_quiet_or_json_talk_says_nothing_to_people(capsys):
    Talk(quiet=True).say("x")
    Talk(json=True).say("x")
    Talk().give({"x": 1})
    assert capsys.readouterr() == ("", "")
    Talk(quiet=True, json=True).give({"x": 1})
    assert json.loads(capsys.readouterr().out) == {"x": 1}


@pytest.mark.parametrize(("json_wanted", "quiet"), [(False, False), (True, False), (False, True), (True, True)])
@pytest.mark.parametrize("terminal", [False, True])
def test_progress_goes_where_it_disturbs_nobody(monkeypatch, json_wanted, quiet, terminal):
    out, err = io.StringIO(), io.StringIO()
    err.isatty = lambda: terminal
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setattr(sys, "stderr", err)
    with Talk(json=json_wanted, quiet=quiet).progress() as progress:
        progress(0.5, "simulating")
    on_terminal = terminal and not quiet
    assert bool(err.getvalue()) == on_terminal
    assert bool(out.getvalue()) == (not quiet and not json_wanted and not terminal)
    if on_terminal:
        assert err.getvalue().endswith("\r")  # wiped again


def test_anything_in_a_summary_becomes_json():
    import numpy as np

    value = {
        1: np.float64("nan"),
        "inf": [float("inf"), -float("inf"), 1.5],
        "array": np.arange(3),
        "flag": np.bool_(True),
        "path": Path("a"),
        "nothing": None,
        "pair": (1, "two"),
    }
    expected = {"1": None, "inf": [None, None, 1.5], "array": [0, 1, 2], "flag": True, "path": "a"}
    assert json.loads(json_text(value)) == expected | {"nothing": None, "pair": [1, "two"]}
