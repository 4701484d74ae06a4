"""Progress of long work: a bar with time left on a terminal, plain lines elsewhere."""

from __future__ import annotations

import time
from collections.abc import Callable
from types import TracebackType
from typing import TextIO

from .errors import one_line
from .spec.estimate import show_duration

OPENJD_SECONDS = 1.0
"""Wall time between two lines for Open Job Description [s]."""
BAR_WIDTH = 28
REDRAW_SECONDS = 0.1
PLAIN_PARTS = 10


class ProgressDisplay:
    """A progress callback `display(fraction, text)` that draws on a stream; use it as a context manager.

    On a terminal one line is redrawn, at most ten times a second, and removed at the end. Elsewhere a plain line is
    written for every tenth of the work. With `stream=None` nothing is shown. `clock` returns seconds.
    """

    def __init__(self, stream: TextIO | None, clock: Callable[[], float] = time.monotonic) -> None:
        self._stream = stream
        self._clock = clock
        self._terminal = stream is not None and stream.isatty()
        self._text = ""
        self._started = clock()
        self._drawn_at = float("-inf")
        self._parts_said = 0
        self._width = 0

    def __call__(self, fraction: float, text: str) -> bool:
        """Show that `fraction` (0..1) of the work named `text` is done; returns True (never cancels)."""
        fraction = min(max(fraction, 0.0), 1.0)
        if text.split(" ")[0] != self._text.split(" ")[0]:  # other work: what follows its first word may count along
            self._started, self._parts_said, self._drawn_at = self._clock(), 0, float("-inf")
        self._text = text
        if self._stream is None:
            return True
        if self._terminal:
            self._draw_bar(fraction)
        elif (part := int(fraction * PLAIN_PARTS + 1e-9)) > self._parts_said:
            self._parts_said = part
            self._write(f"{self._text}: {fraction:4.0%}{self._time_left(fraction)}\n")
        return True

    def __enter__(self) -> ProgressDisplay:
        """Start showing."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Remove the bar, so that the next line starts at the left."""
        if self._width:
            self._write("\r" + " " * self._width + "\r")
            self._width = 0

    def _draw_bar(self, fraction: float) -> None:
        now = self._clock()
        if now - self._drawn_at < REDRAW_SECONDS and fraction < 1.0:
            return
        self._drawn_at = now
        full = round(fraction * BAR_WIDTH)
        line = f"{self._text} [{'#' * full}{'.' * (BAR_WIDTH - full)}] {fraction:4.0%}{self._time_left(fraction)}"
        self._write("\r" + line.ljust(self._width))
        self._width = max(self._width, len(line))

    def _time_left(self, fraction: float) -> str:
        elapsed = self._clock() - self._started
        if not 0.01 < fraction < 1.0 or elapsed < 0.5:
            return ""
        return f", {show_duration(elapsed * (1.0 - fraction) / fraction)} left"

    def _write(self, text: str) -> None:
        if self._stream is not None:
            self._stream.write(text)
            self._stream.flush()


class OpenJobProgress:
    """A progress callback as `ProgressDisplay`, in the lines that Open Job Description reads from a task's output.

    `openjd_progress: 12.5` is in percent, `openjd_status: simulating ...` says at what; at most one of each a second.
    """

    def __init__(self, stream: TextIO, clock: Callable[[], float] = time.monotonic) -> None:
        """Write to `stream`; `clock` returns seconds."""
        self._stream, self._clock = stream, clock
        self._said_at = float("-inf")
        self._said = -1.0

    def __call__(self, fraction: float, text: str) -> bool:
        """Say that `fraction` (0..1) of the work named `text` is done; returns True (never cancels)."""
        percent = 100.0 * min(max(fraction, 0.0), 1.0)
        now = self._clock()
        if now - self._said_at >= OPENJD_SECONDS or (percent == 100.0 and self._said != 100.0):
            self._said_at, self._said = now, percent
            self._stream.write(f"openjd_status: {one_line(text)}\nopenjd_progress: {percent:.1f}\n")
            self._stream.flush()
        return True

    def __enter__(self) -> OpenJobProgress:
        """Start saying."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Say no more."""
