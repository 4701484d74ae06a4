"""All benchmarks in one table: `python -m benchmarks`.

Every time is also given by the calibration loop's, measured around it, and by that of a peer which does the same work
in the same run. docs/performance.md tells how to read the table.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from benchmarks import history
from benchmarks.instructions import instruction_rows
from benchmarks.measuring import WORSE, WORSE_ELSEWHERE, How, Measurement, NotMeasuredError, calibration
from benchmarks.peers import VARIABLE, find_peers
from benchmarks.subjects import SUBJECTS, chosen, measure
from benchmarks.table import table
from ski_addon.atomic import write_text
from ski_addon.errors import OutputError

TRIES = 3
"""How often subjects with a worse ratio are measured again before that is believed."""


def parser() -> argparse.ArgumentParser:
    """Return the command line."""
    made = argparse.ArgumentParser(prog="python -m benchmarks", description="Measure, and print one table.")
    made.add_argument("--only", metavar="NAMES", help=f"only these, between commas: {', '.join(SUBJECTS)}")
    made.add_argument("--quick", action="store_true", help="fewer rounds, and no allocations")
    made.add_argument("--json", type=Path, metavar="FILE", help="also write all numbers to this file")
    peers = f"run other people's control steps, if their folder is there ({VARIABLE} names it); not when quick"
    made.add_argument("--peers", action=argparse.BooleanOptionalAction, help=peers)
    made.add_argument("--instructions", action="store_true", help="also count the instructions of steps (valgrind)")
    made.add_argument("--history", type=Path, default=history.FILE, metavar="FILE", help="the history to compare with")
    made.add_argument("--record", action="store_true", help="append the ratios to the history")
    made.add_argument("--note", default="", help="a remark for the recorded entry")
    check = f"quick; exit with 1 if a ratio to the calibration loop stays above {WORSE} times the recorded one"
    check += f" ({WORSE_ELSEWHERE} times if that is from another kind of processor)"
    made.add_argument("--check", action="store_true", help=check)
    return made


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command and return its exit code."""
    asked = parser().parse_args(arguments)
    try:
        names = chosen(asked.only)
        before = history.last(history.read(asked.history), history.cpu())
        for path in (asked.json, asked.history if asked.record else None):
            check_target(path)
    except (ValueError, history.HistoryError, OutputError) as problem:
        print(problem, file=sys.stderr)
        return 2
    quick = asked.quick or asked.check
    how = How(quick)
    if asked.peers if asked.peers is not None else not quick and "step" in names:
        add_peers(how)
    loop = 1e6 * calibration()
    rows = measure(names, how)
    if asked.check:
        rows = again(rows, before, how)
    if asked.instructions:
        rows += counted(how)
    compared = (before.ratios, before.limit) if before else ()
    print(table(rows, *compared), *words(loop, before, how), sep="\n")
    if asked.json:
        write_json(asked.json, rows, loop, how)
    if asked.record:
        history.record(rows, quick, asked.history, asked.note)
    return judged(rows, before) if asked.check else 0


def add_peers(how: How) -> None:
    """Have other people's control steps run beside ours, or note that they are not there."""
    how.peers = find_peers()
    if how.peers is None:
        how.notes.append(f"no other people's control steps: there is no folder of them; {VARIABLE} may name one")


def again(rows: list[Measurement], before: history.Entry | None, how: How) -> list[Measurement]:
    """Return the rows after subjects with worse ratios were measured again, each row at its best."""
    for _ in range(TRIES):
        bad = {row.subject for row, _ in history.worse(rows, before)}
        if not bad:
            break
        notes = How(how.quick, how.peers)
        rows = history.better_of(rows, measure([name for name in SUBJECTS if name in bad], notes))
    return rows


def counted(how: How) -> list[Measurement]:
    """Return the rows of instruction counts, or none and a note."""
    try:
        return instruction_rows()
    except NotMeasuredError as problem:
        how.notes.append(f"instructions were not counted: {problem}")
        return []


def words(loop: float, before: history.Entry | None, how: How) -> list[str]:
    """Return what is said below the table."""
    compared = f"change: x loop by that of {before.title}" if before else "there is no history to compare with yet"
    if before and before.cpu != history.cpu():
        compared += f"; this processor is another: {history.cpu()}"
    if before and before.limit != WORSE:
        compared += f"; here {before.limit:g} times is a failure"
    return ["", f"calibration loop: {loop:.2f} us; x loop: time by that loop's around it", compared, *how.notes]


def write_json(path: Path, rows: list[Measurement], loop: float, how: How) -> None:
    """Write all numbers."""
    document = {
        "commit": history.commit(),
        "cpu": history.cpu(),
        "calibration_us": loop,
        "quick": how.quick,
        "notes": how.notes,
        "measurements": [asdict(row) for row in rows],
    }
    write_text(path, json.dumps(document, indent=1, ensure_ascii=False) + "\n")


def check_target(path: Path | None) -> None:
    """Raise `OutputError` for a file that could not be written in the end, before minutes are spent on it."""
    if path is None:
        return
    if path.is_dir():
        raise OutputError(path, "it is a folder")
    if not os.access(path.parent, os.W_OK):
        raise OutputError(path, "its folder is not there or cannot be written to")


def judged(rows: list[Measurement], before: history.Entry | None) -> int:
    """Say what became worse, and return the exit code."""
    bad = history.worse(rows, before)
    for row, factor in bad:
        hint = "mend it, or record it with --record if it is meant or the machine is another"
        print(f"WORSE: {row.key} takes {factor:.2f} times as many calibration loops as recorded; {hint}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
