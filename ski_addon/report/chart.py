"""One plot on a canvas: its scales, ticks and grid, bands, curves and legend."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..frames import Array
from .canvas import Box, Canvas, width_of
from .series import Band, thinned
from .style import INK, LEFT, QUIET, RIGHT, TRANSITION

GRID, SOFT = "#DDE3EA", "#5D6A77"
"""Lines behind curves, and words that stand back."""
_TITLE, _LABEL, _SMALL = 11.5, 9.5, 8.0
"""Heights of capitals [pixels of a picture 1600 wide]."""


@dataclass(frozen=True)
class Entry:
    """A line of the legend: `words` behind a line of `color`, dashed or not."""

    words: str
    color: str
    dashed: bool = False


class Chart:
    """A plot in `box` of `canvas` over the ranges `x` and `y` (low, high); sizes are multiplied by `scale`."""

    def __init__(
        self, canvas: Canvas, box: Box, x: tuple[float, float], y: tuple[float, float], scale: float = 1.0
    ) -> None:
        self.canvas, self.box, self.scale = canvas, box, scale
        self.x, self.y = _widened(*x), _widened(*y)

    def place(self, x: Array | float, y: Array | float) -> Array:
        """Return the pixels (..., 2) of points with the coordinates `x` and `y`."""
        left, top, right, bottom = self.box
        across = left + (np.asarray(x, dtype=float) - self.x[0]) / (self.x[1] - self.x[0]) * (right - left)
        down = bottom - (np.asarray(y, dtype=float) - self.y[0]) / (self.y[1] - self.y[0]) * (bottom - top)
        return np.stack(np.broadcast_arrays(across, down), axis=-1)

    def bands(self, bands: list[Band]) -> None:
        """Shade transitions, and write over each turn to which side it goes if there is room."""
        for band in bands:
            start, end = (float(self.place(time, 0.0)[0]) for time in (band.start, band.end))
            if band.phase == 0:
                self.canvas.rectangle((start, self.box[1], end, self.box[3]), TRANSITION)
                continue
            words, color = ("left", LEFT) if band.phase > 0 else ("right", RIGHT)
            size = _SMALL * self.scale
            if width_of(words, size) + 4.0 * self.scale < end - start:
                middle = (0.5 * (start + end), self.box[1] - 6.0 * self.scale)
                self.canvas.text(middle, words, size, color, align="center")

    def axes(self, title: str, unit: str, *, x_ticks: Array | None = None, x_unit: str = "") -> None:
        """Draw grid, numbers and border, and write the title with its unit over the plot."""
        left, top, right, bottom = self.box
        size, one = _LABEL * self.scale, max(1.0, round(self.scale))
        for value in ticks(*self.y, most=max(3, int((bottom - top) / (45.0 * self.scale)))):
            row = float(np.round(self.place(self.x[0], value)[1]))
            self.canvas.rectangle((left, row, right, row + one), QUIET if value == 0.0 else GRID)
            beside = (left - 9.0 * self.scale, row + 0.5 * size)
            self.canvas.text(beside, number(value), size, INK, align="right")
        marks = ticks(*self.x, most=9) if x_ticks is None else x_ticks
        for value in marks:
            column = float(np.round(self.place(value, self.y[0])[0]))
            self.canvas.rectangle((column, bottom, column + one, bottom + 5.0 * self.scale), QUIET)
            unit_words = f" {x_unit}" if x_unit and value == marks[-1] else ""
            below = (column, bottom + 11.0 * self.scale + size)
            self.canvas.text(below, number(value) + unit_words, size, INK, align="center")
        self.canvas.rectangle((left, bottom, right, bottom + one), QUIET)
        end = self.canvas.text((left, self._title_line()), title, _TITLE * self.scale, INK, bold=True)
        self.canvas.text((end + 12.0 * self.scale, self._title_line()), unit, size, SOFT)

    def curve(
        self, x: Array, y: Array, color: str, *, width: float = 2.0, dashed: bool = False, opacity: float = 1.0
    ) -> None:
        """Draw a curve (n,) over rising `x` (n,), thinned so that its peaks stay; what is no number is left out."""
        known = np.isfinite(y)
        x, y = thinned(x[known], y[known], most=max(2, int(1.5 * (self.box[2] - self.box[0]))))
        if not len(x):
            return
        dash = (7.0 * self.scale, 5.0 * self.scale) if dashed else None
        thick = max(1.0, width * self.scale)
        self.canvas.lines([self.place(x, y)], thick, color, dash=dash, clip=self.box, opacity=opacity)

    def band(self, x: Array, low: Array, high: Array, color: str, opacity: float = 0.15) -> None:
        """Fill between two curves (n,) over rising `x` (n,)."""
        known = np.isfinite(low) & np.isfinite(high)
        if known.any():
            one, other = self.place(x[known], low[known]), self.place(x[known], high[known])
            self.canvas.band(one[:, 0], one[:, 1], other[:, 1], color, opacity, self.box)

    def bar(self, x: float, half: float, low: float, high: float, color: str, opacity: float) -> None:
        """Fill a bar from x - half to x + half, between two values."""
        (left, bottom), (right, top) = self.place(x - half, min(low, high)), self.place(x + half, max(low, high))
        self.canvas.rectangle((left, top, right, bottom), color, opacity)

    def dot(self, x: float, y: float, color: str, *, crossed: bool = False) -> None:
        """Draw a dot with a white rim, or a cross."""
        place, size = self.place(x, y), 5.0 * self.scale
        if crossed:
            arm = np.array([[-size, -size], [size, size]])
            self.canvas.lines([place + arm, place + arm * (1.0, -1.0)], 3.0 * self.scale, color)
            return
        self.canvas.lines([place[None]], 2.4 * size, "#FFFFFF")
        self.canvas.lines([place[None]], 2.0 * size, color)

    def legend(self, entries: list[Entry]) -> None:
        """Write the legend at the right end of the title's line."""
        size, line = _LABEL * self.scale, 22.0 * self.scale
        widths = [line + 7.0 * self.scale + width_of(entry.words, size) for entry in entries]
        apart = 20.0 * self.scale
        place = self.box[2] - sum(widths) - apart * (len(entries) - 1)
        for entry, width in zip(entries, widths, strict=True):
            row = self._title_line() - 0.5 * size
            sample = np.array([[place, row], [place + line, row]])
            dash = (0.26 * line, 0.2 * line) if entry.dashed else None
            self.canvas.lines([sample], 2.6 * self.scale, entry.color, dash=dash)
            self.canvas.text((place + line + 7.0 * self.scale, row + 0.5 * size), entry.words, size, INK)
            place += width + apart

    def _title_line(self) -> float:
        return self.box[1] - 25.0 * self.scale


def ticks(low: float, high: float, most: int) -> Array:
    """Return round values (k,) from `low` to `high`, evenly spaced, no more than `most` of them."""
    rough = (high - low) / max(most, 1)
    power = 10.0 ** np.floor(np.log10(rough))
    step = next(power * factor for factor in (1.0, 2.0, 5.0, 10.0) if power * factor >= rough * (1.0 - 1e-9))
    return step * np.arange(np.ceil(low / step - 1e-9), np.floor(high / step + 1e-9) + 1.0) + 0.0


def number(value: float) -> str:
    """Return a tick's value in as few digits as tell it from its neighbours."""
    return f"{value:.6g}"


def value_range(
    *curves: Array, margin: float = 0.08, least: float = 0.0, floor: float | None = None
) -> tuple[float, float]:
    """Return (low, high) that holds the finite values of all curves with some room.

    The range is at least `least` wide; `floor` is a value to start from.
    """
    values = np.concatenate([np.ravel(curve) for curve in curves])
    values = values[np.isfinite(values)]
    low, high = (float(values.min()), float(values.max())) if values.size else (0.0, 1.0)
    if floor is not None:
        low = floor
    room = max(0.0, 0.5 * (least - (high - low))) + margin * (high - low)
    return (low if floor is not None else low - room, high + room)


def _widened(low: float, high: float) -> tuple[float, float]:
    """Return a range that is not empty."""
    return (low, high) if high - low > 1e-9 * max(abs(low), abs(high), 1e-3) else (low - 0.5, high + 0.5)
