"""Bundles as Open Job Description's own tools read and run them."""

from __future__ import annotations

import importlib.util
import json
import os
import shutil
import signal
import subprocess
import sys
import time

import matplotlib.image
import numpy as np
import pytest

from ski_addon import apart, cli
from ski_addon.farm import local_run
from ski_addon.farm.job import FarmJob
from ski_addon.farm.submitting import write_job
from ski_addon.simulation import Recording
from ski_addon.spec import RunSpec

TWO_SECONDS = ("--set", "course.turn_count=1", "--set", "course.turn_duration=2", "--set", "simulation.time_step=0.002")
KINDS = {
    "plain": (),
    "one frame": ("--frames", "7"),
    "several ranges": ("--frames", "0-3,10-40", "--chunk", "7"),
    "steps": ("--frames", "1-100:5,200", "--chunk", "6"),
    "chunked steps": ("--chunking", "--frames", "1-100:5,200", "--chunk", "6"),
    "chunking": ("--chunking", "--frames", "1-20,30", "--chunk", "8"),
    "sweep": ("--vary", "course.turn_radius=10,15.5", "--vary", "simulation.seed=1-3", "--frames", "1-20"),
    "pairs": ("--vary", "skier.mass=60,70", "--vary", "course.first_turn=left,right", "--pairs", "--frames", "1-20"),
    "chunked sweep": ("--vary", "technique.angulation=auto,-0.5", "--chunking", "--frames", "1-20"),
    "blender with needs": ("--workers", "blender", "--cores", "4", "--memory", "8"),
}
TASKS = {
    **{"plain": 6, "one frame": 3, "several ranges": 7, "chunking": 23, "sweep": 24, "pairs": 8},
    **{"steps": 6, "chunked steps": 23, "chunked sweep": 44, "blender with needs": 6},
}
"""Tasks by openjd's count, which takes every frame of a chunk for one."""


def openjd(*arguments, folder=None):
    """Run openjd as its users do; returns exit code and everything it said."""
    done = subprocess.run(
        [sys.executable, "-m", "openjd", *map(str, arguments)],
        capture_output=True,
        text=True,
        cwd=folder,
        env=os.environ | {"PYTHONPATH": apart.python_path()},
        timeout=500,
    )
    return done.returncode, done.stdout + done.stderr


@pytest.mark.usefixtures("quick_plans")
@pytest.mark.parametrize("kind", KINDS)
def test_openjd_checks_and_sums_up(submit, tmp_path, kind):
    bundle = tmp_path / 'it\'s a "bundle"'
    assert submit("paper_main", "-o", bundle, "--set", 'name=Turn {{Param.Left}} "or" right', *KINDS[kind])[0] == 0
    code, said = openjd("check", bundle / "template.json")
    assert (code, "passes validation checks" in said) == (0, True), said
    code, said = openjd("summary", bundle / "template.json")
    assert code == 0, said
    assert "Summary for 'Turn {{Param.Left}} \"or\" right'" in said
    assert f"(PATH): {bundle / 'input'}\n" in said  # relative to the template, wherever openjd is started
    assert f"Total tasks: {TASKS[kind]}\n" in said


def test_a_wrong_template_is_found_by_the_check(submit, tmp_path, quick_plans):
    submit("paper_main", "-o", tmp_path)
    template = tmp_path / "template.json"
    template.write_text(template.read_text().replace('"dependsOn": "Bake"', '"dependsOn": "Bakee"'))
    assert openjd("check", template)[0] == 1


@pytest.fixture
def stand_in(tmp_path):
    """A bundle whose program is a script of the test's instead of this library; returns the function that runs it."""

    def run(script):
        program = tmp_path / "program"
        program.write_text(f"#!{sys.executable}\n{script}")
        program.chmod(0o755)
        job = FarmJob("Stand-in", {"spec.toml": ""}, (1, 2, 3, 4), 2)
        folder = tmp_path / 'it\'s a "bundle" $HOME'
        write_job(job, folder, "openjd")
        template = folder / "template.json"
        template.write_text(template.read_text().replace('"default": "python"', f'"default": "{program}"'))
        said = []
        local_run.run_bundle(folder, FarmJob("Stand-in", {}, (1, 2, 3, 4), 2, workers="blender"), said.append)
        return folder, said

    return run


TELL = 'import json, os, sys; print("TOLD", json.dumps([os.environ["SKI_ADDON_OPENJD"], *sys.argv[1:]]), flush=True)'


def told(said):
    return [json.loads(line.partition("TOLD ")[2]) for line in said if "TOLD " in line]


def test_tasks_get_whole_paths_in_order(stand_in):
    folder, said = stand_in(TELL)
    run, blend, frames = (str(folder / "output" / name) for name in ("run", "skier.blend", "frames"))
    ski = ["1", "-m", "ski_addon"]
    assert told(said) == [
        [*ski, "simulate", str(folder / "input" / "spec.toml"), "--output", run],
        [*ski, "bake", run, "--output", blend],
        [*ski, "render", blend, "--output", frames, "--frames", "1-2"],
        [*ski, "render", blend, "--output", frames, "--frames", "3-4"],
    ]


def test_a_failed_task_stops_the_run_with_its_message_and_exit_code(stand_in):
    script = f'{TELL}\nif sys.argv[3] == "bake": print("openjd_fail: Blender is missing"); sys.exit(4)'
    with pytest.raises(local_run.SkiAddonError, match="the job failed: Blender is missing") as caught:
        stand_in(script)
    assert caught.value.exit_code == 4


def test_paths_are_mapped_to_where_a_worker_has_them(submit, tmp_path, quick_plans):
    bundle = tmp_path / "here"
    submit("paper_main", "-o", bundle, "--frames", "1")
    (tmp_path / "there").mkdir()
    shutil.move(bundle / "input", tmp_path / "there" / "input")
    rule = {"source_path_format": "POSIX", "source_path": str(bundle), "destination_path": str(tmp_path / "there")}
    rules = json.dumps({"version": "pathmapping-1.0", "path_mapping_rules": [rule]})
    program = tmp_path / "program"
    program.write_text(f"#!{sys.executable}\n{TELL}")
    program.chmod(0o755)
    code, said = openjd("run", bundle / "template.json", "-p", f"Python={program}", "--path-mapping-rules", rules)
    assert code == 0, said
    for arguments in told(said.splitlines()):
        assert str(bundle) not in "".join(arguments)
        assert str(tmp_path / "there") in arguments[4]


def test_ctrl_c_stops_the_task_and_leaves_nothing_running(tmp_path, quick_plans):
    """The task is told to stop and may clean up."""
    program = tmp_path / "program"
    program.write_text(
        f"#!{sys.executable}\nimport os, pathlib, signal, sys, time\nhere = pathlib.Path({str(tmp_path)!r})\n"
        "def stop(*_):\n    (here / 'stopped').touch()\n    sys.exit(130)\n"
        "signal.signal(signal.SIGTERM, stop)\n(here / 'pid').write_text(str(os.getpid()))\ntime.sleep(60)\n"
    )
    program.chmod(0o755)
    submitted = tmp_path / "bundle"
    code = cli.main(["submit", "paper_main", "-o", str(submitted), "--frames", "1", "--workers", "blender", "--quiet"])
    assert code == 0
    (tmp_path / "blender").symlink_to(program)
    process = subprocess.Popen(
        [sys.executable, "-m", "ski_addon", "submit", "paper_main", "-o", str(submitted)]
        + ["--frames", "1", "--workers", "blender", "--run"],
        env=os.environ | {"PYTHONPATH": apart.python_path(), "PATH": f"{tmp_path}{os.pathsep}{os.environ['PATH']}"},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
    )
    wait_for(lambda: (tmp_path / "pid").exists() and (tmp_path / "pid").read_text())
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=60)
    assert process.returncode == 130, err
    assert err.count("\n") == 1
    assert (tmp_path / "stopped").exists()
    with pytest.raises(ProcessLookupError):
        os.kill(int((tmp_path / "pid").read_text()), 0)


def wait_for(condition, seconds=60.0):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline
        time.sleep(0.05)


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="baking needs bpy")
def test_a_run_of_two_seconds_is_simulated_baked_and_rendered(submit, tmp_path, capsys):
    """All of it, in this environment alone: bundle, check, summary, run; then the same again, which finds it done."""
    bundle = tmp_path / 'it\'s a "bundle"'
    options = ("--frames", "1-5", "--chunk", "2", "--render", "size=160x90", "--render", "engine=workbench")
    code, out, err = submit("paper_main", *TWO_SECONDS, "-o", bundle, *options, "--run")
    assert code == 0, out + err
    assert openjd("check", bundle / "template.json")[0] == 0
    assert openjd("summary", bundle / "template.json")[0] == 0
    output = bundle / "output"
    assert 1.9 < Recording.load(output / "run" / "recording.npz").duration < 2.2
    pictures = sorted((output / "frames").glob("*.png"))
    assert len(pictures) == 5
    pixels = [matplotlib.image.imread(picture) for picture in pictures]
    assert {picture.shape[:2] for picture in pixels} == {(90, 160)}
    assert all(picture.std() > 0.02 for picture in pixels)  # something is to be seen
    assert abs(pixels[0] - pixels[-1]).max() > 0.1  # and it moves
    before = {path: path.stat().st_mtime_ns for path in output.rglob("*.*")}
    assert submit("paper_main", *TWO_SECONDS, "-o", bundle, *options, "--run")[0] == 0
    assert {path: path.stat().st_mtime_ns for path in output.rglob("*.*")} == before


@pytest.mark.slow
@pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="baking needs bpy")
def test_a_worker_elsewhere_bakes_what_another_simulated(submit, tmp_path):
    """Simulated in one place, baked in another: the recording names its ground by a path that is gone."""
    heights = -0.15 * np.arange(0.0, 120.0, 2.0)[:, None] + np.zeros(40)
    np.save(tmp_path / "hill.npy", heights)
    slope = (
        "--set",
        "slope.kind=grid",
        "--set",
        f"slope.grid_file={tmp_path / 'hill.npy'}",
        "--set",
        "slope.grid_spacing=2",
    )
    code, out, err = submit("paper_main", *TWO_SECONDS, *slope, "-o", tmp_path / "here", "--frames", "1")
    assert code == 0, out + err
    python = ("-p", f"Python={sys.executable}")
    code, said = openjd("run", tmp_path / "here" / "template.json", "--step", "Simulate", *python)
    assert code == 0, said
    (tmp_path / "hill.npy").unlink()
    shutil.move(tmp_path / "here", tmp_path / "there")
    code, said = openjd("run", tmp_path / "there" / "template.json", "--step", "Bake", "--no-run-dependencies", *python)
    assert code == 0, said
    assert (tmp_path / "there" / "output" / "skier.blend").stat().st_size > 10_000


@pytest.mark.slow
def test_a_sweep_simulates_every_run_into_its_folder(submit, tmp_path):
    vary = ("--vary", "course.turn_radius=14,16", "--vary", "simulation.seed=1,2", "--frames", "1")
    assert submit("paper_main", *TWO_SECONDS, *vary, "-o", tmp_path)[0] == 0
    python = ("-p", f"Python={sys.executable}")
    code, said = openjd("run", tmp_path / "template.json", "--step", "Simulate", *python)
    assert code == 0, said
    for radius in (14, 16):
        for seed in (1, 2):
            folder = tmp_path / "output" / f"course.turn_radius={radius}" / f"simulation.seed={seed}" / "run"
            spec = RunSpec.from_toml(folder / "spec.toml")
            assert (spec.course.turn_radius, spec.simulation.seed) == (radius, seed)
            assert (folder / "recording.npz").is_file()
