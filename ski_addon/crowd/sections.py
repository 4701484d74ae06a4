"""The sections and rows of a crowd document as frozen dataclasses; attribute names are the TOML keys."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from ..spec.fields import number, text, whole

MOST_MEMBERS = 999
"""Most skiers of one crowd."""


@dataclass(frozen=True)
class StartSpec:
    """How many ski, when they start and how far they stay from each other."""

    count: int = whole(12, 1, MOST_MEMBERS, "skiers", "Skiers", "How many ski")
    seed: int = whole(0, 0, 2**31 - 1, "", "Seed", "Seed of everything in which the skiers differ")
    start_interval: float = number(
        3.0, 0, 600, "s", "Start interval", "Time from one start to the next; 0 = all want to start at once"
    )
    start_variation: float = number(
        0.3, 0, 1, "", "Start variation", "How unevenly they start, as a share of the interval"
    )
    apart: float = number(
        2.5, 0, 50, "m", "Keep apart", "Least distance between any two at any time; who would come nearer starts later"
    )
    delay_max: float = number(
        60.0,
        0,
        3600,
        "s",
        "Longest delay",
        "How much later than wanted one may start; who would wait longer stays out",
    )
    linger: float = number(
        2.0, 0, 600, "s", "Linger", "How long those who have finished stay where they are before they are gone"
    )
    tries: int = whole(5, 1, 50, "tries", "Tries", "How often a skier who cannot ski the course is drawn anew")


@dataclass(frozen=True)
class SpreadSpec:
    """How much the skiers differ: standard deviations about their run's values, none beyond twice as much."""

    height: float = number(0.06, 0, 0.3, "m", "Height", "Body height")
    mass: float = number(0.08, 0, 0.5, "", "Mass", "Mass, as a share, beyond what follows from the height")
    strength: float = number(0.05, 0, 0.5, "", "Strength", "Strength, as a share")
    women: float | Literal["keep"] = number(
        "keep", 0, 1, "", "Women", "Share of skiers who are women; keep = as the run has it", word="keep"
    )
    speed: float = number(0.06, 0, 0.5, "", "Speed", "Start, target and limit speeds, as a share")
    radius: float = number(
        0.06,
        0,
        0.5,
        "",
        "Radius",
        "Radius of linked turns, or clearance from gates, as a share: the line",
    )
    rhythm: float = number(0.06, 0, 0.5, "", "Rhythm", "Duration of linked turns and transitions, as a share")
    knee_bend_deg: float = number(4.0, 0, 20, "deg", "Knee bend", "Knee bend of the middle stance: the style")
    angulation: float = number(
        0.0, 0, 0.5, "", "Angulation", "How far the upper body stays upright, where the run gives a number"
    )
    mirrored: float = number(
        0.5, 0, 1, "", "Other side", "Share of skiers whose first of linked turns goes to the other side"
    )
    offset: float = number(
        0.0, 0, 200, "m", "Beside", "Lines lie anywhere up to so far to the left and right of the run's"
    )


@dataclass(frozen=True)
class MemberRunSpec:
    """A run that members ski; write `[[run]]` above each. They take turns: rows are gone through again and again."""

    spec: str = text("", 1000, "Run", "Document beside the crowd's (.toml), or a preset in presets/runs", required=True)
    skier: str = text("", 1000, "Skier", "Part to lay over it: a file, or a preset in presets/skiers")
    style: str = text("", 1000, "Style", "Part to lay over it: a file, or a preset in presets/styles")
    repeat: int = whole(1, 1, MOST_MEMBERS, "skiers", "Repeat", "How many ski it before the next row's turn")
    offset: float = number(0.0, -500, 500, "m", "Beside", "How far to the left of the world's origin it starts")
