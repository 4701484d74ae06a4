"""The table of pushes as numbers, lines, JSON and CSV."""

from __future__ import annotations

import csv
import io
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from .. import atomic
from ..spec import RunSpec
from ..talk import json_text
from .cases import PushTable, Row
from .running import FELL, RECOVERED, RunResult


@dataclass(frozen=True)
class RowSummary:
    """One line of the table: the results by force [N] in rising order, and what follows from them.

    `largest_n` is the largest force that was survived with every smaller one tried (0: none), `fell_at_n` the least
    one that was not (None: all were survived), `bound_n` the capture bound and `ratio` that of largest to bound.
    """

    row: Row
    results: Mapping[float, RunResult]
    largest_n: float
    fell_at_n: float | None
    bound_n: float | None
    ratio: float | None


def summarise_rows(results: Sequence[RunResult]) -> list[RowSummary]:
    """Return the lines of the table, in the order of their first results."""
    rows: dict[Row, dict[float, RunResult]] = {}
    for result in results:
        rows.setdefault(result.case.row, {})[result.case.force] = result
    return [_row_summary(row, dict(sorted(found.items()))) for row, found in rows.items()]


def summarise_table(spec: RunSpec, table: PushTable, results: Sequence[RunResult]) -> dict[str, Any]:
    """Return everything about a table as plain data: the contents of `robustness.json`."""
    rows = summarise_rows(results)
    asked = [result for result in results if result.case.force in table.forces]
    return {
        "name": spec.name,
        "spec": spec.to_toml(),
        "spec_hash": spec.content_hash(),
        "table": {**vars(table), "runs": len(table.cases)},
        "counts": {str(force): _counts([r for r in asked if r.case.force == force]) for force in table.forces},
        "all": _counts(asked),
        "rows": [{**vars(row.row), **_numbers(row)} for row in rows],
        "runs": [run_data(result) for result in results],
    }


def run_data(result: RunResult) -> dict[str, Any]:
    """Return one result as flat plain data: a line of `robustness.csv`."""
    rest = {name: value for name, value in vars(result).items() if name != "case"}
    return {**vars(result.case.row), "force_n": result.case.force, **rest}


def csv_text(results: Sequence[RunResult]) -> str:
    """Return the results as CSV, one line each below the names of the columns."""
    stream = io.StringIO()
    writer = csv.DictWriter(stream, list(run_data(results[0])), lineterminator="\n")
    writer.writeheader()
    writer.writerows(run_data(result) for result in results)
    return stream.getvalue()


def table_lines(table: PushTable, results: Sequence[RunResult]) -> list[str]:
    """Return the table for a screen: recovery times in seconds, "up" for not back in time, "fell"."""
    rows = summarise_rows(results)
    head = f"{'m/s':>4} {'moment':10} {'body':11} {'push':8}" + "".join(f"{force:>8g} N" for force in table.forces)
    lines = [f"{head}{'largest':>10}{'bound':>8}{'ratio':>7}"]
    for row in rows:
        start = f"{row.row.speed:4g} {row.row.moment:10} {row.row.body:11} {row.row.direction:8}"
        cells = "".join(f"{cell(row.results.get(force)):>10}" for force in table.forces)
        bound = "-" if row.bound_n is None else f"{row.bound_n:.0f} N"
        ratio = "-" if row.ratio is None else f"{row.ratio:.2f}"
        lines.append(f"{start}{cells}{largest_text(row):>10}{bound:>8}{ratio:>7}")
    for force in table.forces:
        counts = _counts([result for result in results if result.case.force == force])
        lines.append(f"{force:g} N: still up {counts['up']} of {counts['runs']}, back in time {counts['recovered']}")
    return lines


def cell(result: RunResult | None) -> str:
    """Return what a cell of the table says."""
    if result is None:
        return ""
    if result.status == RECOVERED:
        return f"{result.recovery_s:.1f} s"
    return "fell" if result.status == FELL else "up"


def largest_text(row: RowSummary) -> str:
    """Return the largest force survived as a person reads it; ">=" when no force was found that fells."""
    return f"{'>=' if row.fell_at_n is None else ''}{row.largest_n:g} N"


def write_results(
    folder: Path, spec: RunSpec, table: PushTable, results: Sequence[RunResult], *, picture: bool
) -> dict[str, Any]:
    """Write robustness.json, robustness.csv and (with `picture`) robustness.png into `folder`, all or none.

    Returns what is in the JSON. A picture of an earlier table goes if there is no new one.
    """
    summary = summarise_table(spec, table, results)
    with tempfile.TemporaryDirectory(prefix=".ski_addon.", dir=folder) as temporary:
        stage = Path(temporary)
        atomic.write_text(stage / "robustness.json", json_text(summary))
        atomic.write_text(stage / "robustness.csv", csv_text(results))
        if picture:
            from .plot import draw_table, save_table

            save_table(draw_table(spec, table, summarise_rows(results)), stage / "robustness.png")
        else:
            (folder / "robustness.png").unlink(missing_ok=True)
        atomic.move_all(stage, folder)
    return summary


def _row_summary(row: Row, results: dict[float, RunResult]) -> RowSummary:
    fallen = [force for force, result in results.items() if result.status == FELL]
    fell_at = min(fallen, default=None)
    largest = max((force for force in results if fell_at is None or force < fell_at), default=0.0)
    bound = next(iter(results.values())).bound_n
    return RowSummary(row, results, largest, fell_at, bound, largest / bound if bound else None)


def _numbers(row: RowSummary) -> dict[str, float | None]:
    return {"largest_n": row.largest_n, "fell_at_n": row.fell_at_n, "bound_n": row.bound_n, "ratio": row.ratio}


def _counts(results: Sequence[RunResult]) -> dict[str, Any]:
    """Return how many of the runs stayed up and recovered, and the worst numbers of those that stayed up."""
    up = [result for result in results if result.status != FELL]
    back = [result.recovery_s for result in up if result.recovery_s is not None]
    return {
        "runs": len(results),
        "up": len(up),
        "recovered": len(back),
        "recovery_max_s": max(back, default=None),
        "ski_offset_max_m": max((result.ski_offset_max_m for result in up), default=None),
        "torque_ratio_max": max((result.torque_ratio_max for result in up), default=None),
        "joint_margin_min_deg": min((result.joint_margin_min_deg for result in up), default=None),
        "root_residual_max": max((result.root_residual_max for result in up), default=None),
    }
