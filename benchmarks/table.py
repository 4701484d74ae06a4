"""The table: one line a measurement, by subject, in at most 119 columns."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import groupby

from benchmarks.measuring import WORSE, Measurement

COLUMNS = ("median", "p99", "n", "x loop", "change", "objects", "KiB")
WIDTHS = (9, 9, 6, 8, 7, 8, 7)
NAME, UNIT, PEER = 29, 5, 15
TITLES = {
    "step": "step of the paper's main case, by stage",
    "plan": "plan of 10 s of turns, and its parts",
    "preview": "preview of 10 s",
    "drag": "drag of a gate, the preview after it",
    "path": "path search, a plan past obstacles",
    "resample": "resample of a recording of 10 s",
    "bake": "bake of 10 s at 60 fps",
    "files": "files of a recording of 10 s",
    "crowd": "crowd: skiers in one process and in two",
    "instructions": "instructions, in thousands",
}
"""Headings of the subjects."""


def table(rows: Sequence[Measurement], before: Mapping[str, float] | None = None, limit: float = WORSE) -> str:
    """Return the table of `rows`; `change` is the ratio to the loop by the one `before` of the same key.

    Checked rows that are worse by more than `limit` are marked.
    """
    before = before or {}
    head = [f"{'':{NAME}}{'unit':{UNIT}}"] + [
        f"{column:>{width}}" for column, width in zip(COLUMNS, WIDTHS, strict=True)
    ]
    lines = ["".join(head) + f"  {'peer':{PEER}}{'x peer':>7}{'p99 x':>7}"]
    lines.append("-" * len(lines[0]))
    for subject, group in groupby(rows, key=lambda row: row.subject):
        lines.append(TITLES.get(subject, subject))
        lines += [line(row, before.get(row.key), limit) for row in group]
    return "\n".join(lines)


def line(row: Measurement, before: float | None = None, limit: float = WORSE) -> str:
    """Return one line of the table."""
    change = row.change(before)
    cells = (
        number(row.median),
        number(row.p99),
        str(row.n),
        number(row.ratio),
        "" if change is None else number(change) + ("!" if row.worse(before, limit) else " "),
        "" if row.objects is None else f"{row.objects:.0f}",
        number(row.kib),
    )
    text = f"{'  ' + row.name:{NAME}.{NAME - 1}}{row.unit:{UNIT}}"
    text += "".join(f"{cell:>{width}}" for cell, width in zip(cells, WIDTHS, strict=True))
    beside = "".join(f"{number(ratio):>7}" for ratio in (row.peer_ratio, row.peer_p99))
    return f"{text}  {row.peer:{PEER}.{PEER}}{beside}".rstrip()


def number(value: float | None) -> str:
    """Return a number with three figures or more, without an exponent; nothing for None."""
    if value is None:
        return ""
    size = abs(value)
    return f"{value:.0f}" if size >= 99.95 or size == 0 else f"{value:.1f}" if size >= 9.995 else f"{value:.2f}"
