"""The step by stage, in turn with TSID's: TSID, ours, TSID, ours, ... TSID, so that both meet the same machine.

The other peers are run before all of it and after.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace
from typing import Any

import numpy as np

from benchmarks.allocations import WHOLE, Allocated, step_allocations
from benchmarks.measuring import CALIBRATION_ROUNDS, How, Measurement, Samples, calibration
from benchmarks.peers import OTHERS, STAGES, STEP, Entry, Figure, PeerError, Peers, figure
from benchmarks.step import PRESET, StageTimer
from ski_addon.pipeline import Planned, make_plan, start_simulation
from ski_addon.simulation import Simulation
from ski_addon.spec import RunSpec

SUBJECT = "step"
CHUNK = 50
"""Steps between two looks at the calibration loop."""
WARM_UP = 200


class Steps:
    """Two simulations of one plan, without and with timers, that go on by chunks of steps, and begin again at the end.

    `whole` and `stages` gather the times: of steps without timers, and of each stage and the rest.
    """

    def __init__(self, planned: Planned) -> None:
        self._planned = planned
        self.whole = Samples()
        self.stages: dict[str, Samples] = defaultdict(Samples)
        self._begin()

    def chunks(self, count: int) -> Samples:
        """Go on by so many chunks; return the times of whole steps, which are also added to all of them."""
        mine = Samples()
        before = calibration(CALIBRATION_ROUNDS)
        for _ in range(count):
            if self._plain.step_total - self._plain.step_done < 4 * CHUNK or not self._plain.running:
                self._begin()
            self._plain.advance(CHUNK)
            middle = calibration(CALIBRATION_ROUNDS)
            rows = self._timer.rows(CHUNK)
            after = calibration(CALIBRATION_ROUNDS)
            mine.add(self._plain.step_seconds[-CHUNK:], 0.5 * (before + middle))
            for stage, seconds in rows.items():
                self.stages[stage].add(seconds, 0.5 * (middle + after))
            before = after
        self.whole.join(mine)
        return mine

    def _begin(self) -> None:
        self._plain: Simulation = start_simulation(self._planned)
        self._staged = start_simulation(self._planned)
        self._plain.advance(WARM_UP)
        self._staged.advance(WARM_UP)
        self._timer = StageTimer(self._staged)


class Beside:
    """Figures of the peers and, for each, ours of the round between two of them by theirs."""

    def __init__(self, how: How) -> None:
        self._how, self._peers = how, how.peers
        self._failed: set[str] = set()
        self.figures: dict[Entry, list[Figure]] = defaultdict(list)

    def run(self, *entries: Entry) -> None:
        """Run the scripts of `entries` once."""
        if self._peers is None:
            return
        for script in dict.fromkeys(entry.script for entry in entries):
            self._run(self._peers, script)

    def figure(self, entry: Entry) -> Figure | None:
        """Return the median of what a peer gave in all rounds, if it gave anything."""
        found = self.figures.get(entry)
        if not found:
            return None
        median, p99 = np.median([(one.median, one.p99) for one in found], axis=0)
        return Figure(float(median), float(p99), sum(one.n for one in found))

    def ratio(self, entry: Entry, ours: list[float]) -> float | None:
        """Return the median over the rounds of ours [us] by the mean of the peer's before and after.

        A peer that was not run between the rounds has the median of ours by the mean of its own.
        """
        theirs = np.array([one.median for one in self.figures.get(entry, [])])
        if len(theirs) == len(ours) + 1:
            return float(np.median(np.array(ours) / (0.5 * (theirs[:-1] + theirs[1:]))))
        return float(np.median(ours) / theirs.mean()) if len(theirs) else None

    def p99_ratio(self, entry: Entry, ours: float) -> float | None:
        """Return our p99 [us] by the median of the peer's."""
        theirs = self.figure(entry)
        return ours / theirs.p99 if theirs else None

    def _run(self, peers: Peers, script: str) -> None:
        if script in self._failed:
            return
        try:
            found = peers.run(script)
        except PeerError as problem:
            self._failed.add(script)
            self._how.notes.append(str(problem))
            return
        for entry in (STEP, *STAGES.values(), *OTHERS):
            if entry.script == script:
                self._add(entry, found)

    def _add(self, entry: Entry, found: dict) -> None:
        try:
            self.figures[entry].append(figure(found, entry))
        except PeerError as problem:
            if str(problem) not in self._how.notes:
                self._how.notes.append(str(problem))


def measurements(how: How) -> list[Measurement]:
    """Return the rows of the step: the whole, each stage, and the peers."""
    planned = make_plan(RunSpec.from_toml(PRESET))
    steps, beside = Steps(planned), Beside(how)
    ours: dict[str, list[float]] = defaultdict(list)
    beside.run(*OTHERS, STEP)
    for _ in range(how.rounds(4, 1)):
        before = {stage: len(samples.seconds) for stage, samples in steps.stages.items()}
        mine = steps.chunks(how.rounds(25, 16))
        ours[WHOLE].append(1e6 * float(np.median(mine.all)))
        for stage, samples in steps.stages.items():
            new = np.concatenate(samples.seconds[before.get(stage, 0) :] or [np.zeros(1)])
            ours[stage].append(1e6 * float(np.median(new)))
        beside.run(STEP)
    beside.run(*OTHERS)
    allocated = {} if how.quick else step_allocations(planned)
    return _rows(steps, beside, ours, allocated)


def _rows(
    steps: Steps, beside: Beside, ours: dict[str, list[float]], allocated: dict[str, Allocated]
) -> list[Measurement]:
    rows = [steps.whole.row(SUBJECT, WHOLE, "us")]
    called = {stage: samples for stage, samples in steps.stages.items() if samples.all.any()}
    rows += [samples.row(SUBJECT, stage, "us", checked=False) for stage, samples in called.items()]
    for index, row in enumerate(rows):
        entry = STEP if row.name == WHOLE else STAGES.get(row.name)
        if entry and (ratio := beside.ratio(entry, ours[row.name])) is not None:
            tail = beside.p99_ratio(entry, row.p99) if row.name == WHOLE else None
            row = replace(row, peer=entry.label, peer_ratio=ratio, peer_p99=tail)
        if row.name in allocated:
            row = replace(row, objects=allocated[row.name].objects, kib=allocated[row.name].kib)
        rows[index] = row
    for entry in (STEP, *OTHERS):
        theirs = beside.figure(entry)
        if theirs is not None:
            ratio = beside.ratio(entry, ours[WHOLE])
            tail = beside.p99_ratio(entry, rows[0].p99)
            more: dict[str, Any] = {"peer_ratio": ratio, "peer_p99": tail, "checked": False}
            name = f"  peer: {entry.label}"
            rows.append(Measurement(SUBJECT, name, "us", theirs.median, theirs.p99, theirs.n, **more))
    return rows
