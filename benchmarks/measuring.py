"""What all benchmarks share: a calibration loop, samples beside it, and one kind of result.

Machines differ and are shared with others, so nothing is judged by its microseconds: a fixed loop is timed right before
and after everything that is measured, and what counts is the ratio to it. Calls that are long enough to be interrupted
by other programs have their ratios from the processor's time that they took, not from the clock on the wall.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter, process_time
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

if TYPE_CHECKING:
    from benchmarks.peers import Peers

ROOT = Path(__file__).resolve().parents[1]
RUNS = ROOT / "presets" / "runs"
UNITS = {"us": 1e6, "ms": 1e3, "s": 1.0}
WORSE = 1.5
"""A ratio to the calibration loop that is so much the last one's is a failure."""
WORSE_ELSEWHERE = 3.0
"""The same where the last one is from another kind of processor or another Python, which alone change ratios."""
SHORTEST = 3.0
"""What takes fewer loops than this never fails: timing takes as long."""
CALIBRATION_ROUNDS = 150
"""Passes of the calibration loop between two measured calls: about a millisecond."""


class NotMeasuredError(Exception):
    """A subject cannot be measured here; the text says what is missing."""


def calibration(rounds: int = 2000) -> float:
    """Return the median seconds of a fixed loop of numpy and Python work."""
    matrix = np.random.default_rng(0).standard_normal((37, 37))
    times = []
    for _ in range(rounds):
        begin = perf_counter()
        product = matrix @ matrix
        total = 0.0
        for value in product[0].tolist():
            total += value * value
        times.append(perf_counter() - begin)
    return float(np.median(times))


def percentiles(values: Any) -> dict[str, float]:
    """Return the `median` and the `p99` of numbers (n,)."""
    return {"median": float(np.median(values)), "p99": float(np.percentile(values, 99))}


@dataclass(frozen=True)
class Measurement:
    """One row of the table.

    `median` and `p99` of `n` samples in `unit`; `ratio` of the time to the calibration loop's in the same run (larger
    is slower, None for what is no time of ours). `objects` and `kib`: what is newly allocated. `peer` is what does the
    same work, `peer_ratio` our time by the peer's and `peer_p99` our p99 by its. `checked`: whether a worse ratio is a
    failure.
    """

    subject: str
    name: str
    unit: str
    median: float
    p99: float
    n: int
    ratio: float | None = None
    objects: float | None = None
    kib: float | None = None
    peer: str = ""
    peer_ratio: float | None = None
    peer_p99: float | None = None
    checked: bool = True

    @property
    def key(self) -> str:
        """Name in the history."""
        return f"{self.subject}/{self.name}"

    def change(self, before: float | None) -> float | None:
        """Return the ratio by an earlier one; None if one of them is not known."""
        return self.ratio / before if self.ratio is not None and before else None

    def worse(self, before: float | None, limit: float = WORSE) -> bool:
        """Return whether the ratio is more than `limit` times an earlier one, which is a failure."""
        change = self.change(before)
        return self.checked and change is not None and change > limit and (self.ratio or 0.0) > SHORTEST


@dataclass
class How:
    """How to measure: `quick` for a check, else with more rounds; `peers` to run beside; `notes` gathers remarks."""

    quick: bool = False
    peers: Peers | None = None
    notes: list[str] = field(default_factory=list)

    def rounds(self, usual: int, quick: int) -> int:
        """Return one of two numbers of rounds."""
        return quick if self.quick else usual


class Spent(NamedTuple):
    """What a call took: `wall` by the clock and `work` of the processor [s]."""

    wall: float
    work: float


def spent(function: Callable[[], Any]) -> tuple[Any, Spent]:
    """Return what a call returns, and what it took."""
    begin, worked = perf_counter(), process_time()
    found = function()
    work = process_time() - worked
    return found, Spent(perf_counter() - begin, work)


@dataclass
class Samples:
    """Times of one thing, each with the calibration [s] around it; a sample may be a series of times.

    `seconds` are wall times [s], `work` [s] is the median of each sample that ratios are made of, `loop` [s] the
    calibration.
    """

    seconds: list[np.ndarray] = field(default_factory=list)
    work: list[float] = field(default_factory=list)
    loop: list[float] = field(default_factory=list)

    def add(self, seconds: Any, loop: float, work: Any = None) -> None:
        """Add a wall time [s] or a series of them, measured while the calibration loop took `loop` [s].

        `work` is the processor's time of each [s]; without it the wall times count, for what is too short to be
        interrupted in the median.
        """
        self.seconds.append(np.atleast_1d(np.asarray(seconds, dtype=float)))
        self.work.append(float(np.median(seconds if work is None else work)))
        self.loop.append(loop)

    def add_spent(self, series: list[Spent], loop: float) -> None:
        """Add a series of calls."""
        self.add([one.wall for one in series], loop, [one.work for one in series])

    def join(self, other: Samples) -> None:
        """Add all samples of `other`."""
        self.seconds += other.seconds
        self.work += other.work
        self.loop += other.loop

    @property
    def all(self) -> np.ndarray:
        """Every time (n,) [s]."""
        return np.concatenate(self.seconds) if self.seconds else np.zeros(0)

    @property
    def medians(self) -> np.ndarray:
        """Median of each sample (m,) [s]."""
        return np.array([np.median(part) for part in self.seconds])

    @property
    def ratio(self) -> float:
        """Median over the samples of work by calibration."""
        return float(np.median(np.array(self.work) / np.array(self.loop)))

    def over(self, other: Samples) -> float:
        """Return the median over the rounds of this work by that of `other`, done in turn with it."""
        return float(np.median(np.array(self.work) / np.array(other.work)))

    def wall_over(self, other: Samples) -> float:
        """Return the same by wall times: for what waits, as for a disk."""
        return float(np.median(self.medians / other.medians))

    def row(self, subject: str, name: str, unit: str, share: float = 1.0, **more: Any) -> Measurement:
        """Return the row of a `share` of each of these times, as of one key of all that are written."""
        numbers = percentiles(self.all * (share * UNITS[unit]))
        ratio = share * self.ratio
        return Measurement(subject, name, unit, numbers["median"], numbers["p99"], self.all.size, ratio, **more)

    def rate_row(self, subject: str, name: str, unit: str, amount: float, **more: Any) -> Measurement:
        """Return the row of `amount` a second, where more is better: its p99 is what 99 % of the samples exceed."""
        rate = amount / self.all
        median, low = float(np.median(rate)), float(np.percentile(rate, 1))
        return Measurement(subject, name, unit, median, low, self.all.size, self.ratio, **more)


def in_turn(functions: Mapping[str, Callable[[], Any]], rounds: int) -> dict[str, Samples]:
    """Time functions in turn, with the calibration loop before and after each; return their samples by name."""
    samples = {name: Samples() for name in functions}
    before = calibration(CALIBRATION_ROUNDS)
    for _ in range(rounds):
        for name, function in functions.items():
            _, took = spent(function)
            after = calibration(CALIBRATION_ROUNDS)
            samples[name].add_spent([took], 0.5 * (before + after))
            before = after
    return samples
