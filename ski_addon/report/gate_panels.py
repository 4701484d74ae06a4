"""The gates of a course in the report: poles beside the track, and how near the skis came to each."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .style import INK, LEFT, QUIET, RIGHT, finish

if TYPE_CHECKING:
    from ..simulation import GatePassing

MISSED = "#C1121F"
WIDEST = 5
"""Largest factor by which the plan view of a gate course is drawn wider than it is."""
_SHAPE = 0.15
_MOST_NUMBERS = 40


def widening(track_position: np.ndarray) -> int:
    """Return how many times wider than it is a track (n, 3) [m] is drawn: poles stand half a metre beside it."""
    length, width = np.ptp(track_position[:, 0]), np.ptp(track_position[:, 1])
    return int(np.clip(_SHAPE * length / max(width, 1.0), 1, WIDEST))


def draw_poles(axes: Any, passing: GatePassing) -> None:
    """Draw the poles from above, coloured by the side they are passed on and numbered; crosses were missed."""
    for k, (pole, side) in enumerate(zip(passing.gates.position, passing.gates.side, strict=True)):
        passed = passing.passed[k]
        style: dict[str, Any] = {"marker": "o", "markersize": 4.5} if passed else {"marker": "X", "markersize": 8}
        color = _colour(side) if passed else MISSED
        axes.plot(*pole[:2], linestyle="", color=color, markeredgecolor="white", markeredgewidth=0.5, zorder=4, **style)
        if k % _every(len(passing.gates)) and passed:
            continue
        place = {"xytext": (0, 6 * side), "textcoords": "offset points", "va": "bottom" if side > 0 else "top"}
        axes.annotate(str(k + 1), pole[:2], ha="center", fontsize=7.5, color=color, **place)


def draw_gates(axes: Any, passing: GatePassing) -> None:
    """Draw for each gate how far the pole was from the middle between the skis, what was asked, and what was free."""
    numbers = np.arange(1, len(passing.gates) + 1)
    colors = [_colour(side) for side in passing.gates.side]
    passed = passing.passed
    free = np.where(passed, passing.clearance, 0.0)
    axes.bar(numbers, free, width=0.5, color=colors, alpha=0.3, linewidth=0)
    axes.hlines(passing.gates.distance, numbers - 0.35, numbers + 0.35, color=INK, linewidth=1.1, label="asked")
    for side, color, words in ((1, LEFT, "left"), (-1, RIGHT, "right")):
        some = passed & (passing.gates.side == side)
        label = f"to the middle between the skis, turning {words} (bar: to the nearer ski)"
        axes.plot(
            numbers[some], passing.distance[some], "o", color=color, markersize=5, label=label if any(some) else None
        )
    if not passed.all():
        axes.plot(
            numbers[~passed], 0.0 * numbers[~passed], "X", color=MISSED, markersize=8, clip_on=False, label="missed"
        )
    axes.set_ylim(0, 1.2 * axes.get_ylim()[1])  # the panel is low: more room for the legend
    finish(axes, "", "m", columns=4)
    axes.set_title(f"Gates: {passed.sum()} of {len(passed)} passed, distance of the pole", pad=6)
    axes.set_xlim(0.4, len(numbers) + 0.6)
    axes.set_xticks(numbers[:: _every(len(numbers))])
    axes.tick_params(axis="x", length=0)
    axes.axhline(0, color=QUIET, linewidth=0.8)


def _every(count: int) -> int:
    """Return which share of so many gates can be numbered without crowding."""
    return -(-count // _MOST_NUMBERS)


def _colour(side: int) -> str:
    return LEFT if side > 0 else RIGHT
