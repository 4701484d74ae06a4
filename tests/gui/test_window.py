"""The main job in a real window, by mouse: Plan, Simulate, Esc, Simulate, Bake.

Needs SKI_ADDON_BLENDER (the command of a Blender with a window), SKI_ADDON_ZIP (a zip that fits its Python), DISPLAY,
and ImageMagick's `import` for the screenshots, which are left in out/gui to be looked at.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import time
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
SHOTS = ROOT / "out" / "gui"
NEEDED = ("SKI_ADDON_BLENDER", "SKI_ADDON_ZIP", "DISPLAY")
MINUTES = 6

pytestmark = [
    pytest.mark.gui,
    pytest.mark.skipif(any(not os.environ.get(name) for name in NEEDED), reason=f"needs {', '.join(NEEDED)}"),
]


def take_screenshots(folder: Path) -> None:
    """Serve the requests of the script in the window."""
    for request in folder.glob("*.shot"):
        subprocess.run(["import", "-window", "root", str(SHOTS / f"{request.stem}.png")], timeout=60, check=True)
        request.unlink()


@pytest.fixture(scope="module")
def outcome(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """What the script in the window wrote when it was done."""
    folder, user = tmp_path_factory.mktemp("window"), tmp_path_factory.mktemp("user")
    shutil.rmtree(SHOTS, ignore_errors=True)
    SHOTS.mkdir(parents=True)
    blender, environment = os.environ["SKI_ADDON_BLENDER"], os.environ | {"BLENDER_USER_RESOURCES": str(user)}
    install = [blender, "--command", "extension", "install-file", "-r", "user_default", "-e"]
    install.append(str(Path(os.environ["SKI_ADDON_ZIP"]).resolve()))
    subprocess.run(install, env=environment, timeout=180, check=True)
    command = [blender, "--window-geometry", "0", "0", "1600", "1000", "--enable-event-simulate"]
    command += ["--python", str(ROOT / "tests" / "gui" / "drive.py"), "--", str(folder)]
    log = SHOTS / "blender.log"
    with log.open("w") as stream:
        process = subprocess.Popen(command, env=environment, stdout=stream, stderr=subprocess.STDOUT)
        try:
            end = time.monotonic() + 60 * MINUTES
            while process.poll() is None and time.monotonic() < end:
                take_screenshots(folder)
                time.sleep(0.2)
        finally:
            process.kill()
            process.wait()
    assert (folder / "result.json").exists(), f"no result after {MINUTES} minutes:\n{log.read_text()[-2000:]}"
    return json.loads((folder / "result.json").read_text())


def test_everything_was_done_by_mouse(outcome: dict[str, Any]) -> None:
    assert not outcome["error"], outcome["error"]
    assert outcome["steps"] == ["plan", "stop", "simulate", "bake"]


def test_the_plan_was_told(outcome: dict[str, Any]) -> None:
    assert outcome["plan"]
    assert not outcome["plan_failed"]


def test_esc_kept_what_was_done(outcome: dict[str, Any]) -> None:
    assert outcome["stopped"]
    assert outcome["stopped"] != outcome["simulated"]


def test_the_run_was_simulated_and_baked(outcome: dict[str, Any]) -> None:
    assert not outcome["simulation_failed"]
    assert outcome["action"]
    assert outcome["frames"][1] - outcome["frames"][0] > 100
    assert outcome["bones"] >= 20


@pytest.mark.parametrize("name", ["1_tab", "2_planned", "3_simulating", "4_stopped", "5_baked"])
def test_screenshot_was_taken(outcome: dict[str, Any], name: str) -> None:
    assert (SHOTS / f"{name}.png").stat().st_size > 20_000
