"""Fig. 10: what an animator can draw with frequency, sharpness and heading."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..report.style import LEFT, QUIET, RIGHT
from ..turning.body import TurningBody
from ..turning.steering import Start, Steered, Targets, steer

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SPEED, DURATION, STEP = 8.0, 13.0, 0.01


def four_tracks() -> Steered:
    """Return the five bodies of Fig. 10: two of a figure 8, falling frequency, rising sharpness, changing direction."""
    time = STEP * np.arange(round(DURATION / STEP))
    one, part = np.ones_like(time), time / DURATION
    period = np.stack((2.6 * one, 2.6 * one, 1.4 + 3.0 * part, 2.2 * one, 2.0 * one), axis=1)
    sharpness = np.stack((26.0 * one, 26.0 * one, 18.0 * one, 5.0 + 28.0 * part, 20.0 * one), axis=1)
    heading = np.zeros_like(period)
    heading[:, 4] = 22.0 * (time > 3.0) - 44.0 * (time > 7.5)
    targets = Targets(STEP, 2.0 * np.pi / period, np.deg2rad(sharpness), np.deg2rad(heading))
    return steer(TurningBody(), targets, Start(SPEED, np.array([1.0, -1.0, 1.0, 1.0, 1.0])))


def draw_four_tracks(figure: Figure) -> None:
    """Draw the four tracks of Fig. 10."""
    run = four_tracks()
    names = (
        "1: two bodies, half a swing apart, make figures of 8",
        "2: falling frequency, swings of 1.4 to 4.4 s",
        "3: rising sharpness, 5° to 33°",
        "4: heading 0°, 22° left, 22° right",
    )
    drawn = ((0, 1), (2,), (3,), (4,))
    ratios = (1.0, 1.0, 1.0, 4.4)
    for axes, name, bodies in zip(figure.subplots(4, 1, sharex=True, height_ratios=ratios), names, drawn, strict=True):
        axes.axhline(0.0, color=QUIET, linewidth=0.6)
        for body, colour in zip(bodies, (LEFT, RIGHT), strict=False):
            axes.plot(run.down[:, body], run.left[:, body], color=colour)
        axes.set_title(name)
        axes.set_ylim(*((-3.0, 21.0) if bodies == (4,) else (-2.6, 2.6)))
        axes.set_aspect(2.0)
        axes.set_ylabel("m, 2 x wider")
    axes.set_xlabel("m")
