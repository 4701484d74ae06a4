"""Running a script in a real Blender's window, and taking the screenshots that it asks for."""

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
MINUTES = 10

in_window = [
    pytest.mark.gui,
    pytest.mark.skipif(any(not os.environ.get(name) for name in NEEDED), reason=f"needs {', '.join(NEEDED)}"),
]


def blender() -> str:
    """The command of the Blender with a window."""
    return os.environ["SKI_ADDON_BLENDER"]


def zip_path() -> str:
    """The zip that fits its Python."""
    return str(Path(os.environ["SKI_ADDON_ZIP"]).resolve())


def run_in_window(script: str, folder: Path, user: Path, *arguments: str, install: bool = True) -> dict[str, Any]:
    """What a script of this folder wrote when it was done in a window, with the user's folder `user`.

    With `install` the zip is installed before. Its log, result and screenshots are left in out/gui under its name.
    """
    environment = os.environ | {"BLENDER_USER_RESOURCES": str(user)}
    if install:
        command = [blender(), "--command", "extension", "install-file", "-r", "user_default", "-e", zip_path()]
        subprocess.run(command, env=environment, timeout=180, check=True)
    shots = shots_of(script)
    shutil.rmtree(shots, ignore_errors=True)
    shots.mkdir(parents=True)
    command = [blender(), "--window-geometry", "0", "0", "1600", "1000", "--enable-event-simulate"]
    command += ["--python", str(ROOT / "tests" / "gui" / f"{script}.py"), "--", str(folder), *arguments]
    log = shots / "blender.log"
    with log.open("w") as stream:
        process = subprocess.Popen(command, env=environment, stdout=stream, stderr=subprocess.STDOUT)
        try:
            end = time.monotonic() + 60 * MINUTES
            while process.poll() is None and time.monotonic() < end:
                _take_screenshots(folder, shots)
                time.sleep(0.2)
        finally:
            process.kill()
            process.wait()
    assert (folder / "result.json").exists(), f"no result after {MINUTES} minutes:\n{log.read_text()[-2000:]}"
    shutil.copy(folder / "result.json", shots)
    return json.loads((folder / "result.json").read_text())


def shots_of(script: str) -> Path:
    """The folder of a script's screenshots."""
    return SHOTS / script


def _take_screenshots(folder: Path, shots: Path) -> None:
    """Serve the requests of the script in the window."""
    for request in folder.glob("*.shot"):
        subprocess.run(["import", "-window", "root", str(shots / f"{request.stem}.png")], timeout=60, check=True)
        request.unlink()
