"""The table of pushes as a picture: rows by forces, coloured by what became of the skier."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from .. import atomic
from ..report.style import INK, QUIET, RC
from ..spec import RunSpec
from .cases import PushTable
from .moments import WATCH
from .running import FELL, RECOVERED, SURVIVED
from .summary import RowSummary, cell, largest_text

COLOURS = {RECOVERED: "#7FC8AE", SURVIVED: "#F2D479", FELL: "#E08A6A"}
"""Back on the plan, only still up, fallen; colour-blind people tell them apart too."""
WORDS = {RECOVERED: "back on the plan (after so many seconds)", SURVIVED: "up, not back in time", FELL: "fell"}
ROW_INCHES = 0.235
HEAD_INCHES, FOOT_INCHES = 1.45, 0.3
COLUMN_INCHES, LABEL_INCHES, RIGHT_INCHES = 0.95, 3.1, 2.75


def draw_table(spec: RunSpec, table: PushTable, rows: Sequence[RowSummary]) -> Figure:
    """Return the table as a matplotlib figure (drawn without a display)."""
    width = LABEL_INCHES + COLUMN_INCHES * len(table.forces) + RIGHT_INCHES
    height = HEAD_INCHES + ROW_INCHES * len(rows) + FOOT_INCHES
    with matplotlib.rc_context(RC):
        figure = Figure(figsize=(width, height), dpi=110, facecolor="white")
        FigureCanvasAgg(figure)
        axes = figure.add_axes((0, FOOT_INCHES / height, 1, ROW_INCHES * len(rows) / height))
        axes.set_axis_off()
        axes.set_xlim(0, width)
        axes.set_ylim(len(rows), 0)
        for place, row in enumerate(rows):
            _draw_labels(axes, place, row, rows[place - 1] if place else None, width)
            _draw_cells(axes, place, row, table.forces)
        _draw_head(axes, table)
        _write_title(figure, spec, table, rows, height)
    return figure


def save_table(figure: Figure, target: Path) -> None:
    """Write the figure as a picture file in one step."""
    with atomic.atomic_path(target) as temporary, matplotlib.rc_context(RC), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph")  # letters of a run's name that the font lacks become boxes
        figure.savefig(temporary, metadata={"Software": "Ski Addon"})


def _draw_labels(axes: Any, place: int, row: RowSummary, before: RowSummary | None, width: float) -> None:
    """Write what a row is, each word only where it changes, and draw a line between groups."""
    words = (f"{row.row.speed:g} m/s", row.row.moment, row.row.body, row.row.direction)
    last = (
        (f"{before.row.speed:g} m/s", before.row.moment, before.row.body, before.row.direction)
        if before
        else (None,) * 4
    )
    changed = [words[: level + 1] != last[: level + 1] for level in range(4)]
    for at, word, shown in zip((0.15, 0.75, 1.6, 2.4), words, changed, strict=True):
        if shown:
            axes.text(at, place + 0.5, word, va="center", color=INK)
    if before and changed[2]:
        strong = changed[1]
        axes.plot(
            (0.15 if strong else 1.6, width - 0.15),
            (place, place),
            color=INK if strong else QUIET,
            linewidth=0.8,
            zorder=3,
        )


def _draw_cells(axes: Any, place: int, row: RowSummary, forces: Sequence[float]) -> None:
    for column, force in enumerate(forces):
        result = row.results.get(force)
        if result is None:
            continue
        left = LABEL_INCHES + COLUMN_INCHES * column
        box = Rectangle(
            (left + 0.02, place + 0.06), COLUMN_INCHES - 0.04, 0.88, color=COLOURS[result.status], linewidth=0
        )
        axes.add_patch(box)
        axes.text(left + COLUMN_INCHES / 2, place + 0.5, cell(result), va="center", ha="center", color=INK)
    right = LABEL_INCHES + COLUMN_INCHES * len(forces)
    bound = "–" if row.bound_n is None else f"{row.bound_n:.0f} N"
    ratio = "–" if row.ratio is None else f"{row.ratio:.2f}"
    for at, word in zip((0.95, 1.8, 2.5), (largest_text(row).replace(">=", "≥ "), bound, ratio), strict=True):
        axes.text(right + at, place + 0.5, word, va="center", ha="right", color=INK)


def _draw_head(axes: Any, table: PushTable) -> None:
    right = LABEL_INCHES + COLUMN_INCHES * len(table.forces)
    style = {"va": "bottom", "color": INK, "fontweight": "bold"}
    for at, word in zip((0.15, 0.75, 1.6, 2.4), ("start", "moment", "body", "push"), strict=True):
        axes.text(at, -0.25, word, **style)
    for column, force in enumerate(table.forces):
        axes.text(LABEL_INCHES + COLUMN_INCHES * (column + 0.5), -0.25, f"{force:g} N", ha="center", **style)
    for at, word in zip((0.95, 1.8, 2.5), ("largest\nsurvived", "capture\nbound", "ratio"), strict=True):
        axes.text(right + at, -0.25, word, ha="right", linespacing=1.1, **style)


def _write_title(figure: Figure, spec: RunSpec, table: PushTable, rows: Sequence[RowSummary], height: float) -> None:
    asked = [result for row in rows for force, result in row.results.items() if force in table.forces]
    counts = {status: sum(result.status == status for result in asked) for status in COLOURS}
    name = f"{' '.join(spec.name.split())}: pushed for {table.duration:g} s"
    up = len(asked) - counts[FELL]
    facts = f"still up: {up} of {len(asked)}; back on the plan within {WATCH:g} s: {counts[RECOVERED]}"
    left = 0.15 / figure.get_figwidth()
    figure.text(left, 1 - 0.28 / height, name, fontsize=14, fontweight="bold", color=INK, va="center", parse_math=False)
    figure.text(left, 1 - 0.56 / height, facts, fontsize=10, color=INK, va="center")
    patches = [Patch(color=colour, label=f"{WORDS[status]}: {counts[status]}") for status, colour in COLOURS.items()]
    figure.legend(
        handles=patches,
        loc="center left",
        bbox_to_anchor=(left, 1 - 0.82 / height),
        ncols=3,
        borderaxespad=0,
        borderpad=0,
    )
