"""The pictures of docs/gates.md and docs/drawn_path.md: `python -m benchmarks.course_pictures [FOLDER]`."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from benchmarks.gate_lines import Curve, our_line, paper_line
from ski_addon.course.gate_settings import set_poles
from ski_addon.course.path import build_path_track
from ski_addon.report.style import RC
from ski_addon.spec import RunSpec, find_document
from ski_addon.terrain import build_terrain

ROOT = Path(__file__).resolve().parents[1]
LEFT, RIGHT, PAPER, LINE = "#2a6fbb", "#c8372d", "#c98a1b", "#222222"


def draw_gates() -> Figure:
    """Return plan views of a slalom and a giant slalom with the paper's line and ours, and their curvatures."""
    figure = _figure(11.5, 7.6)
    grid = figure.add_gridspec(4, 1, height_ratios=(1.15, 0.8, 1.15, 0.8))
    for row, (name, shown) in enumerate((("slalom", 7), ("giant_slalom_race", 7))):
        spec = RunSpec.from_toml(find_document(name))
        poles = set_poles(spec)
        ours = our_line(spec, poles)
        tightest = 1.0 / float(np.max(np.abs(ours.curvature)))
        paper = paper_line(poles, tightest)
        span = (poles.down[0] - 0.9 * np.diff(poles.down)[0], poles.down[shown - 1] + 0.6 * np.diff(poles.down)[0])
        plan, bend = figure.add_subplot(grid[2 * row]), figure.add_subplot(grid[2 * row + 1])
        _draw_plan(plan, poles, ours, paper)
        plan.set(xlim=span, title=f"{spec.name}: the tightest turn has a radius of {tightest:.1f} m", ylabel="m left")
        for curve, colour, label in ((paper, PAPER, "arcs and cubic links"), (ours, LINE, "smoothest line")):
            bend.plot(curve.down, curve.curvature, color=colour, lw=1.4, label=label)
        bend.set(xlim=span, ylabel="curvature, 1/m", xlabel="m down the slope" if row else "")
        bend.legend(loc="upper right", ncols=2, frameon=False, fontsize=8, bbox_to_anchor=(1.0, 1.3))
    return figure


def draw_path() -> Figure:
    """Return the drawn path of a preset, its points and the smooth path at two start speeds."""
    figure = _figure(11.5, 2.6)
    axes = figure.add_subplot()
    spec = RunSpec.from_toml(find_document("drawn_path"))
    points = np.array([(point.x, point.y) for point in spec.point])
    axes.plot(*points.T, "o:", color=PAPER, ms=5, lw=1.0, label="points")
    for speed, colour in ((6, LINE), (14, LEFT)):
        faster = spec.with_overrides({"course.target_speed": speed})
        track = build_path_track(faster, build_terrain(faster.slope))
        down = track.position[:, 0] / np.cos(build_terrain(spec.slope).mean_angle)
        axes.plot(down, track.position[:, 1], color=colour, lw=1.6, label=f"smoothed for {speed} m/s")
    axes.set(xlabel="m down the slope", ylabel="m left", aspect="equal")
    axes.legend(loc="lower right", frameon=False, fontsize=8)
    return figure


def _draw_plan(axes: Any, poles: Any, ours: Curve, paper: Curve) -> None:
    axes.plot(paper.down, paper.left, color=PAPER, lw=1.0)
    axes.plot(ours.down, ours.left, color=LINE, lw=1.6)
    for k in range(len(poles)):
        colour = LEFT if poles.side[k] > 0 else RIGHT
        axes.plot(poles.down[k], poles.left[k], "o", color=colour, ms=5)
        near = int(np.argmin(np.hypot(ours.down - poles.down[k], ours.left - poles.left[k])))
        bend = ours.curvature[near]
        if abs(bend) < 0.02:
            continue
        heading = np.arctan2(*np.array([np.gradient(ours.left)[near], np.gradient(ours.down)[near]]))
        centre = (ours.down[near] - np.sin(heading) / bend, ours.left[near] + np.cos(heading) / bend)
        middle = np.arctan2(ours.left[near] - centre[1], ours.down[near] - centre[0])
        angle = middle + np.linspace(-0.45, 0.45, 40)
        axes.plot(
            centre[0] + np.cos(angle) / abs(bend), centre[1] + np.sin(angle) / abs(bend), color=colour, lw=4, alpha=0.35
        )
        axes.annotate(
            f"r {1.0 / abs(bend):.1f} m",
            (ours.down[near], ours.left[near]),
            xytext=(0, -9 * poles.side[k]),
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize=7,
        )
    axes.set(aspect="equal", adjustable="box", ylim=(-0.028 * poles.down[6] - 3.0, 0.028 * poles.down[6] + 3.0))


def _figure(width: float, height: float) -> Figure:
    figure = Figure(figsize=(width, height), dpi=110, facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def main(folder: Path = ROOT / "docs" / "images") -> None:
    """Draw all pictures into `folder`."""
    with matplotlib.rc_context(RC):
        draw_gates().savefig(folder / "gates.png", metadata={"Software": "Ski Addon"})
        draw_path().savefig(folder / "drawn_path.png", metadata={"Software": "Ski Addon"})


if __name__ == "__main__":
    main(*(Path(name) for name in sys.argv[1:2]))
