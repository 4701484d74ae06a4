"""Plots of a run as one picture; matplotlib is imported when the first one is drawn (it is not in the extension)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..simulation import Recording


def save_report(recording: Recording, target: str | Path) -> None:
    """Draw the report of a recording into a picture file, written in one step.

    Raises `RecordingError` if the recording holds no steps, `OutputError` if the file cannot be written.
    """
    from .figure import draw_figure, save_figure

    save_figure(draw_figure(recording), Path(target))
