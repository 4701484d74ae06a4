"""The sections of a run document as frozen dataclasses; attribute names are the TOML keys."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from .fields import choice, flag, number, text, whole


@dataclass(frozen=True)
class SkierSpec:
    """Who skis, and on what."""

    mass: float = number(50.0, 30, 130, "kg", "Mass", "All the snow carries: body, clothes, boots, skis and poles")
    height: float = number(1.5, 1.2, 2.1, "m", "Height", "Body height without boots")
    sex: str = choice("male", ("male", "female"), "Body", "Table of segment masses and lengths (de Leva)")
    strength: float = number(1.0, 0.3, 3, "", "Strength", "Factor on all human joint torque limits", advanced=True)
    stance_width: float | Literal["auto"] = number(
        "auto",
        0.1,
        0.5,
        "m",
        "Stance width",
        "Distance between the skis; auto = a little over hip width",
        word="auto",
        advanced=True,
    )
    ski_length: float | Literal["auto"] = number(
        "auto", 0.8, 2.3, "m", "Ski length", "Length of each ski; auto = from body height", word="auto"
    )
    ski_width: float = number(0.07, 0.05, 0.14, "m", "Ski waist", "Width of each ski at its waist", advanced=True)
    ski_sidecut_radius: float = number(15.0, 5, 60, "m", "Sidecut radius", "Radius of the ski's side")
    ski_mass: float = number(1.5, 0.3, 5, "kg", "Ski mass", "Mass of each ski with its binding", advanced=True)
    boot_mass: float = number(1.5, 0.3, 4, "kg", "Boot mass", "Mass of each boot", advanced=True)
    pole_length: float | Literal["auto"] = number(
        "auto", 0.6, 1.6, "m", "Pole length", "Length of each pole; auto = from body height", word="auto", advanced=True
    )
    pole_mass: float = number(0.25, 0.05, 1, "kg", "Pole mass", "Mass of each pole", advanced=True)
    pole_stiffness: float = number(
        5.0, 0, 200, "N m/rad", "Pole stiffness", "Spring that holds each pole in the hand", advanced=True
    )
    pole_damping: float = number(
        0.2, 0, 5, "N m s/rad", "Pole damping", "Damper that calms each pole in the hand", advanced=True
    )
    drag_area: float = number(
        0.4, 0, 2, "m^2", "Drag area", "Drag coefficient times frontal area: 0.2 in a tuck, 0.7 upright"
    )


@dataclass(frozen=True)
class SlopeSpec:
    """The ground: a plane, bumps across the fall line, a field of moguls, or a grid of heights."""

    kind: str = choice(
        "plane", ("plane", "bumps", "moguls"), "Slope", "Shape of the ground; keys of other shapes do nothing"
    )
    angle_deg: float = number(
        10.0, 0, 45, "deg", "Slope angle", "Steepness of the slope, downhill along +x", required=True
    )
    bump_count: int = whole(10, 1, 500, "bumps", "Bumps", "Number of crests, with troughs between them")
    bump_height: float = number(
        0.3, 0.02, 3, "m", "Bump height", "Height of an arc over its chord; from trough to crest it is twice that"
    )
    bump_width: float = number(8.0, 1, 50, "m", "Bump width", "Chord of an arc; from crest to crest it is twice that")
    bump_start: float = number(
        10.0, 0, 1000, "m", "Bump start", "Distance down the slope to where bumps or moguls begin"
    )
    bump_fillet: float = number(
        0.25, 0.05, 1, "", "Bump fillet", "Share of the width over which a crest blends into a trough", advanced=True
    )
    mogul_count: int = whole(8, 1, 500, "moguls", "Moguls", "Number of moguls down a column")
    mogul_height: float = number(0.5, 0.02, 2, "m", "Mogul height", "Height from trough to crest")
    mogul_spacing: float = number(3.5, 1, 30, "m", "Mogul spacing", "Distance from crest to crest down a column")
    mogul_across: float | Literal["auto"] = number(
        "auto",
        1,
        30,
        "m",
        "Mogul columns",
        "Distance between neighbouring columns, which are offset by half a spacing; auto = the spacing",
        word="auto",
        advanced=True,
    )


@dataclass(frozen=True)
class CourseSpec:
    """Where the skis go: linked turns of constant radius joined by transitions."""

    kind: str = choice("turns", ("turns",), "Course", "How the track is described", required=True)
    turn_count: int = whole(6, 1, 500, "turns", "Turns", "Number of turns", required=True)
    turn_duration: float = number(
        1.0, 0.1, 30, "s", "Turn duration", "Time spent at full curvature in each turn", required=True
    )
    transition_duration: float = number(
        1.5, 0.2, 30, "s", "Transition duration", "Time to change from one turn to the next", required=True
    )
    turn_radius: float = number(15.0, 3, 200, "m", "Turn radius", "Radius of each turn", required=True)
    start_speed: float = number(5.0, 0.3, 40, "m/s", "Start speed", "Speed at the start of the track")
    first_turn: str = choice("right", ("right", "left"), "First turn", "Side of the first turn")
    half_first_turn: bool = flag(
        False, "Half first turn", "Make the first turn half as long, so that the track runs straight down the slope"
    )
    entry: str = choice(
        "straight",
        ("straight", "turn"),
        "Entry",
        "straight = half a transition leads in and out; turn = the run starts already in its first turn",
    )


@dataclass(frozen=True)
class TechniqueSpec:
    """How the skier skis it."""

    inclination: bool = flag(True, "Lean into turns", "Lean so that the skier is balanced in every turn")
    inclination_max_deg: float = number(
        45.0, 5, 60, "deg", "Most lean", "Plans that need more lean than this are refused"
    )
    angulation: float | Literal["auto"] = number(
        "auto",
        -1,
        0,
        "",
        "Angulation",
        "How far the upper body stays upright: 0 = leans with the legs, -1 = upright; auto = from speed and radius",
        word="auto",
    )
    knee_bend_deg: float = number(60.0, 30, 100, "deg", "Knee bend", "Knee bend of the middle stance")
    load_min: float = number(
        0.25,
        0,
        0.9,
        "body weights",
        "Least load",
        "Snow force kept at a transition; the legs bend to keep it",
        advanced=True,
    )
    pole: str = choice("trail", ("trail",), "Poles", "What the poles do: trail = hang back by their own weight")


@dataclass(frozen=True)
class SnowSpec:
    """What the skis run on."""

    friction: float = number(0.071, 0, 0.5, "", "Friction", "Friction of ski on snow at rest")
    friction_per_speed: float = number(
        0.004, 0, 0.05, "s/m", "Friction per speed", "Friction added for each m/s of speed"
    )
    hardness: float = number(
        1.2e8,
        4e7,
        9e10,
        "N/m^3",
        "Hardness",
        "Force per penetrated volume of snow: how deep edges cut; the motion does not depend on it",
        advanced=True,
    )
    shear_strength: float = number(
        5.7e4,
        1e3,
        1e6,
        "N/m^2",
        "Shear strength",
        "Side force per sheared area of snow; the motion does not depend on it, see shear_limit",
        advanced=True,
    )
    shear_limit: float | Literal["unlimited"] = number(
        "unlimited",
        50,
        20000,
        "N",
        "Grip limit",
        "Most side force of the snow on each ski; above it the ski skids",
        word="unlimited",
        advanced=True,
    )


@dataclass(frozen=True)
class SimulationSpec:
    """How the physics is stepped."""

    time_step: float = number(0.001, 0.0005, 0.005, "s", "Time step", "Length of a physics step", advanced=True)
    segments: int = whole(5, 2, 20, "per edge", "Edge segments", "Snow contact points on each ski edge", advanced=True)
    seed: int = whole(0, 0, 2**31 - 1, "", "Seed", "Seed of every random number", advanced=True)


@dataclass(frozen=True)
class BakeSpec:
    """How the motion becomes keyframes."""

    fps: float = number(24.0, 1, 240, "1/s", "Frame rate", "Frames per second of the animation")
    subframes: int = whole(1, 1, 8, "per frame", "Keys per frame", "Keyframes on each frame", advanced=True)
    frame_start: int = whole(1, -100000, 1000000, "", "First frame", "Frame at which the run starts")
    action: str = text("Ski run", 60, "Action", "Name of the new action in Blender")
