"""The commands that need Blender, with stand-ins for it: bake and demo."""

from __future__ import annotations

import importlib.util
import json

import pytest

from ski_addon import cli, results
from ski_addon.errors import RecordingError, RenderError
from ski_addon.spec import RunSpec
from tests.synthetic_recording import synthetic_recording


@pytest.fixture
def blender(monkeypatch):
    """Stand-ins for everything behind `results`; what was baked or rendered is remembered."""
    done = {}
    recorded = synthetic_recording(RunSpec(name="Recorded"))

    def bake(recording, spec, target):
        done["bake"] = (recording, spec, target)
        target.write_text("BLENDER")

    def strobe(recording, spec, target):
        done["strobe"] = target
        target.write_text("PNG")

    def simulate(spec, progress, checkpoints=None):
        progress(1.0, "simulating")
        return synthetic_recording(spec, status=done.get("status", "finished")), {"status": "finished"}

    def load(path):
        if not path.exists():
            raise RecordingError(path, "there is no such file")
        return recorded

    monkeypatch.setattr(results.apart, "is_apart", lambda: True)  # all in this process
    for name, stand_in in {
        "check_blender": lambda needed_for: None,
        "bake": bake,
        "render_strobe": strobe,
        "simulate_run": simulate,
        "load_recording": load,
    }.items():
        monkeypatch.setattr(results, name, stand_in)
    return done


@pytest.fixture
def run(capsys):
    def call(*arguments):
        code = cli.main([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


def files(folder):
    return sorted(path.name for path in folder.iterdir())


@pytest.mark.parametrize("source", ["", "recording.npz"])
def test_bake_takes_a_recording_or_its_folder_and_writes_beside_it(run, blender, tmp_path, source):
    (tmp_path / "recording.npz").write_text("")
    code, out, err = run("bake", tmp_path / source if source else tmp_path)
    assert (code, err) == (0, "") and f"wrote {tmp_path / 'skier.blend'}" in out
    assert blender["bake"][1].name == "Recorded" and (tmp_path / "skier.blend").exists()


def test_bake_is_not_done_twice_and_a_file_that_was_touched_is_made_again(run, blender, tmp_path):
    (tmp_path / "recording.npz").write_text("one")
    assert "wrote" in run("bake", tmp_path)[1]
    blender.clear()
    assert run("bake", tmp_path) == (0, f"{tmp_path / 'skier.blend'}: up to date\n", "") and not blender
    (tmp_path / "skier.blend").write_text("saved by somebody")
    assert "skier.blend is not as it was written, made again" in run("bake", tmp_path)[1]
    (tmp_path / "recording.npz").write_text("two")
    assert "skier.blend was made from something else, made again" in run("bake", tmp_path)[1]
    assert "made from something else" in run("bake", tmp_path, "--set", "bake.fps=30")[1]
    assert "asked for, made again" in run("bake", tmp_path, "--set", "bake.fps=30", "--redo")[1]


def test_heights_of_a_recording_may_lie_elsewhere(run, blender, tmp_path):
    (tmp_path / "recording.npz").write_text("")
    code, _, err = run("bake", tmp_path, "--set", f"slope.grid_file={tmp_path / 'moved.npz'}")
    assert (code, err) == (0, "")
    assert blender["bake"][1].slope.grid_file == str(tmp_path / "moved.npz")


def test_bake_settings_of_a_recording_can_be_changed_but_not_its_physics(run, blender, tmp_path):
    (tmp_path / "recording.npz").write_text("")
    code, out, _ = run("bake", tmp_path, "--set", "bake.fps=30", "-o", tmp_path / "out" / "a.blend", "--json")
    assert code == 0 and json.loads(out)["blend"].endswith("a.blend")
    assert blender["bake"][1].bake.fps == 30.0 and blender["bake"][2] == tmp_path / "out" / "a.blend"
    code, _, err = run("bake", tmp_path, "--set", "skier.mass=80", "-o", tmp_path / "b.blend")
    assert code == 2 and "skier.mass cannot be changed in a recording" in err
    code, _, err = run("bake", tmp_path, "--part", "soft", "-o", tmp_path / "b.blend")
    assert code == 2 and "--part cannot be laid over a recording" in err
    assert not (tmp_path / "b.blend").exists()


def test_bake_of_a_run_simulates_first(run, blender, tmp_path):
    code, _, err = run("bake", "paper_main", "--set", "skier.mass=80", "-o", tmp_path / "a.blend")
    assert (code, err) == (0, "") and blender["bake"][1].skier.mass == 80.0
    blender["status"] = "fell"
    code, _, err = run("bake", "paper_main", "-o", tmp_path / "b.blend")
    assert code == 5 and err.count("\n") == 1 and files(tmp_path) == ["a.blend", "a.task.json"]


def test_bake_of_a_missing_recording_leaves_no_folder(run, blender, tmp_path):
    code, _, err = run("bake", tmp_path / "none.npz", "-o", tmp_path / "out" / "a.blend")
    assert code == 3 and "there is no such file" in err and files(tmp_path) == []


@pytest.mark.parametrize("arguments", [["bake", "paper_main", "-o"], ["demo", "-o"], ["render", "x.npz", "-o"]])
def test_without_blender_one_line_and_exit_code_4_before_anything_is_done(run, monkeypatch, tmp_path, arguments):
    find = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "bpy" else find(name))
    monkeypatch.delitem(results.sys.modules, "bpy", raising=False)
    code, out, err = run(*arguments, tmp_path / "out")
    assert (code, out) == (4, "") and err.count("\n") == 1 and "Blender is needed for" in err
    assert files(tmp_path) == []


def test_demo_writes_all_it_promises(run, blender, tmp_path):
    code, out, err = run("demo", "-o", tmp_path)
    assert (code, err) == (0, "") and "Giant slalom: finished" in out
    assert files(tmp_path) == [
        "recording.npz",
        "recording.task.json",
        "report.png",
        "skier.blend",
        "spec.toml",
        "strobe.png",
        "summary.json",
    ]


def test_picture_that_cannot_be_rendered_is_exit_code_7(run, blender, monkeypatch, tmp_path):
    def fail(recording, spec, target):
        raise RenderError("Cycles could not render strobe.png: no device")

    monkeypatch.setattr(results, "render_strobe", fail)
    (tmp_path / "recording.npz").write_text("")
    code, _, err = run("render", tmp_path)
    assert code == 7 and err == "ski_addon: Cycles could not render strobe.png: no device\n"


def test_picture_of_a_recording_is_rendered_beside_it(run, blender, tmp_path):
    (tmp_path / "recording.npz").write_text("")
    code, out, err = run("render", tmp_path)
    assert (code, err) == (0, "") and out == f"wrote {tmp_path / 'strobe.png'}\n"
    assert (tmp_path / "strobe.png").read_text() == "PNG"


def test_demo_leaves_blender_to_other_processes(run, blender, monkeypatch, tmp_path):
    started = []

    def run_apart(arguments):
        started.append(arguments[0])
        results.Path(arguments[-1]).write_text("made apart")

    monkeypatch.setattr(results.apart, "is_apart", lambda: False)
    monkeypatch.setattr(results.apart, "run_apart", run_apart)
    code, out, err = run("demo", "-o", tmp_path, "--json")
    assert (code, err, started) == (0, "", ["bake", "render"]) and json.loads(out)["status"] == "finished"
    assert (tmp_path / "skier.blend").read_text() == (tmp_path / "strobe.png").read_text() == "made apart"
    assert "bake" not in blender and len(files(tmp_path)) == 7


def test_report_is_drawn_beside_the_recording(run, blender, tmp_path):
    (tmp_path / "recording.npz").write_text("")
    code, out, err = run("report", tmp_path)
    assert (code, err) == (0, "") and (tmp_path / "report.png").read_bytes().startswith(b"\x89PNG")
    assert run("report", tmp_path / "recording.npz", "-o", tmp_path / "other.png")[0] == 0
    assert files(tmp_path) == ["other.png", "other.task.json", "recording.npz", "report.png", "report.task.json"]


def test_the_end_of_a_run_is_rendered_when_asked_for(run, blender, monkeypatch, tmp_path):
    asked = []
    monkeypatch.setattr(results, "render_strobe", lambda *_, **options: asked.append(options))
    (tmp_path / "recording.npz").write_text("")
    assert run("render", tmp_path, "--stop")[0] == 0
    assert run("render", tmp_path)[0] == 0
    assert asked == [{"stop": True}, {}]


def test_a_process_apart_is_asked_for_the_end_too(run, blender, monkeypatch, tmp_path):
    started = []
    monkeypatch.setattr(results.apart, "is_apart", lambda: False)
    monkeypatch.setattr(results.apart, "run_apart", started.append)
    (tmp_path / "recording.npz").write_text("")
    assert run("render", tmp_path, "--stop")[0] == 0
    assert started[0][0] == "render" and started[0][-1] == "--stop"
