"""Kill -9 at random moments: what is made after it is what is made without it.

`python -m tests.acceptance.killed_tasks 20` kills simulate, bake and render 20 times each, gives the same command again
and compares: the bytes of the recording, and the pixels of frames (of a bake: of a frame rendered from it).
"""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from ski_addon.tasks.picture import read_picture

ROOT = Path(__file__).resolve().parents[2]
RUN = ("paper_main", "--set", "course.turn_count=3", "--set", "simulation.solver=osqp")
PUSH = '\n[[push]]\nbody = "abdomen"\ndirection = "left"\nforce = 150\nstart = 1.5\nduration = 0.5\n'
PICTURE = ("--size", "96x54", "--samples", "2")
FRAMES = ("--frames", "30-35")
BETWEEN = {"SKI_ADDON_CHECKPOINT_SECONDS": "0.2"}


@dataclass
class Tally:
    """What came of the kills of one task: how many, how many of them ended as without, how many went on midway."""

    task: str
    kills: int = 0
    equal: int = 0
    resumed: int = 0
    seconds: list[float] = field(default_factory=list)
    flaws: list[str] = field(default_factory=list)

    def line(self) -> str:
        """The tally in words."""
        moments = ", ".join(f"{second:.1f}" for second in sorted(self.seconds))
        said = f"{self.task}: {self.equal}/{self.kills} equal, {self.resumed} went on midway; killed after {moments} s"
        return "\n  ".join([said, *self.flaws])


class Workshop:
    """A folder with one finished run, bake and film, to compare with."""

    def __init__(self, folder: Path, engine: str = "cycles") -> None:
        self.folder, self.engine = folder, engine
        self.spec = folder / "run.toml"
        self.reference = folder / "reference"
        self.spec.write_text(self._document(), encoding="utf-8")
        self.lasts: dict[str, float] = {}
        for task in ("simulate", "bake", "render"):
            begin = time.monotonic()
            done = run(self.command(task, self.reference))
            if done.returncode:
                raise RuntimeError(f"{task}: {done.stderr}")
            self.lasts[task] = time.monotonic() - begin

    def command(self, task: str, folder: Path) -> list[str]:
        """The command of a task whose files lie in `folder`."""
        if task == "simulate":
            return ["simulate", str(self.spec), "-o", str(folder)]
        if task == "bake":
            return ["bake", str(folder), "-o", str(folder / "skier.blend")]
        film = [str(folder / "skier.blend"), "-o", str(folder / "frames")]
        return ["render", *film, *FRAMES, "--engine", self.engine, *PICTURE]

    def kill_once(self, task: str, moment: float, tally: Tally) -> bool:
        """Kill a task after `moment` [s] and do it again; False if it had ended by then."""
        with tempfile.TemporaryDirectory(dir=self.folder) as name:
            folder = Path(name, "work")
            self._prepare(task, folder)
            if not kill_after(self.command(task, folder), moment):
                return False
            again = run(self.command(task, folder))
            if again.returncode:
                raise RuntimeError(f"{task} after a kill at {moment:.2f} s: {again.stderr}")
            tally.kills += 1
            tally.seconds.append(moment)
            same, left = self._found(task, folder) == self._found(task, self.reference), left_over(folder)
            tally.equal += same and not left
            if left or not same:
                tally.flaws.append(f"after {moment:.2f} s: {'left ' + ', '.join(left) if left else 'another result'}")
            tally.resumed += "going on from" in again.stdout or _kept(again.stdout)
        return True

    def _document(self) -> str:
        from ski_addon.spec import RunSpec, find_document

        spec = RunSpec.from_toml(find_document(RUN[0]))
        changes = dict(word.split("=") for word in RUN[2::2])
        return spec.with_overrides(changes).to_toml() + PUSH

    def _prepare(self, task: str, folder: Path) -> None:
        """Copy what the task needs, as it was left by the one before."""
        folder.mkdir()
        before = {"simulate": (), "bake": ("recording.npz",), "render": ("skier.blend", "skier.task.json")}[task]
        for name in before:
            shutil.copy2(self.reference / name, folder / name)

    def _found(self, task: str, folder: Path) -> object:
        """What is compared."""
        if task == "simulate":
            return (folder / "recording.npz").read_bytes()
        if task == "render":
            return pixels(folder / "frames")
        film = folder / "look"
        words = [str(folder / "skier.blend"), "-o", str(film), "--frames", "30", "--engine", self.engine, *PICTURE]
        done = run(["render", *words])
        if done.returncode:
            raise RuntimeError(f"render of a bake: {done.stderr}")
        return pixels(film)


def pixels(folder: Path) -> dict[str, str]:
    """The digests of the pixels of all pictures in a folder."""
    return {path.name: read_picture(path.read_bytes()).pixels for path in sorted(folder.glob("*.png"))}


def left_over(folder: Path) -> list[str]:
    """Files that should not be there when all is done."""
    names = [path.name for path in folder.rglob("*")]
    return [name for name in names if name.startswith(".") or name == "checkpoint.npz"]


def run(words: Sequence[str]) -> subprocess.CompletedProcess[str]:
    """Run one command of ours to its end."""
    command = [sys.executable, "-m", "ski_addon", *words]
    return subprocess.run(
        command, cwd=ROOT, env=os.environ | BETWEEN, capture_output=True, text=True, timeout=600, check=False
    )


def kill_after(words: Sequence[str], moment: float) -> bool:
    """Start a command and kill it after `moment` [s]; False if it had ended by then."""
    with subprocess.Popen(
        [sys.executable, "-m", "ski_addon", *words],
        cwd=ROOT,
        env=os.environ | BETWEEN,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    ) as process:
        try:
            process.wait(moment)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGKILL)
        return process.wait() == -signal.SIGKILL


def kill_tasks(folder: Path, count: int, *, seed: int = 0, engine: str = "cycles") -> list[Tally]:
    """Kill each task at `count` random moments; return what came of it."""
    workshop, chance, tallies = Workshop(folder, engine), random.Random(seed), []
    for task, lasts in workshop.lasts.items():
        tally = Tally(task)
        while tally.kills < count:
            workshop.kill_once(task, chance.uniform(0.05, 1.0) * lasts, tally)
        tallies.append(tally)
        print(tally.line(), flush=True)
    return tallies


def _kept(said: str) -> bool:
    """Whether a render found frames that were finished before the kill."""
    last = [line for line in said.splitlines() if " of frames " in line]
    return bool(last) and f": rendered {6} of" not in last[-1]


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        found = kill_tasks(Path(name), int(sys.argv[1]) if len(sys.argv) > 1 else 20)
    sys.exit(any(tally.equal != tally.kills for tally in found))
