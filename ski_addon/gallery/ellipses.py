"""Fig. 7: the ellipses that lead to the target's, from inside and outside the box around it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..report.style import LEFT, QUIET, RIGHT, THIRD
from ..turning.ellipse import ControlBounds, wanted_acceleration

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHARPNESS, FREQUENCY = np.deg2rad(23.0), np.pi
STEP = 0.004


def draw_controlling_ellipses(figure: Figure) -> None:
    """Draw both families of ellipses of Fig. 7, and states that are led onto the target by them."""
    families, ways = figure.subplots(1, 2)
    for axes in (families, ways):
        angle = np.linspace(0.0, 2.0 * np.pi, 200)
        axes.axhline(0.0, color=QUIET, linewidth=0.8)
        axes.axvline(0.0, color=QUIET, linewidth=0.8)
        axes.set_xlabel("lean, °")
        axes.set_ylabel("lean rate, °/s")
        axes.plot(*_degrees(SHARPNESS * np.sin(angle), FREQUENCY * SHARPNESS * np.cos(angle)), color="black", lw=2.2)
    _draw_families(families)
    _draw_ways(ways)


def _draw_families(axes: Any) -> None:
    """Draw quarter ellipses: blue going out (same greatest lean), orange coming back (same rate when upright)."""
    for sign in (1.0, -1.0):
        out, back = np.linspace(0.0, 0.5 * np.pi, 60), np.linspace(0.5 * np.pi, np.pi, 60)
        for share in (0.25, 0.5, 0.75):
            lean, rate = SHARPNESS * np.sin(out), share * FREQUENCY * SHARPNESS * np.cos(out)
            axes.plot(*_degrees(sign * lean, sign * rate), color=LEFT, lw=1.2)
            lean, rate = share * SHARPNESS * np.sin(back), FREQUENCY * SHARPNESS * np.cos(back)
            axes.plot(*_degrees(sign * lean, sign * rate), color=RIGHT, lw=1.2)
    axes.set_title("Going out (blue): to the target's lean.\nComing back (orange): to its rate when upright.")


def _draw_ways(axes: Any) -> None:
    """Draw ways from states everywhere onto the target."""
    lean = np.deg2rad([12.0, 4.0, -12.0, -6.0, 30.0, -32.0, 2.0, 0.0, 16.0])
    rate = np.deg2rad([30.0, -20.0, -35.0, 60.0, 0.0, 40.0, 100.0, 0.0, -88.0])
    begin = lean, rate
    rows = []
    for _ in range(round(3.0 / STEP)):
        rows.append((lean, rate))
        faster = rate + STEP * wanted_acceleration(lean, rate, FREQUENCY, SHARPNESS, ControlBounds())
        lean, rate = lean + 0.5 * STEP * (rate + faster), faster
    way = np.array(rows)
    axes.plot(*_degrees(way[:, 0], way[:, 1]), color=THIRD, lw=1.0)
    axes.plot(*_degrees(*begin), "o", color=THIRD, ms=5)
    axes.set_title("Nine states, inside and outside the box, and the\none at rest, come onto the target.")


def _degrees(*values: np.ndarray) -> tuple[np.ndarray, ...]:
    return tuple(np.rad2deg(value) for value in values)
