"""Crowds: what a second process is worth, and what a worker remembers: `python -m benchmarks.crowd`.

The same members are skied by one process and by two in turn, in one run. A busy machine has no second processor to
give (Linux shares processors out between sessions, not processes), so the ratio is also given by processor time: what
two processes reach if each has a processor to itself. Memory is the most a process has ever held, as the system counts
it. The common table (`python -m benchmarks --only crowd`) has the same in short.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.measuring import How, Measurement, percentiles
from ski_addon.crowd import CrowdSpec, MemberRun
from ski_addon.crowd.members import Member, draw_member
from ski_addon.crowd.skiing import Outcome, recordings_in, ski_member
from ski_addon.spec import RunSpec, find_document
from ski_addon.workers import run_all, worker_pool

SUBJECT = "crowd"
RUN = "paper_main"
MEMBERS, TURNS = 4, 2
"""Skiers of a round, and the turns of each: some seconds of skiing."""
LONGER = 4
"""How many times as many turns a long run has, whose memory is compared."""


@dataclass(frozen=True)
class CrowdFigures:
    """What was measured.

    `one` and `two` are seconds of skiing a second, a value a round, of one process and of two; `by_work` is the ratio
    two processors of their own would give. `memory` is the peak [bytes] of one worker after `skied` [s] in all, member
    by member of equal length; `long_memory` that of one who skied for `long_skied` [s] at a stretch.
    """

    one: list[float]
    two: list[float]
    by_work: list[float]
    skied: list[float]
    memory: list[int]
    long_skied: float
    long_memory: int

    @property
    def ratios(self) -> list[float]:
        """Throughput of two processes by that of one, a value a round."""
        return [two / one for one, two in zip(self.one, self.two, strict=True)]

    @property
    def growth(self) -> float:
        """Memory that a worker gains with each second it skies, once it has skied each of the members [bytes/s]."""
        skied, memory = self.skied[MEMBERS - 1 :], self.memory[MEMBERS - 1 :]
        return float(np.polyfit(skied, memory, 1)[0]) if len(memory) > 1 else 0.0

    @property
    def per_second(self) -> float:
        """Memory that a second more of one member's run takes [bytes/s]."""
        return (self.long_memory - self.memory[0]) / (self.long_skied - self.skied[0])


def measure(rounds: int = 5, repeats: int = 3, turns: int = TURNS) -> CrowdFigures:
    """Ski `MEMBERS` in one process and in two for each of `rounds`, then the same `repeats` times in one worker."""
    members = drawn(turns)
    one: list[float] = []
    two: list[float] = []
    by_work: list[float] = []
    with tempfile.TemporaryDirectory() as name, worker_pool(1) as single, worker_pool(2) as double:
        folder = Path(name)
        for pool in (single, double):
            _skied(pool, members, folder)  # every process has imported and made everything once
        for number in range(rounds):
            pools = (single, double) if number % 2 == 0 else (double, single)
            found = {pool: _skied(pool, members, folder) for pool in pools}
            one.append(found[single][0])
            two.append(found[double][0])
            by_work.append(2.0 * found[single][1] / found[double][1])
    skied, memory = remembered(members * repeats)
    long_skied, long_memory = remembered(drawn(LONGER * turns)[:1])
    return CrowdFigures(one, two, by_work, skied, memory, long_skied[0], long_memory[0])


def drawn(turns: int) -> list[Member]:
    """Return `MEMBERS` skiers, of one length within the spread of the rhythm."""
    spec = RunSpec.from_toml(find_document(RUN)).with_overrides({"course.turn_count": turns})
    crowd = CrowdSpec((MemberRun(spec),)).with_values({"spread.rhythm": 0, "spread.speed": 0, "spread.radius": 0})
    return [draw_member(crowd, index) for index in range(MEMBERS)]


def remembered(members: Sequence[Member]) -> tuple[list[float], list[int]]:
    """Return seconds skied so far [s] and the peak of memory [bytes] after each of `members`, in one new worker."""
    skied, memory = [0.0], []
    with tempfile.TemporaryDirectory() as name, worker_pool(1) as pool:
        for member in members:
            outcome, _ = _run(pool, [member], Path(name))[0]
            skied.append(skied[-1] + outcome.simulated_s)
            memory.append(outcome.memory_bytes or 0)
    return skied[1:], memory


def ski_timed(member: Member, folder: Path, stop: Callable[[], bool]) -> tuple[Outcome, float]:
    """Ski `member` in a worker; returns what became of it, and the processor's time that it took [s]."""
    worked = time.process_time()
    outcome = ski_member(member, folder, stop)
    return outcome, time.process_time() - worked


def measurements(how: How) -> list[Measurement]:
    """Return the rows of the common table; nothing of it is judged, for it is as much the machine's as ours."""
    found = measure(how.rounds(5, 1), how.rounds(3, 1), how.rounds(TURNS, 1))
    beside = {"peer": "one process", "peer_ratio": float(1.0 / np.median(found.ratios))}
    alone = {"peer": "one process", "peer_ratio": float(1.0 / np.median(found.by_work))}
    megabytes = [size / 1e6 for size in found.memory]
    return [
        _row("skiing by one process", "s/s", found.one),
        _row("skiing by two", "s/s", found.two, **beside),
        _row("two, by processor time", "x", found.by_work, **alone),
        _row("peak memory of a worker", "MB", megabytes),
        _row("and a second more of a run", "MB", [found.per_second / 1e6]),
    ]


def table(found: CrowdFigures) -> str:
    """Return the figures as lines."""
    memory = np.array(found.memory) / 1e6
    return "\n".join((
        f"{'seconds of skiing a second':34} {'median':>8} {'least':>8} {'most':>8}",
        _line("one process", found.one),
        _line("two processes", found.two),
        _line("two by one, wall time", found.ratios),
        _line("two by one, processor time", found.by_work),
        "",
        f"{'peak memory of a worker':34} {'skied':>8} {'MB':>8}",
        *(f"{'':34} {time:7.0f}s {size:8.1f}" for time, size in zip(found.skied, memory, strict=True)),
        f"grows by {found.growth / 1e3:.1f} kB a second it skies, after the first {MEMBERS} members",
        f"takes {found.per_second / 1e6:.2f} MB a second of one member's run "
        f"({found.long_memory / 1e6:.1f} MB for {found.long_skied:.0f} s at a stretch)",
    ))  # fmt: skip


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure and print; returns the exit code."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.crowd", description=(__doc__ or "").partition(":")[0])
    parser.add_argument("--rounds", type=int, default=5, help="rounds of one and two processes in turn (5)")
    parser.add_argument("--repeats", type=int, default=3, help=f"how often a worker skis the {MEMBERS} members (3)")
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write all numbers to this file")
    asked = parser.parse_args(arguments)
    found = measure(asked.rounds, asked.repeats)
    print(table(found))
    if asked.json:
        asked.json.write_text(json.dumps(asdict(found), indent=1) + "\n", encoding="utf-8")
    return 0


def _skied(pool: ProcessPoolExecutor, members: Sequence[Member], folder: Path) -> tuple[float, float]:
    """Return seconds of skiing a second, and the processor's time of all members [s]."""
    begin = time.perf_counter()
    done = _run(pool, members, folder)
    wall = time.perf_counter() - begin
    return sum(outcome.simulated_s for outcome, _ in done) / wall, sum(work for _, work in done)


def _run(pool: ProcessPoolExecutor, members: Sequence[Member], folder: Path) -> list[tuple[Outcome, float]]:
    for path in recordings_in(folder):  # or they would be kept
        path.unlink()
    return run_all(pool, ski_timed, [(member, folder) for member in members], lambda _done, _text: None, "skiing")


def _row(name: str, unit: str, values: Sequence[float], **more: Any) -> Measurement:
    numbers = percentiles(values)
    return Measurement(SUBJECT, name, unit, numbers["median"], numbers["p99"], len(values), checked=False, **more)


def _line(name: str, values: Sequence[float]) -> str:
    return f"{name:34} {np.median(values):8.2f} {min(values):8.2f} {max(values):8.2f}"


if __name__ == "__main__":
    sys.exit(main())
