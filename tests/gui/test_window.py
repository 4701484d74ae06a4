"""The sidebar in a real window, by mouse: from an empty scene to a playing run, Esc, undo, gates, an impossible course.

Needs SKI_ADDON_BLENDER (the command of a Blender with a window), SKI_ADDON_ZIP (a zip that fits its Python), DISPLAY,
and ImageMagick's `import` for the screenshots, which are left in out/gui to be looked at.
"""

from __future__ import annotations

import json
import math
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
    shutil.copy(folder / "result.json", SHOTS)
    return json.loads((folder / "result.json").read_text())


def test_everything_was_done_by_mouse(outcome: dict[str, Any]) -> None:
    assert not outcome["error"], outcome["error"]
    steps = [
        "preset",
        "simulate",
        "bake",
        "play",
        "overlay",
        "stop",
        "undo_bake",
        "gates",
        "drag",
        "undo_gates",
        "impossible",
    ]
    assert outcome["steps"] == steps


def test_a_preset_was_chosen_from_the_menu(outcome: dict[str, Any]) -> None:
    assert outcome["preset"] == "medium_carving"


def test_the_run_was_simulated_baked_and_played(outcome: dict[str, Any]) -> None:
    assert not outcome["simulation_failed"]
    assert outcome["action"]
    assert outcome["frames"][1] - outcome["frames"][0] > 100
    assert outcome["bones"] >= 20
    assert outcome["frame_reached"] > 1


def test_the_overlay_was_drawn(outcome: dict[str, Any]) -> None:
    assert outcome["overlay"]  # a handler that fails takes itself away


def test_esc_kept_what_was_done(outcome: dict[str, Any]) -> None:
    assert outcome["stopped"].startswith("Stopped after")
    assert outcome["finished"].startswith("Skied to the end")


def test_undo_took_the_bake_away_and_nothing_else(outcome: dict[str, Any]) -> None:
    assert outcome["skier_left"]
    assert not outcome["slope_left"]


def test_five_gates_stand_where_they_were_clicked(outcome: dict[str, Any]) -> None:
    gates = outcome["gates"]
    assert len(gates) == 5
    cosine = math.cos(math.radians(11.0))
    for index, (down, left) in enumerate(gates):
        assert abs(down * cosine - (20.0 + 9.0 * index)) < 0.6  # a pixel is wide so far off
        assert abs(left - (1.8 if index % 2 == 0 else -1.8)) < 0.3


def test_the_preview_followed_the_dragged_gate(outcome: dict[str, Any]) -> None:
    assert outcome["moving"]
    assert outcome["previews"] >= 3


def test_gates_were_undone_one_by_one(outcome: dict[str, Any]) -> None:
    assert outcome["gates_before"] == 5
    assert 1 <= outcome["gates_left"] < 5


def test_an_impossible_course_is_told(outcome: dict[str, Any]) -> None:
    assert outcome["refused_failed"]
    assert "cannot be skied at turn" in outcome["refused"]


SCREENS = ("tab", "skier", "presets", "simulating", "baked", "stopped", "undone", "placing", "dragging", "dragged")


@pytest.mark.parametrize("name", [*(f"{i + 1}_{n}" for i, n in enumerate(SCREENS)), "11_gate_undone", "12_impossible"])
def test_screenshot_was_taken(outcome: dict[str, Any], name: str) -> None:
    assert (SHOTS / f"{name}.png").stat().st_size > 20_000
