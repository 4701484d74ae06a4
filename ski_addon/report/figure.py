"""The report as one figure: where each plot stands, and the title over them."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING

import matplotlib
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from .. import atomic
from ..errors import RecordingError
from ..simulation import recorded_gates
from . import gate_panels, panels
from .headline import headline
from .style import INK, QUIET, RC

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..simulation import GatePassing, Recording

SIZE_INCHES = (14.0, 19.0)
GATE_INCHES = 1.9
"""How much taller a report with gates is."""
DPI = 110
MARGINS = {"left": 0.055, "right": 0.975, "top": 0.938, "bottom": 0.032}
PANELS = (
    (panels.draw_lean, panels.draw_speed),
    (panels.draw_ski_forces, panels.draw_force_split),
    (panels.draw_torques, panels.draw_errors),
    (panels.draw_margins, panels.draw_offsets),
    (panels.draw_skid, panels.draw_legs),
)
"""Plots over time, row by row."""


def draw_figure(recording: Recording) -> Figure:
    """Return the report of a recording as a matplotlib figure (drawn without a display)."""
    if not len(recording.time):
        raise RecordingError("given", "it holds no steps to draw")
    with matplotlib.rc_context(RC):
        passing = recorded_gates(recording)
        more = [GATE_INCHES] if passing else []
        figure = Figure(figsize=(SIZE_INCHES[0], SIZE_INCHES[1] + sum(more)), dpi=DPI, facecolor="white")
        FigureCanvasAgg(figure)
        ratios = (0.95, *(0.32 * inches for inches in more), 1, 1, 1, 1, 0.85)
        grid = figure.add_gridspec(len(ratios), 2, height_ratios=ratios, hspace=0.42, wspace=0.14, **MARGINS)
        _draw_track(figure, figure.add_subplot(grid[0, :]), recording, passing)
        if passing:
            gate_panels.draw_gates(figure.add_subplot(grid[1, :]), passing)
        for row, pair in enumerate(PANELS, start=1 + len(more)):
            for column, draw in enumerate(pair):
                axes = figure.add_subplot(grid[row, column])
                draw(axes, recording)
                if row == len(ratios) - 1:
                    axes.set_xlabel("s")
        _write_title(figure, recording)
    return figure


def _draw_track(figure: Figure, axes: Axes, recording: Recording, passing: GatePassing | None) -> None:
    """Draw the track with its colour bar and the poles of its gates."""
    colours = panels.draw_track(axes, recording)
    bar = figure.colorbar(colours, ax=axes, pad=0.01, fraction=0.02)
    bar.ax.set_title("m/s", loc="center", fontsize=9, fontweight="normal")
    if passing is None:
        return
    gate_panels.draw_poles(axes, passing)
    wider = gate_panels.widening(recording.track_position)
    if wider > 1:
        axes.set_aspect(wider, adjustable="datalim")
        axes.set_title(f"{axes.get_title(loc='left')}, drawn {wider} times wider than it is", pad=8)


def save_figure(figure: Figure, target: Path) -> None:
    """Write the figure as a picture file in one step."""
    with atomic.atomic_path(target) as temporary, matplotlib.rc_context(RC), warnings.catch_warnings():
        warnings.filterwarnings("ignore", "Glyph")  # letters of a run's name that the font lacks become boxes
        figure.savefig(temporary, metadata={"Software": "Ski Addon"} if target.suffix == ".png" else None)


def _write_title(figure: Figure, recording: Recording) -> None:
    name, facts = headline(recording)
    figure.text(0.055, 0.98, name, fontsize=17, fontweight="bold", color=INK, va="center", parse_math=False)
    figure.text(0.055, 0.9635, facts, fontsize=10.5, color=INK, va="center")
    figure.text(0.975, 0.9635, "grey: transition between turns", fontsize=9, color=QUIET, va="center", ha="right")
