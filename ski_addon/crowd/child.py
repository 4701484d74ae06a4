"""The command `crowd` as a process of its own, watched without waiting: for Blender, whose window must stay alive.

Blender's Python can be started by itself, but cannot share Blender's own modules with the processes of a pool. So the
command line is started with everything that can be imported here.
"""

from __future__ import annotations

import functools
import os
import queue
import re
import signal
import subprocess
import sys
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import IO, Any

from ..apart import ROOT
from ..errors import SkiAddonError, one_line

ENOUGH = 60.0
"""Time [s] in which a Python must be able to import everything, and in which a stopped crowd must end."""
WANTED = "import ski_addon.cli, numpy, scipy, osqp, mujoco"
_PROGRESS = re.compile(r"(planning|skiing): (\d+ of \d+): +(\d+)%(.*)")
PLANNING_SHARE = 0.1
"""Share of the progress that planning is."""
WINDOWS = sys.platform == "win32"


class CrowdProcess:
    """The command `crowd` with `arguments`, running since this was made; `command` is what to start (this Python)."""

    def __init__(self, arguments: Sequence[str], command: Sequence[str] | None = None) -> None:
        start = list(command or (sys.executable, "-m", "ski_addon", "crowd"))
        more: dict[str, Any] = {"creationflags": 0x08000000} if WINDOWS else {"start_new_session": True}  # no console
        self._process = subprocess.Popen(
            [*start, *arguments],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            env=environment(),
            text=True,
            errors="replace",
            **more,
        )
        self._lines: queue.Queue[str] = queue.Queue()
        self._failures: list[str] = []
        self._readers = [
            threading.Thread(target=_read, args=(stream, keep), daemon=True)
            for stream, keep in ((self._process.stdout, self._lines.put), (self._process.stderr, self._failures.append))
        ]
        for reader in self._readers:
            reader.start()
        self._now = 0.0, "Starting"

    @property
    def running(self) -> bool:
        """Whether it has not ended yet."""
        return self._process.poll() is None

    def look(self) -> tuple[float, str]:
        """Return how far it is: (fraction, text)."""
        while not self._lines.empty():
            said = _PROGRESS.match(self._lines.get())
            if said:
                share = int(said[3]) / 100.0
                before, part = (0.0, PLANNING_SHARE) if said[1] == "planning" else (PLANNING_SHARE, 1 - PLANNING_SHARE)
                verb = "planned" if said[1] == "planning" else "skied"
                self._now = before + part * share, f"{said[2]} {verb}"
        return self._now

    def stop(self) -> None:
        """Interrupt it as Ctrl+C does, and wait until it has ended; what is finished stays."""
        if self.running:
            if WINDOWS:
                self._process.terminate()
            else:
                self._process.send_signal(signal.SIGINT)
        try:
            self._process.wait(ENOUGH)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def result(self) -> tuple[int, str]:
        """Return its exit code, once it has ended, and the last line it said of a failure."""
        self._process.wait()
        for reader in self._readers:
            reader.join(ENOUGH)
        said = [line for line in self._failures if line.strip()]
        return self._process.returncode, one_line(said[-1]).removeprefix("ski_addon: ") if said else ""


def raise_failure(exit_code: int, said: str) -> None:
    """Raise what a crowd that ended with `exit_code` and nothing to show said of it."""
    error = SkiAddonError(said or f"the process of the crowd ended unexpectedly (code {exit_code})")
    error.exit_code = exit_code if exit_code > 0 else 1
    raise error


@functools.cache
def can_start() -> bool:
    """Return whether a process of its own can simulate: not where, for instance, there is no Python to start."""
    if not sys.executable or not Path(sys.executable).is_file():
        return False
    try:
        done = subprocess.run(
            [sys.executable, "-c", WANTED],
            env=environment(),
            stdin=subprocess.DEVNULL,
            capture_output=True,
            timeout=ENOUGH,
            check=False,
        )
    except (OSError, subprocess.SubprocessError):
        return False
    return done.returncode == 0


def environment() -> dict[str, str]:
    """Return the environment in which the command line finds what this process can import."""
    known = [entry for entry in sys.path if entry and os.path.isdir(entry)]
    return os.environ | {"PYTHONPATH": os.pathsep.join(dict.fromkeys([str(ROOT), *known])), "PYTHONUNBUFFERED": "1"}


def _read(stream: IO[str] | None, keep: Any) -> None:
    for line in stream or ():
        keep(line)
