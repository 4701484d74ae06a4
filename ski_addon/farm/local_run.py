"""Running a job bundle on this computer by `openjd run`, the command line of Open Job Description."""

from __future__ import annotations

import importlib.util
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterable
from pathlib import Path

from .. import apart
from ..errors import MissingLibraryError, SkiAddonError, SpecError
from .job import LAUNCHES, FarmJob

STOP_SECONDS = 90
"""How long an interrupted run may take to stop its task before it is killed [s]."""
_EXITED = re.compile(r"Process pid \d+ exited with code: (-?\d+)")
_FAILED = re.compile(r"openjd_fail: *(.+)")


def check_can_run(engine: str) -> None:
    """Raise `SpecError` for a farm whose jobs do not run here, `MissingLibraryError` without openjd-cli."""
    if engine != "openjd":
        raise SpecError("--run", problem=f"is not for {engine}", hint="send job.json to its Manager, see docs/farm.md")
    if importlib.util.find_spec("openjd") is None or importlib.util.find_spec("openjd.cli") is None:
        raise MissingLibraryError("openjd-cli", "--run")


def run_bundle(folder: Path, job: FarmJob, say: Callable[[str], None]) -> None:
    """Run all steps of the bundle in `folder`, one task after the other; every line of the log goes to `say`.

    Raises `SkiAddonError` with the message and the exit code of the task that failed.
    """
    command = [sys.executable, "-m", "openjd", "run", str(folder / "template.json"), "--timestamp-format", "local"]
    launch, _, _ = LAUNCHES[job.workers]
    if job.workers == "python":
        command += ["--job-param", f"{launch}={sys.executable}"]
    with subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        env=os.environ | {"PYTHONPATH": apart.python_path()},
        start_new_session=True,  # a terminal's Ctrl+C reaches us alone, and we pass it on
        text=True,
        errors="replace",
    ) as process:
        try:
            failure = _follow(process.stdout or (), say)
        except BaseException:
            _stop(process)
            raise
    if process.returncode:
        raise failure


def _follow(lines: Iterable[str], say: Callable[[str], None]) -> SkiAddonError:
    """Pass the log on; return what to raise if the run turns out to have failed."""
    exit_code, reason = 1, "see the log above"
    for line in lines:
        say(line.rstrip("\n"))
        if exited := _EXITED.search(line):
            exit_code = int(exited[1]) or exit_code
        if failed := _FAILED.search(line):
            reason = failed[1]
    failure = SkiAddonError(f"the job failed: {reason}")
    failure.exit_code = exit_code if 0 < exit_code < 256 else 1
    return failure


def _stop(process: subprocess.Popen[str]) -> None:
    """Ask the run to stop its task and wait for it; kill it if that takes too long."""
    process.send_signal(signal.SIGINT)
    try:
        process.communicate(timeout=STOP_SECONDS)
    except (subprocess.TimeoutExpired, KeyboardInterrupt):
        process.kill()
