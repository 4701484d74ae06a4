"""Draws the picture of the page on terrain: `python -m tests.terrain.terrain_picture`."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ski_addon.report.style import INK, LEFT, QUIET, RC, RIGHT, THIRD
from ski_addon.spec import SlopeSpec
from ski_addon.terrain import BumpTrain, build_terrain, mogul_crests, mogul_troughs

PATH = Path(__file__).resolve().parents[2] / "docs" / "images" / "terrain.png"
BUMPS = BumpTrain(count=2, height=1.0, width=8.0, start=2.0, fillet=0.25)


def draw_bumps(axes):
    """The profile over the plane, a little stretched upwards: arcs, fillets, ramps, radius, height and width."""
    down = np.linspace(0.0, 36.0, 4001)
    up, _, bend = BUMPS.profile(down)
    place = (down - BUMPS.start) / BUMPS.width - 1.0
    last = 2 * (BUMPS.count - 1)
    from_top = np.abs(place - np.clip(np.round(place), 0, last))
    ramp = (place < 0) | (place > last)
    arc = (from_top <= 0.5 * (1 - BUMPS.fillet)) & ~ramp
    for mask, colour, name in (
        (arc, LEFT, "arc"),
        (~arc & ~ramp, RIGHT, "fillet"),
        (ramp, THIRD, "ramp, and the plane"),
    ):
        axes.plot(down, np.where(mask, up, np.nan), color=colour, linewidth=2.6, label=name)
    axes.axhline(0.0, color=QUIET, linewidth=0.8, zorder=0)
    crest, trough = BUMPS.crests()[1], BUMPS.troughs()[0]
    for top, side in ((crest, -1.0), (trough, 1.0)):
        centre = side * (BUMPS.radius - BUMPS.height)
        turn = np.linspace(-0.62, 0.62, 200)
        axes.plot(top + BUMPS.radius * np.sin(turn), centre - side * BUMPS.radius * np.cos(turn), ":", color=QUIET)
    foot = np.array((trough, BUMPS.radius - BUMPS.height))
    rim = foot + BUMPS.radius * np.array((np.sin(0.24), -np.cos(0.24)))
    axes.annotate("", rim, foot + 0.47 * (rim - foot), arrowprops={"arrowstyle": "->", "color": INK})
    axes.text(trough + 1.6, 2.6, f"r = h/2 + w²/8h = {BUMPS.radius:.1f} m", color=INK)
    _measure(axes, (crest, 0.0), (crest, BUMPS.height), "h", (0.5, -0.1))
    _measure(axes, (crest - 4.0, -1.55), (crest + 4.0, -1.55), "w", (0.0, -0.4))
    side = axes.twinx()
    side.fill_between(down, bend, color=QUIET, alpha=0.25, linewidth=0)
    side.set(ylim=(-0.45, 0.8), yticks=(-1 / BUMPS.radius, 0, 1 / BUMPS.radius), yticklabels=("-1/r", "0", "1/r"))
    side.set_ylabel("curvature (grey)")
    axes.set(title="Bumps: arcs of circles, filleted (2 crests, h = 1 m, w = 8 m)", xlim=(0, 36), ylim=(-2.6, 4.6))
    axes.set(xlabel="down the slope [m]", ylabel="over the plane [m]")
    axes.legend(loc="upper left", ncols=3)


def draw_moguls(axes, figure):
    """Height over the plane, seen from above, with crests and troughs marked."""
    spec = SlopeSpec(kind="moguls", angle_deg=20, mogul_count=5, mogul_across=3.0, bump_start=2)
    relief = build_terrain(spec).relief
    down, left = np.meshgrid(np.linspace(0, 26, 521), np.linspace(-7, 7, 281), indexing="ij")
    up = relief.over(down, left)[0]
    shown = axes.imshow(up.T, extent=(0, 26, -7, 7), origin="lower", cmap="RdBu_r", vmin=-0.3, vmax=0.3)
    crests, troughs = mogul_crests(spec, 7.0), mogul_troughs(spec, 7.0)
    axes.plot(*crests.T, "^", color=INK, markersize=6, label="crest")
    axes.plot(*troughs.T, "o", color=INK, markersize=4, markerfacecolor="none", label="trough")
    axes.set(title="Moguls: 5 rows, 3.5 m apart, columns 3 m apart", xlabel="down the slope [m]", ylabel="left [m]")
    axes.legend(loc="center right")
    figure.colorbar(shown, ax=axes, label="over the plane [m]", shrink=0.9, pad=0.02)


def draw_hill(axes, figure):
    """The shipped ground on 15 degrees: how steep it is along the fall line, with lines of equal height over it."""
    terrain = build_terrain(SlopeSpec(kind="grid", angle_deg=15, grid_file="rolling_hill"))
    x, y = np.meshgrid(np.linspace(-10, 590, 1201), np.linspace(-60, 60, 241), indexing="ij")
    steepness = np.degrees(np.arctan(-terrain.gradient(x, y)[..., 0]))
    over = terrain.height(x, y) + x * np.tan(terrain.mean_angle)
    shown = axes.imshow(steepness.T, extent=(-10, 590, -60, 60), origin="lower", cmap="viridis", vmin=10, vmax=20)
    axes.contour(x, y, over, levels=np.arange(-1.2, 1.3, 0.4), colors="white", linewidths=0.6, alpha=0.8)
    axes.plot(0, 0, "o", color=RIGHT, markersize=7, markeredgecolor="white")
    axes.annotate("start", (0, 0), (8, 8), textcoords="offset points", color="white")
    axes.set(title='A grid: "rolling_hill" on a slope of 15 degrees', xlabel="x, downhill [m]", ylabel="y, left [m]")
    figure.colorbar(shown, ax=axes, label="steepness [°]", shrink=0.9, pad=0.02)


def draw(path: Path = PATH) -> None:
    """Write the picture."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    with plt.rc_context(RC):
        figure, (top, middle, bottom) = plt.subplots(3, 1, figsize=(9, 9.6), height_ratios=(1, 1.5, 0.6))
        draw_bumps(top)
        draw_moguls(middle, figure)
        draw_hill(bottom, figure)
        figure.tight_layout()
        figure.savefig(path, dpi=100, metadata={"Software": None})


def _measure(axes, start, end, name, offset):
    axes.annotate("", end, start, arrowprops={"arrowstyle": "<->", "color": INK, "shrinkA": 0, "shrinkB": 0})
    middle = 0.5 * (np.array(start) + end) + offset
    axes.text(*middle, name, color=INK, ha="center", va="center", fontstyle="italic", fontsize=11)


if __name__ == "__main__":
    draw()
