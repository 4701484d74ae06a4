"""Frames of a baked file: the same pixels from one worker and from three, and one line for what cannot be rendered."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from ski_addon.tasks.picture import read_picture
from tests.blender.blender_tools import make_recording

ROOT = Path(__file__).resolve().parents[2]
SMALL = ("--size", "64x36")
CYCLES = (*SMALL, "--samples", "2", "--no-denoise")
PROGRAM = [sys.executable, "-m", "ski_addon"]


@pytest.fixture(scope="module")
def blend(core, tmp_path_factory):
    """A baked file of a short run, with no receipt."""
    recording = make_recording(core)
    target = tmp_path_factory.mktemp("baked") / "skier.blend"
    core("blender.headless").bake_file(recording, core("blender.bake").recorded_run(recording), target)
    return target


@pytest.fixture
def render(core, capsys):
    def call(blend, folder, *words):
        code = core("cli").main(["render", str(blend), "-o", str(folder), *words])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


def pixels(folder):
    return {path.name: read_picture(path.read_bytes()).pixels for path in sorted(folder.iterdir())}


def start(*words):
    return subprocess.Popen(
        [*PROGRAM, *map(str, words)], cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )


def test_three_workers_out_of_order_make_the_pixels_of_one(render, blend, tmp_path):
    workers = []
    for part in ("5-6", "1-2", "3-4"):
        workers.append(start("render", blend, "-o", tmp_path / "three", "--frames", part, *CYCLES))
    assert render(blend, tmp_path / "one", "--frames", "1-6", *CYCLES)[0] == 0
    for worker in workers:
        out, err = worker.communicate(timeout=300)
        assert (worker.returncode, err) == (0, ""), out
    one = pixels(tmp_path / "one")
    assert len(set(one.values())) == 6 and pixels(tmp_path / "three") == one
    assert [path.read_bytes() for path in sorted((tmp_path / "one").iterdir())] == [
        path.read_bytes() for path in sorted((tmp_path / "three").iterdir())
    ]
    assert "up to date" in render(blend, tmp_path / "three", "--frames", "1-6", *CYCLES)[1]


def test_workbench_renders_the_asked_size(render, blend, tmp_path):
    assert render(blend, tmp_path, "--frames", "2", "--engine", "workbench", *SMALL)[0] == 0
    picture = read_picture((tmp_path / "frame_0002.png").read_bytes())
    assert picture.size == (64, 36) and (tmp_path / "frame_0002.png").stat().st_size > 1000


def test_film_is_sharp_until_the_shutter_is_opened(render, blend, tmp_path):
    for name, words in {"sharp": (), "blurred": ("--motion-blur", "1"), "again": ("--motion-blur", "1.0")}.items():
        assert render(blend, tmp_path / name, "--frames", "4", *CYCLES, *words)[0] == 0
    sharp, blurred, again = (pixels(tmp_path / name) for name in ("sharp", "blurred", "again"))
    assert blurred == again != sharp


def test_new_file_says_itself_how_it_is_rendered(blend):
    code = f"""
import bpy
bpy.ops.wm.open_mainfile(filepath={str(blend)!r})
scene, render = bpy.context.scene, bpy.context.scene.render
print("TOLD", render.engine, scene.cycles.samples, render.resolution_x, render.resolution_y, flush=True)
import os; os._exit(0)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert "TOLD CYCLES 64 1920 1080" in done.stdout


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda content: content[:-100], "it is cut short: bake it again"),
        (lambda content: content[: len(content) // 3], "it is cut short: bake it again"),
        (lambda content: b"", "it is not a .blend file"),
        (lambda content: b"hello", "it is not a .blend file"),
        (lambda content: content[:3000] + b"\x55" * 4000 + content[7000:], ""),
    ],
)
def test_spoiled_file_is_one_line(render, blend, tmp_path, spoil, words):
    (tmp_path / "spoiled.blend").write_bytes(spoil(blend.read_bytes()))
    code, out, err = render(tmp_path / "spoiled.blend", tmp_path / "frames", "--frames", "1", *CYCLES)
    assert code == 3 and err.count("\n") == 1 and "spoiled.blend" in err and words in err, (out, err)
    assert not (tmp_path / "frames").exists()


def test_device_that_is_not_there_is_one_line(render, blend, tmp_path):
    code, _, err = render(blend, tmp_path / "frames", "--frames", "1", "--device", "optix", *SMALL)
    assert code == 7 and err.count("\n") == 1 and "--device OPTIX" in err and "use --device CPU" in err


def test_scripts_in_a_file_are_not_run(render, blend, tmp_path):
    witness = tmp_path / "run"
    code = f"""
import bpy
bpy.ops.wm.open_mainfile(filepath={str(blend)!r})
text = bpy.data.texts.new("at_once.py")
text.write("open({str(witness)!r}, 'w').close()")
text.use_module = True
bpy.context.preferences.filepaths.use_scripts_auto_execute = True
bpy.ops.wm.save_as_mainfile(filepath={str(tmp_path / "scripted.blend")!r})
import os; os._exit(0)
"""
    subprocess.run([sys.executable, "-c", code], capture_output=True, timeout=120, check=False)
    assert render(tmp_path / "scripted.blend", tmp_path / "frames", "--frames", "1", *CYCLES)[0] == 0
    assert not witness.exists()


def test_file_without_a_camera_is_one_line(render, scene, tmp_path):
    import bpy

    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "empty.blend"))
    code, _, err = render(tmp_path / "empty.blend", tmp_path / "frames", "--frames", "1", *SMALL)
    assert code == 7 and err.count("\n") == 1 and "its scene has no camera" in err


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupt_ends_a_long_frame_at_once(blend, tmp_path, number):
    words = ("--frames", "1-2", "--samples", "60000", "--size", "1920x1080", "--no-denoise")
    with start("render", blend, "-o", tmp_path / "frames", *words, "--openjd") as process:
        for line in process.stdout:
            if line.startswith("openjd_status: rendering"):
                break
        time.sleep(3.0)  # into the frame
        begin = time.monotonic()
        process.send_signal(number)
        out, err = process.communicate(timeout=60)
    assert process.returncode == 130 and time.monotonic() - begin < 10.0
    assert err == "ski_addon: interrupted: what is finished is kept\n" and "openjd_fail: interrupted" in out
    assert os.listdir(tmp_path / "frames") == []


def test_command_inside_blender_is_the_same_command_line(core, extension, capfd, tmp_path):
    run = core("blender.command_line").run
    assert run(["validate", "giant_slalom"]) == 0 and "giant_slalom: " in capfd.readouterr().out
    assert run(["validate", "nowhere"]) == 3
    assert run(["fly"]) == 2 and "blender --command ski: " in capfd.readouterr().err
    words = ["--set", "course.turn_count=1", "--set", "simulation.time_step=0.004", "--jobs", "2"]
    assert run(["sweep", "paper_main", "--vary", "skier.mass=50,60", *words, "-o", str(tmp_path / "sweep")]) == 0
    assert "2 runs: 2 finished" in capfd.readouterr().out
