"""A canvas to plot on with nothing but numpy: smooth lines, filled shapes and letters in an array of colours.

Places are pixels from the upper left corner, x to the right and y down. Pixel (i, j) covers x from j to j + 1.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from ..frames import Array
from .lettering import CAPITAL, text_strokes, text_width

Box = tuple[float, float, float, float]
"""Left, top, right and bottom of a part of the canvas [pixels]."""

THIN, BOLD = 0.14, 0.2
"""Width of a letter's strokes over the height of its capitals."""
_PIECE = 4.0
"""Longest piece of a line that is drawn at a time [pixels]."""


class Canvas:
    """A picture in the making of `width` by `height` pixels, all in the colour `background` ("#RRGGBB")."""

    def __init__(self, width: int, height: int, background: str = "#FFFFFF") -> None:
        self.width, self.height = int(width), int(height)
        self._rgb = np.empty((self.height, self.width, 3), dtype=np.float32)
        self._rgb[:] = rgb(background)

    def pixels(self) -> Array:
        """Return the picture (height, width, 4) float32: sRGB and opacity from 0 to 1, top row first."""
        out = np.ones((self.height, self.width, 4), dtype=np.float32)
        out[..., :3] = np.clip(self._rgb, 0.0, 1.0)
        return out

    def rectangle(self, box: Box, color: str, opacity: float = 1.0) -> None:
        """Fill `box`; borders between pixels cover these by their share."""
        left, top, right, bottom = box
        x, y = _span(left, right, self.width), _span(top, bottom, self.height)
        self._blend(y, x, _covered(top, bottom, y)[:, None] * _covered(left, right, x) * opacity, color)

    def lines(
        self,
        lines: Iterable[Array],
        width: float,
        color: str,
        *,
        opacity: float = 1.0,
        dash: tuple[float, float] | None = None,
        clip: Box | None = None,
    ) -> None:
        """Draw polylines (n, 2) of round ends, `width` pixels wide. A single point is a dot.

        `dash` is the length drawn and the length left out; nothing is drawn outside `clip`. Where lines of one call
        cross, they are not darker.
        """
        pieces = [_pieces(np.asarray(line, dtype=float), dash) for line in lines]
        pieces = [piece for piece in pieces if len(piece)]
        if not pieces:
            return
        start, end = np.moveaxis(np.concatenate(pieces), 1, 0)
        reach = 0.5 * width + 1.0
        corner = np.floor(np.minimum(start, end) - reach).astype(int)
        size = int(np.ceil(np.abs(end - start).max() + 2.0 * reach)) + 1
        box = clip or (0.0, 0.0, float(self.width), float(self.height))
        x, y = _span(box[0], box[2], self.width), _span(box[1], box[3], self.height)
        inside = np.all((corner + size > (x.start, y.start)) & (corner < (x.stop, y.stop)), axis=1)
        if not inside.any():
            return
        start, end, corner = start[inside], end[inside], corner[inside]
        x = slice(max(x.start, corner[:, 0].min()), min(x.stop, corner[:, 0].max() + size))
        y = slice(max(y.start, corner[:, 1].min()), min(y.stop, corner[:, 1].max() + size))
        mask = _stamped(start, end, corner, size, width, (x, y))
        self._blend(y, x, mask * (opacity * min(width, 1.0)), color)

    def band(self, x: Array, low: Array, high: Array, color: str, opacity: float, clip: Box) -> None:
        """Fill between two curves over rising `x` (n,) [pixels], `low` and `high` (n,) in either order."""
        columns = _span(max(clip[0], float(x[0])), min(clip[2], float(x[-1])), self.width)
        rows = _span(clip[1], clip[3], self.height)
        middle = np.arange(columns.start, columns.stop) + 0.5
        one, other = np.interp(middle, x, low), np.interp(middle, x, high)
        row = np.arange(rows.start, rows.stop)[:, None]
        covered = np.minimum(row + 1.0, np.maximum(one, other)) - np.maximum(row, np.minimum(one, other))
        self._blend(rows, columns, np.clip(covered, 0.0, 1.0) * opacity, color)

    def text(
        self,
        place: tuple[float, float],
        words: str,
        size: float,
        color: str,
        *,
        bold: bool = False,
        align: str = "left",
    ) -> float:
        """Write `words` with capitals `size` pixels high, standing on `place`; returns where they end [pixels].

        `align` says which end of the words is at `place`: "left", "center" or "right".
        """
        unit = size / CAPITAL
        wide = unit * text_width(words)
        left = place[0] - {"left": 0.0, "center": 0.5, "right": 1.0}[align] * wide
        strokes = [(left, place[1]) + unit * stroke * (1.0, -1.0) for stroke in text_strokes(words)]
        self.lines(strokes, max((BOLD if bold else THIN) * size, 1.0), color)
        return left + wide

    def _blend(self, rows: slice, columns: slice, cover: Array, color: str) -> None:
        """Lay a colour over a part of the picture; `cover` is from 0 to 1."""
        part = self._rgb[rows, columns]
        part += cover[..., None].astype(np.float32) * (rgb(color) - part)


def rgb(color: str) -> Array:
    """Return the three parts (3,) of a colour "#RRGGBB", 0 to 1."""
    return np.array([int(color[i : i + 2], 16) / 255.0 for i in (1, 3, 5)], dtype=np.float32)


def width_of(words: str, size: float) -> float:
    """Return how wide `words` with capitals `size` pixels high are [pixels]."""
    return text_width(words) * size / CAPITAL


def _span(low: float, high: float, most: int) -> slice:
    """Return the pixels that an interval touches."""
    start = int(np.clip(np.floor(low), 0, most))
    return slice(start, max(start, int(np.clip(np.ceil(high), 0, most))))


def _covered(low: float, high: float, span: slice) -> Array:
    """Return how much of each of the pixels `span` in a row an interval covers (k,)."""
    pixel = np.arange(span.start, span.stop)
    return np.clip(np.minimum(pixel + 1.0, high) - np.maximum(pixel, low), 0.0, 1.0)


def _pieces(line: Array, dash: tuple[float, float] | None) -> Array:
    """Return a polyline (n, 2) cut into short pieces (m, 2, 2), without those that a dash leaves out."""
    if len(line) == 1:
        return np.stack((line, line), axis=1)
    step = line[1:] - line[:-1]
    length = np.hypot(step[:, 0], step[:, 1])
    if dash is None and length.max() <= _PIECE:
        return np.stack((line[:-1], line[1:]), axis=1)
    parts = np.maximum(np.ceil(length / (1.0 if dash else _PIECE)), 1).astype(int)
    which = np.repeat(np.arange(len(parts)), parts)
    share = (np.arange(len(which)) - np.repeat(np.cumsum(parts) - parts, parts)) / parts[which]
    start = line[which] + share[:, None] * step[which]
    pieces = np.stack((start, start + step[which] / parts[which, None]), axis=1)
    if dash is None:
        return pieces
    way = np.cumsum(length) - length
    return pieces[(way[which] + share * length[which]) % sum(dash) < dash[0]]


def _stamped(start: Array, end: Array, corner: Array, size: int, width: float, part: Sequence[slice]) -> Array:
    """Return how much the pixels of a part of the canvas are covered by pieces of lines, from 0 to 1.

    Every piece reaches over `size` by `size` pixels from its `corner` (m, 2); the most that any gives counts.
    """
    x, y = part
    wide, high = x.stop - x.start, y.stop - y.start
    offset = np.arange(size)
    column, row = corner[:, 0, None] + offset, corner[:, 1, None] + offset  # (m, size)
    from_x = (column + 0.5 - start[:, 0, None])[:, None, :]
    from_y = (row + 0.5 - start[:, 1, None])[:, :, None]
    way = end - start
    along_x, along_y = way[:, 0, None, None], way[:, 1, None, None]
    share = (from_x * along_x + from_y * along_y) / np.maximum(along_x**2 + along_y**2, 1e-12)
    share = np.clip(share, 0.0, 1.0)
    distance = np.hypot(from_x - share * along_x, from_y - share * along_y)
    cover = np.clip(0.5 * max(width, 1.0) + 0.5 - distance, 0.0, 1.0)
    right = (column >= x.start) & (column < x.stop)
    below = (row >= y.start) & (row < y.stop)
    cover *= right[:, None, :] & below[:, :, None]
    index = np.clip(row - y.start, 0, high - 1)[:, :, None] * wide + np.clip(column - x.start, 0, wide - 1)[:, None, :]
    mask = np.zeros(high * wide)
    drawn = cover > 0.0
    np.maximum.at(mask, index[drawn], cover[drawn])
    return mask.reshape(high, wide)
