"""The rows of a run document as frozen dataclasses: `[[rhythm]]`, `[[gate]]` and so on, each any number of times."""

from __future__ import annotations

from typing import Literal

from .fields import choice, number, places, text
from .records import record

BODIES = (
    *("pelvis", "abdomen", "chest", "head"),
    *(f"{part}.{side}" for side in "LR" for part in ("upper_arm", "forearm", "hand")),
    *(f"{part}.{side}" for side in "LR" for part in ("thigh", "shank", "foot", "ski")),
)
"""Bodies of the skier that can be pushed: all but the poles."""
DIRECTIONS = ("left", "right", "forward", "back", "up", "down")
"""Directions of a push in the frame of the track: tangent, left within the surface, surface normal."""


@record(frozen=True)
class RhythmSpec:
    """What a rhythm is like at one time; between rows it changes evenly. Write `[[rhythm]]` above each."""

    time: float = number(0.0, 0, 3600, "s", "Time", "Time from the start of the run", required=True)
    period: float | Literal["auto"] = number(
        "auto",
        0.6,
        30,
        "s",
        "Swing",
        "How long a swing lasts: a turn to the left and one to the right; auto = as the rows around it have it",
        word="auto",
    )
    sharpness_deg: float | Literal["auto"] = number(
        "auto",
        0.5,
        60,
        "deg",
        "Sharpness",
        "How far the body leans into each turn; auto = as the rows around it have it",
        word="auto",
    )
    heading_deg: float | Literal["auto"] = number(
        "auto",
        -80,
        80,
        "deg",
        "Heading",
        "Where the turns lead, from the fall line, to the left positive; auto = as the rows around it have it",
        word="auto",
    )


@record(frozen=True)
class GateSpec:
    """A gate the skier passes, measured from the start of the track; write `[[gate]]` above each."""

    x: float = number(
        0.0, -50, 5000, "m", "Down", "Distance down the slope's surface along the fall line", required=True
    )
    y: float = number(0.0, -1000, 1000, "m", "Left", "Distance to the left across the slope", required=True)
    side: str = choice(
        "auto",
        ("left", "right", "auto"),
        "Turn",
        "Direction of the turn around the gate's pole: a left gate is passed turning left, its pole stands to the left "
        "of the skis; auto = alternating from course.first_turn",
    )
    radius: float | Literal["auto"] = number(
        "auto", 3, 200, "m", "Radius", "Radius of the turn around the pole; auto = chosen by the planner", word="auto"
    )
    distance: float | Literal["auto"] = number(
        "auto",
        0.2,
        5,
        "m",
        "Clearance",
        "Distance from the pole to the middle between the skis at the turn's apex; auto = chosen by the planner",
        word="auto",
    )


@record(frozen=True)
class PointSpec:
    """A corner of a drawn path, measured from the start of the track; write `[[point]]` above each."""

    x: float = number(
        0.0, -50, 5000, "m", "Down", "Distance down the slope's surface along the fall line", required=True
    )
    y: float = number(0.0, -1000, 1000, "m", "Left", "Distance to the left across the slope", required=True)


@record(frozen=True)
class ObstacleSpec:
    """Something that a course of kind follow goes round, measured from the start; write `[[obstacle]]` above each."""

    kind: str = choice(
        "disc",
        ("disc", "line", "polygon"),
        "Shape",
        "disc = a round thing such as a tree; line = a fence through its points; polygon = all within its corners",
        required=True,
    )
    points: tuple[tuple[float, float], ...] = places(
        200,
        -1000,
        5000,
        "m",
        "Places",
        "Pairs of metres down the slope and to the left: the middle of a disc, the corners of a line or polygon",
        required=True,
    )
    radius: float = number(0.3, 0.02, 50, "m", "Radius", "Radius of a disc")
    tolerance: float = number(
        0.5, 0, 10, "m", "Tolerance", "How far the middle between the skis, the board or the wheels stays away from it"
    )
    name: str = text("", 40, "Name", "What messages call it")


@record(frozen=True)
class PushSpec:
    """A constant force on one body for a while, unknown to the skier; write `[[push]]` above each."""

    body: str = choice("abdomen", BODIES, "Body", "Body whose centre of mass is pushed", required=True)
    direction: str = choice(
        "left", DIRECTIONS, "Direction", "Where to, in the track's frame when the push starts", required=True
    )
    force: float = number(100.0, 0, 2000, "N", "Force", "Size of the force", required=True)
    start: float = number(1.0, 0, 3600, "s", "Start", "Time from the start of the run", required=True)
    duration: float = number(0.5, 0.01, 10, "s", "Duration", "How long the force acts")
