"""Answers of the stages in the sidebar: what was said, whether it is of earlier settings, and progress."""

from __future__ import annotations

import textwrap
from typing import Any

from .jobs import RUNNING

STALE = "From before the last change:"


def columns_of(context: Any) -> int:
    """Return about how many characters fit into a line of the sidebar."""
    scale = context.preferences.system.ui_scale or 1.0  # 0 without a window
    return max(20, int((context.region.width - 50 * scale) / (6.6 * scale)))


def draw_words(layout: Any, words: str, columns: int, icon: str = "NONE", *, alert: bool = False) -> None:
    """Draw `words` as a box of wrapped lines, the first one with an `icon`."""
    box = layout.box().column(align=True)
    box.alert = alert
    for index, line in enumerate(textwrap.wrap(words, columns - 3)):
        if index:
            box.label(text=line, icon="BLANK1")
        else:
            box.label(text=line, icon=icon)


def draw_progress(layout: Any, columns: int) -> None:
    """Draw how far the simulation is."""
    layout.progress(factor=RUNNING.fraction, text=f"{RUNNING.fraction:.0%}")
    box = layout.box().column(align=True)
    for line in textwrap.wrap(RUNNING.text, columns):
        box.label(text=line)
    box.label(text="Esc: stop and keep what is done")


def draw_result(layout: Any, settings: Any, stage: str, run_hash: str, columns: int) -> None:
    """Draw what a stage said, greyed if it belongs to other settings than those of `run_hash`."""
    text = getattr(settings, f"{stage}_text")
    if not text:
        return
    failed = getattr(settings, f"{stage}_failed")
    box = layout.box().column(align=True)
    if getattr(settings, f"{stage}_hash") != run_hash:
        box.label(text=STALE, icon="TIME")
        box = box.column(align=True)
        box.active = False
    first = True
    for line in text.split("\n"):
        for part in textwrap.wrap(line, columns if not first else columns - 3):
            if first:
                box.label(text=part, icon="ERROR" if failed else "CHECKMARK")
            else:
                box.label(text=part)
            first = False
