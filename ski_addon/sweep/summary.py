"""The table at the end of a sweep: as JSON, as CSV, and for a screen."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .. import atomic
from ..talk import json_text
from .combinations import Combination

if TYPE_CHECKING:
    from .running import Outcome

IMPOSSIBLE = "impossible"
"""Status of a run that cannot be skied."""
NUMBERS = {
    "duration_s": ("time", "{:.2f} s"),
    "speed_max": ("fastest", "{:.1f} m/s"),
    "inclination_max_deg": ("lean", "{:.0f} deg"),
    "torque_ratio_max": ("torque", "{:.0%}"),
    "ski_error_max_m": ("off by", "{:.2g} m"),
    "capture_margin_min_m": ("margin", "{:.2g} m"),
}
"""Keys of a run's summary that the table shows, with heading and form."""


def sweep_summary(combinations: Sequence[Combination], outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """Return the whole table: `keys` that vary, how many runs of each status, and a row of every run."""
    rows = [_row(*pair) for pair in zip(combinations, outcomes, strict=True)]
    statuses = [row["status"] for row in rows]
    return {
        "keys": list(combinations[0].values),
        "runs": len(rows),
        "kept": sum(outcome.kept for outcome in outcomes),
        "statuses": {status: statuses.count(status) for status in dict.fromkeys(statuses)},
        "rows": rows,
    }


def write_summary(folder: Path, summary: Mapping[str, Any]) -> None:
    """Write sweep.json and sweep.csv into `folder`; raises `OutputError`."""
    atomic.write_text(folder / "sweep.json", json_text(summary))
    stream = io.StringIO()
    rows = [
        {**row["values"], **{key: value for key, value in row.items() if key != "values"}} for row in summary["rows"]
    ]
    table = csv.DictWriter(stream, list(rows[0]), lineterminator="\n")
    table.writeheader()
    table.writerows(rows)
    atomic.write_text(folder / "sweep.csv", stream.getvalue())


def sweep_lines(summary: Mapping[str, Any]) -> list[str]:
    """Return the table for a screen, and what became of the runs."""
    head = [key.rpartition(".")[2] for key in summary["keys"]] + ["status", *(label for label, _ in NUMBERS.values())]
    cells = [head]
    for row in summary["rows"]:
        numbers = ["" if row[key] is None else form.format(row[key]) for key, (_, form) in NUMBERS.items()]
        cells.append([*row["values"].values(), row["status"], *numbers])
    widths = [max(len(line[k]) for line in cells) for k in range(len(head))]
    lines = ["  " + "  ".join(cell.rjust(width) for cell, width in zip(line, widths, strict=True)) for line in cells]
    lines += [f"  {row['folder']}: {row['detail']}" for row in summary["rows"] if row["detail"]]
    counts = ", ".join(f"{count} {status}" for status, count in summary["statuses"].items())
    kept = f", {summary['kept']} of them up to date" if summary["kept"] else ""
    return [*lines, f"{summary['runs']} runs: {counts}{kept}"]


def _row(combination: Combination, outcome: Outcome) -> dict[str, Any]:
    known = outcome.summary or {}
    detail = known.get("status_detail") or {}
    said = f"{detail['what']} at {detail['time']:.2f} s; {detail['why']}" if detail else outcome.error
    return {
        "values": combination.values,
        "status": known.get("status", IMPOSSIBLE),
        **{key: known.get(key) for key in NUMBERS},
        "folder": combination.name,
        "spec_hash": combination.spec.content_hash(),
        "detail": said,
    }
