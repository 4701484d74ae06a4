"""Colours and small drawing habits that all plots share."""

from __future__ import annotations

from typing import Any

import numpy as np

from .series import Band, thinned

LEFT, RIGHT, THIRD, INK, QUIET = "#0072B2", "#D55E00", "#009E73", "#22303C", "#9AA5B1"
"""Left ski, right ski, a third curve, text, and what stands back (colours that also colour-blind people tell apart)."""
TRANSITION = "#E8ECF1"
ALARM = "#C1121F"
"""Falls and pushes."""
SPEED_MAP = "viridis"

RC: dict[Any, Any] = {
    "font.size": 9.5,
    "axes.edgecolor": QUIET,
    "axes.labelcolor": INK,
    "axes.titlecolor": INK,
    "axes.titlesize": 10.5,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "xtick.color": INK,
    "ytick.color": INK,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "agg.path.chunksize": 20000,
}


def draw_bands(axes: Any, bands: list[Band], *, named: bool = False) -> None:
    """Shade the transitions behind a plot over time; `named` writes left or right over each turn."""
    for band in bands:
        if band.phase == 0:
            axes.axvspan(band.start, band.end, color=TRANSITION, linewidth=0, zorder=0)
        elif named:
            axes.annotate(
                "left" if band.phase > 0 else "right",
                ((band.start + band.end) / 2, 1.0),
                xycoords=("data", "axes fraction"),
                xytext=(0, 2),
                textcoords="offset points",
                ha="center",
                va="bottom",
                fontsize=7.5,
                color=LEFT if band.phase > 0 else RIGHT,
            )


def curve(axes: Any, time: np.ndarray, values: np.ndarray, color: str, label: str = "", **style: Any) -> None:
    """Draw one curve over time, thinned so that its peaks stay."""
    axes.plot(*thinned(time, values), color=color, label=label or None, **({"linewidth": 1.2} | style))


def finish(axes: Any, title: str, unit: str, *, columns: int = 3) -> None:
    """Give a plot its title, unit, light grid and legend."""
    axes.set_title(title, pad=14 if title else 6)
    axes.set_ylabel(unit)
    axes.grid(axis="y", color=TRANSITION, linewidth=0.8)
    axes.margins(x=0)
    if axes.get_legend_handles_labels()[0]:
        low, high = axes.get_ylim()
        axes.set_ylim(low, high + 0.18 * (high - low))
        axes.legend(loc="upper left", ncols=columns, borderaxespad=0.2, handlelength=1.4, columnspacing=1.2)
