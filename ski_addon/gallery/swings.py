"""Figs. 6 and 8: single bodies that swing, in the phase diagram and on the snow."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..report.style import LEFT, QUIET, RIGHT, THIRD
from ..turning.body import TurningBody
from ..turning.openloop import swing_open_loop
from ..turning.steering import Start, Steered, Targets, steer

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEED = 8.0
"""Speed [m/s]; the paper does not tell its own."""
ELLIPSES = ((2.0, 23.0, LEFT), (3.0, 23.0, RIGHT), (2.0, 7.0, THIRD))
"""Period [s] and sharpness [degrees] of the paper's three ellipses, and a colour."""
STEP = 0.005


def draw_three_ellipses(figure: Figure) -> None:
    """Draw the three ellipses of Fig. 6 and the tracks of bodies that swing on them, open loop."""
    diagram, *tracks = _diagram_and_tracks(figure, len(ELLIPSES))
    for number, (axes, (period, sharpness, colour)) in enumerate(zip(tracks, ELLIPSES, strict=True), start=1):
        w = 2.0 * np.pi / period
        swing = swing_open_loop(TurningBody(), w, np.deg2rad(sharpness), SPEED, 52.0 / SPEED, STEP)
        diagram.plot(np.rad2deg(swing.lean), np.rad2deg(swing.lean_rate), color=colour)
        name = f"{number}: a swing of {period:g} s and {sharpness:g}°"
        axes.plot(swing.x, swing.y, color=colour)
        one = slice(0, round(period / STEP) + 1)
        size, length = 0.5 * np.ptp(swing.y[one, 0]), swing.x[one, 0][-1]
        axes.set_title(f"{name}: {length:.1f} m long, {size:.2f} m to each side")
        axes.set_xlim(0.0, 44.0)
        axes.set_ylim(-1.7, 1.7)
        axes.set_ylabel("m, wider")
    diagram.annotate("1", (0, 72), xytext=(2, 3), textcoords="offset points", color=LEFT)
    diagram.annotate("2", (0, 48), xytext=(2, 3), textcoords="offset points", color=RIGHT)
    diagram.annotate("3", (0, 22), xytext=(2, 3), textcoords="offset points", color=THIRD)
    tracks[-1].set_xlabel("m")


def turned_track(change_deg: float = 14.0, at: float = 26.0) -> Steered:
    """Return the body of Fig. 8: swings of 2 s and 20 degrees, and a heading that changes where it has gone `at` [m].

    The change is asked for within the right turn that is under way there, so that this turn is shorter.
    """
    time = STEP * np.arange(round(7.0 / STEP))
    ones = np.ones((len(time), 1))
    heading = np.where(SPEED * time < at, 0.0, np.deg2rad(change_deg))[:, None]
    targets = Targets(STEP, np.pi * ones, np.deg2rad(20.0) * ones, heading)
    return steer(TurningBody(), targets, Start(SPEED))


def draw_direction_change(figure: Figure) -> None:
    """Draw a change of direction to the left that one short right turn makes, as in Fig. 8."""
    run = turned_track()
    diagram, track, angles = _diagram_and_tracks(figure, 2)
    modified = np.abs(run.beta[:, 0] - 1.0) > 0.02
    for axes, x, y in (
        (diagram, np.rad2deg(run.lean[:, 0]), np.rad2deg(run.lean_rate[:, 0])),
        (track, run.down[:, 0], run.left[:, 0]),
    ):
        axes.plot(x, y, color=QUIET)
        axes.plot(np.where(modified, x, np.nan), np.where(modified, y, np.nan), color=RIGHT, linewidth=2.2)
    beta = float(run.beta[modified, 0][0])
    track.set_title(f"One right turn with $\\beta$ = {beta:.2f} (orange) turns the track 14° to the left")
    angles.plot(run.time, np.rad2deg(run.lean[:, 0]), color=LEFT, label="lean")
    angles.plot(run.time, np.rad2deg(run.course[:, 0]), color=THIRD, label="direction")
    angles.set_ylabel("°")
    angles.set_xlabel("s")
    angles.legend(loc="upper left", ncols=2)
    track.set_aspect("equal", adjustable="datalim")
    track.set_xlabel("m")


def _diagram_and_tracks(figure: Figure, count: int) -> list[Any]:
    """Return axes of a phase diagram on the left and of `count` tracks, one over the other, beside it."""
    grid = figure.add_gridspec(count, 2, width_ratios=(1.0, 2.1))
    diagram = figure.add_subplot(grid[:, 0])
    diagram.axhline(0.0, color=QUIET, linewidth=0.8)
    diagram.axvline(0.0, color=QUIET, linewidth=0.8)
    diagram.set_title("Phase diagram")
    diagram.set_xlabel("lean, °")
    diagram.set_ylabel("lean rate, °/s")
    tracks = [figure.add_subplot(grid[row, 1]) for row in range(count)]
    for axes in tracks:
        axes.axhline(0.0, color=QUIET, linewidth=0.6)
    return [diagram, *tracks]
