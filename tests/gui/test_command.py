"""`blender --command ski` in a real Blender: the same commands, files and exit codes as `python -m ski_addon`."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

import pytest

from tests.gui.in_window import blender, in_window, zip_path

pytestmark = in_window
SHORT = ("--set", "course.turn_count=1", "--set", "simulation.time_step=0.002")
SMALL = ("--frames", "20-21", "--size", "96x54", "--samples", "2")


@pytest.fixture(scope="module")
def user(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A user's folder with the extension installed."""
    folder = tmp_path_factory.mktemp("user")
    call(folder, "extension", "install-file", "-r", "user_default", "-e", zip_path())
    return folder


def call(user: Path, *words: object) -> subprocess.CompletedProcess[str]:
    """Run one command of Blender."""
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(user)}
    command = [blender(), "--command", *map(str, words)]
    return subprocess.run(command, env=environment, capture_output=True, text=True, timeout=300, check=False)


def test_run_is_simulated_baked_and_rendered(user: Path, tmp_path: Path) -> None:
    for words in (
        ("simulate", "paper_main", *SHORT, "-o", tmp_path),
        ("bake", tmp_path),
        ("render", tmp_path / "skier.blend", "-o", tmp_path / "frames", *SMALL),
    ):
        done = call(user, "ski", *words)
        assert done.returncode == 0, done.stderr[-2000:]
        assert "up to date" in call(user, "ski", *words).stdout
    assert sorted(path.name for path in (tmp_path / "frames").iterdir()) == ["frame_0020.png", "frame_0021.png"]


def test_runs_of_a_sweep_have_processes_of_their_own(user: Path, tmp_path: Path) -> None:
    done = call(user, "ski", "sweep", "paper_main", *SHORT, "--vary", "skier.mass=50,60", "--jobs", 2, "-o", tmp_path)
    assert done.returncode == 0 and "2 runs: 2 finished" in done.stdout


@pytest.mark.parametrize(("words", "code"), [(["fly"], 2), (["validate", "nowhere"], 3), (["bake", "none.npz"], 3)])
def test_failures_have_their_exit_codes(user: Path, words: list[str], code: int) -> None:
    done = call(user, "ski", *words)
    assert done.returncode == code and "Traceback" not in done.stderr
