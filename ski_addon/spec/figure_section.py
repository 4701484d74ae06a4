"""The section of a run document about the figure: who turns, on what, and in which style; for the instant preview."""

from __future__ import annotations

from typing import Literal

from .fields import choice, flag, number
from .records import record

KINDS = ("alpine", "snowboard", "telemark", "bicycle")
_SKIS, _POLES, _LEGS = ("alpine", "telemark"), ("alpine", "telemark"), ("alpine", "snowboard", "telemark")
_BOARD, _TELEMARK, _BICYCLE = ("snowboard",), ("telemark",), ("bicycle",)


@record(frozen=True)
class FigureSpec:
    """Who turns, and in which style; the preview shows every kind, the whole physics is for alpine skiers."""

    kind: str = choice("alpine", KINDS, "Figure", "Who turns: skier, snowboarder, telemark skier or cyclist")
    leg_stiffness: float = number(
        4.0,
        1.5,
        100,
        "1/m",
        "Leg stiffness",
        "Force, in body weights, that shortens the legs by a metre; smaller = more up-and-down motion",
        kinds=_LEGS,
    )
    knee_bend_deg: float | Literal["auto"] = number(
        "auto",
        20,
        90,
        "deg",
        "Knee bend",
        "Knee bend under one body weight; auto = usual for the figure",
        word="auto",
        kinds=_LEGS,
    )
    waist_bend: float | Literal["auto"] = number(
        "auto",
        0,
        1.2,
        "",
        "Waist bend",
        "How far the waist bends for each degree that the knees bend; auto = usual for the figure",
        word="auto",
        kinds=_LEGS,
    )
    tilt: float = number(
        1.0,
        0,
        2,
        "",
        "Ski tilt",
        "Tilt of skis or board for their curvature: 1 = on the whole the lean of the body",
        kinds=_LEGS,
    )
    outside_tilt: float = number(
        0.1,
        0,
        0.5,
        "",
        "Outside ski",
        "Share by which the outside ski tilts more, and the inside one less",
        kinds=_SKIS,
    )
    twist: float | Literal["auto"] = number(
        "auto",
        -2,
        2,
        "",
        "Twist",
        "Twist of the upper body in units of the tilt, with the curvature: positive = into the turn, negative = out of "
        "it; auto = usual for the figure",
        word="auto",
    )
    arms_lead: float = number(
        0.12, 0, 0.5, "s", "Arms' lead", "How far the arms are ahead of the upper body's twist", kinds=_BOARD
    )
    pole_plant: str = choice(
        "teaching",
        ("teaching", "paper", "phase", "none"),
        "Pole plant",
        "When a pole is planted: teaching = 30 degrees before the body is upright, paper = 30 degrees after it, phase "
        "= at pole_phase_deg, none = poles are only carried",
        kinds=_POLES,
    )
    pole_phase_deg: float = number(
        -30.0,
        -80,
        80,
        "deg",
        "Plant phase",
        "Phase of the turn at which the left pole is planted, the right one half a cycle later, if pole_plant = phase",
        kinds=_POLES,
        advanced=True,
    )
    stance: str = choice(
        "regular", ("regular", "goofy"), "Stance", "Foot in front: regular = left, goofy = right", kinds=_BOARD
    )
    board_length: float | Literal["auto"] = number(
        "auto", 0.8, 2, "m", "Board length", "Length of the board; auto = from body height", word="auto", kinds=_BOARD
    )
    foot_distance: float | Literal["auto"] = number(
        "auto",
        0.3,
        0.8,
        "m",
        "Foot distance",
        "Distance of the bindings; auto = from height",
        word="auto",
        kinds=_BOARD,
    )
    front_foot_deg: float = number(
        15.0, -30, 60, "deg", "Front foot", "Turn of the front foot towards the nose", kinds=_BOARD, advanced=True
    )
    rear_foot_deg: float = number(
        -9.0, -30, 60, "deg", "Rear foot", "Turn of the rear foot towards the nose", kinds=_BOARD, advanced=True
    )
    split: float | Literal["auto"] = number(
        "auto",
        0,
        1.2,
        "m",
        "Split",
        "Distance between the feet, fore and aft, in a turn; auto = from body height",
        word="auto",
        kinds=_TELEMARK,
    )
    heel_lift_deg: float = number(
        40.0, 0, 60, "deg", "Heel lift", "How far the rear foot's heel lifts in a turn", kinds=_TELEMARK
    )
    development: float = number(
        5.5, 1.5, 12, "m", "Development", "Way of the bicycle for one turn of the cranks", kinds=_BICYCLE
    )
    coasting: bool = flag(
        True, "Coast", "Hold the inside pedal up in sharp turns, and pedal in between", kinds=_BICYCLE
    )
