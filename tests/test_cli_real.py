"""The command line with the real simulation, in processes of its own, on a run of one short turn."""

from __future__ import annotations

import json
import re
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from ski_addon import cli
from ski_addon.spec import RunSpec

ROOT = Path(__file__).resolve().parents[1]
SHORT = [
    f"--set={change}"
    for change in ("course.turn_count=1", "course.turn_duration=0.3", "course.transition_duration=0.4")
]
CONTRACT = (
    "status duration_s steps speed_max inclination_max_deg edge_angle_max_deg snow_force_max_bw torque_ratio_max "
    "ski_error_max_m ski_error_rms_m com_error_max_m root_residual_max unconverged_steps step_us_median step_us_p99 "
    "spec_hash versions"
)


def start(*arguments):
    return subprocess.Popen(
        [sys.executable, "-m", "ski_addon", *map(str, arguments)],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """Outcome of one real `run ... --json`: the folder, the exit code, stdout, stderr."""
    folder = tmp_path_factory.mktemp("real") / "out"
    process = start("run", "paper_main", *SHORT, "-o", folder, "--json")
    out, err = process.communicate(timeout=120)
    return folder, process.returncode, out, err


def files(folder):
    return sorted(path.name for path in folder.iterdir())


def test_run_finishes_and_writes_everything(finished):
    folder, code, _, err = finished
    assert (code, err) == (0, "")
    written = {"recording.npz", "recording.task.json", "spec.toml", "summary.json"}
    assert written <= set(files(folder)) <= written | {"report.png"}


def test_summary_has_the_keys_others_rely_on_and_sane_numbers(finished):
    folder, _, out, _ = finished
    summary = json.loads(out)
    assert summary == json.loads((folder / "summary.json").read_text())
    assert set(CONTRACT.split(" ")) <= set(summary)
    assert summary["status"] == "finished" and summary["steps"] == pytest.approx(300, abs=40)
    assert summary["duration_s"] == pytest.approx(0.3, abs=0.04)
    assert 8.5 < summary["speed_max"] < 9.5 and summary["ski_error_max_m"] < 0.005
    assert summary["spec_hash"] == RunSpec.from_toml(folder / "spec.toml").content_hash()


def test_written_spec_gives_the_same_recording_again_byte_for_byte(finished, tmp_path):
    folder = finished[0]
    assert cli.main(["simulate", str(folder / "spec.toml"), "-o", str(tmp_path), "--quiet"]) == 0
    assert (tmp_path / "recording.npz").read_bytes() == (folder / "recording.npz").read_bytes()
    assert (tmp_path / "spec.toml").read_text() == (folder / "spec.toml").read_text()


def test_report_reads_the_recording(finished, tmp_path):
    pytest.importorskip("matplotlib")
    assert cli.main(["report", str(finished[0]), "-o", str(tmp_path / "plots.png")]) == 0
    assert (tmp_path / "plots.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("keep", [0, 1000, -1])
def test_truncated_recording_is_one_line_and_exit_code_3(finished, tmp_path, capsys, keep):
    broken = tmp_path / "broken.npz"
    broken.write_bytes((finished[0] / "recording.npz").read_bytes()[:keep])
    assert cli.main(["report", str(broken), "-o", str(tmp_path / "a.png")]) == 3
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and str(broken) in err and files(tmp_path) == ["broken.npz"]


def test_too_fast_for_its_radius_names_place_and_speed(tmp_path, capsys):
    arguments = ["--set", "course.turn_radius=10", "--set", "course.start_speed=20"]
    assert cli.main(["run", "paper_main", *arguments, "-o", str(tmp_path / "out")]) == 2
    err = capsys.readouterr().err
    assert err.count("\n") == 1 and re.search(r"at turn \d \(\d+.*a speed of \d+\.\d m/s", err)
    assert files(tmp_path) == []


def test_plan_says_how_fast_and_how_far(tmp_path, capsys):
    assert cli.main(["plan", "giant_slalom", "-o", str(tmp_path / "out"), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary == json.loads((tmp_path / "out" / "plan.json").read_text())
    assert 200 < summary["length_m"] < 350 and 11 < summary["speed_max"] < 16
    assert 25 <= summary["inclination_max_deg"] <= 45
    assert cli.main(["plan", "paper_main", *SHORT]) == 0
    assert "leans up to" in capsys.readouterr().out


def test_interrupt_while_skiing_leaves_a_checkpoint_and_says_so(tmp_path):
    process = start("run", "paper_main", "-o", tmp_path / "out")
    for line in process.stdout:
        if line.startswith("simulating"):
            break
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130
    assert re.fullmatch(r"ski_addon: interrupted at \d+\.\d\d s of skiing: the same command goes on from there\n", err)
    assert files(tmp_path / "out") == ["checkpoint.npz"]
