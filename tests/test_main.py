"""The module as a program, and which libraries are there."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import pytest

from ski_addon import apart, cli, results
from ski_addon.dependencies import WHEELS, missing_dependencies
from ski_addon.errors import BlenderMissingError

ROOT = Path(__file__).resolve().parents[1]


def program(*arguments, code=None, **environment):
    start = ["-c", code] if code else ["-m", "ski_addon", *arguments]
    return subprocess.run(
        [sys.executable, *start], cwd=ROOT, capture_output=True, text=True, env=os.environ | environment, timeout=60
    )


def test_program_answers_with_its_exit_code():
    done = program("validate", "paper_main", "nowhere")
    assert done.returncode == 3 and done.stdout.count("\n") == 1
    assert done.stderr.startswith("ski_addon: cannot read nowhere: ") and done.stderr.count("\n") == 1


def test_program_validates_without_loading_the_physics():
    code = "import sys; from ski_addon.cli import main; assert main(['validate', 'paper_main', '--json']) == 0; "
    code += "sys.exit(10 * any(name in sys.modules for name in ('mujoco', 'osqp', 'scipy', 'matplotlib', 'bpy')))"
    assert program(code=code).returncode == 0


def test_reader_that_leaves_early_is_no_failure():
    code = "import os, sys; from ski_addon.cli import main; r, w = os.pipe(); os.close(r); os.dup2(w, 1); "
    code += "sys.exit(main(['validate', *['paper_main'] * 50]))"
    done = program(code=code)
    assert (done.returncode, done.stderr) == (0, "")


def test_screen_without_our_letters_gets_a_run_all_the_same(tmp_path):
    path = tmp_path / "lauf.toml"
    path.write_text((ROOT / "presets/runs/paper_main.toml").read_text().replace("Paper, main case", "Läufe ⛷"))
    done = program("validate", str(path), PYTHONIOENCODING="ascii:strict")
    assert done.returncode == 0 and r"L\xe4ufe \u26f7" in done.stdout


def test_end_is_at_once_where_blenders_module_was_loaded():
    code = "import atexit, sys, runpy, types; sys.modules['bpy'] = types.ModuleType('bpy'); "
    code += "atexit.register(print, 'torn down'); sys.argv = ['ski_addon', '--version']; "
    code += "runpy.run_module('ski_addon', run_name='__main__')"
    done = program(code=code)
    assert done.returncode == 0 and done.stdout.startswith("Ski Addon ") and "torn down" not in done.stdout


@pytest.mark.parametrize(
    ("failure", "code", "words"),
    [
        (MemoryError(), 3, "not enough memory: shorten the course"),
        (KeyboardInterrupt(), 130, "interrupted: no half-written file is left"),
        (OSError(5, "Input/output error", "/dev/x"), 3, "/dev/x: Input/output error"),
        (OSError(5, "Input/output error"), 3, "input or output: Input/output error"),
    ],
)
def test_failure_of_the_machine_is_one_line(monkeypatch, capsys, failure, code, words):
    def fail(*_):
        raise failure

    monkeypatch.setattr("ski_addon.commands._read_spec", fail)
    assert cli.main(["plan", "paper_main"]) == code
    assert capsys.readouterr() == ("", f"ski_addon: {words}\n")


def test_blender_is_looked_for_and_not_imported(monkeypatch):
    monkeypatch.delitem(sys.modules, "bpy", raising=False)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(BlenderMissingError, match="Blender is needed for baking"):
        results.check_blender("baking")
    monkeypatch.setitem(sys.modules, "bpy", object())
    results.check_blender("baking")  # inside Blender its module is there without a file to find


def test_inside_blender_its_own_streams_are_left_alone(monkeypatch, capfd):
    monkeypatch.setattr(apart, "inside_blender", lambda: True)
    with apart.silenced():
        os.write(1, b"heard\n")
    assert capfd.readouterr().out == "heard\n"


def test_process_apart_keeps_the_callers_python_path(monkeypatch, tmp_path):
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    code = f"import sys; assert {str(tmp_path)!r} in sys.path and {str(apart.ROOT)!r} in sys.path"
    apart.run_apart(["-c", code], [sys.executable])


def test_missing_libraries_are_named_in_order(monkeypatch):
    assert missing_dependencies() == []
    monkeypatch.setattr("ski_addon.dependencies.find_spec", lambda name: None if name in ("osqp", "scipy") else name)
    assert missing_dependencies() == [name for name in WHEELS if name in ("osqp", "scipy")]
