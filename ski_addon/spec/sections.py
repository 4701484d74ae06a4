"""The sections of a run document as frozen dataclasses; attribute names are the TOML keys."""

from __future__ import annotations

from typing import Literal

from .fields import choice, flag, number, text, whole
from .records import record

_TURNS, _GATES, _BUMPS = ("turns",), ("gates",), ("bumps",)
_RHYTHM, _FOLLOW = ("rhythm",), ("follow",)


@record(frozen=True)
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


@record(frozen=True)
class SlopeSpec:
    """The ground: a plane, bumps across the fall line, a field of moguls, or a grid of heights."""

    kind: str = choice(
        "plane", ("plane", "bumps", "moguls", "grid"), "Slope", "Shape of the ground; keys of other shapes do nothing"
    )
    angle_deg: float = number(
        10.0,
        0,
        45,
        "deg",
        "Slope angle",
        "Steepness of the slope, downhill along +x; of a plane under a grid",
        required=True,
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
    grid_file: str = text(
        "",
        1000,
        "Height grid",
        "File of heights (.npy, .npz, .csv, .txt, .asc, .png, .tif), beside the document or with its whole path; or a "
        "shipped ground, such as rolling_hill",
    )
    grid_spacing: float | Literal["auto"] = number(
        "auto", 0.01, 1000, "m", "Grid spacing", "Distance between samples; auto = as the file says", word="auto"
    )
    grid_height: float = number(10.0, 0.01, 10000, "m", "Grid height", "Height of white over black in an image")
    grid_downhill: str = choice(
        "bottom", ("bottom", "right", "top", "left"), "Grid downhill", "Side of the file or image that lies downhill"
    )
    grid_smoothing: float = number(
        0.0, 0, 100, "m", "Grid smoothing", "Width over which heights are blurred, against steps and noise"
    )
    grid_start_down: float | Literal["auto"] = number(
        "auto",
        0,
        100000,
        "m",
        "Start from the top",
        "Distance from the grid's uphill edge to the start of the run; auto = as the file says, or 5 m",
        word="auto",
        advanced=True,
    )
    grid_start_across: float | Literal["auto"] = number(
        "auto",
        0,
        100000,
        "m",
        "Start from the side",
        "Distance from the grid's right edge, seen downhill, to the start; auto = as the file says, or the middle",
        word="auto",
        advanced=True,
    )


@record(frozen=True)
class CourseSpec:
    """Where the skis go: linked turns, gates, a drawn path, lines over bumps and moguls, what a rhythm makes, or a path
    that is followed past obstacles.
    """

    kind: str = choice(
        "turns",
        ("turns", "gates", "path", "bumps", "rhythm", "follow"),
        "Course",
        "How the track is described: turns of one radius, gates to pass, a path of points, a line over bumps, a rhythm "
        "of leaning from side to side, or a path to follow past obstacles",
        required=True,
    )
    turn_count: int = whole(6, 1, 500, "turns", "Turns", "Number of turns", required=True, kinds=_TURNS)
    turn_duration: float = number(
        1.0, 0.1, 30, "s", "Turn duration", "Time spent at full curvature in each turn", required=True, kinds=_TURNS
    )
    transition_duration: float = number(
        1.5,
        0.2,
        30,
        "s",
        "Transition duration",
        "Time to change from one turn to the next",
        required=True,
        kinds=_TURNS,
    )
    turn_radius: float = number(15.0, 3, 200, "m", "Turn radius", "Radius of each turn", required=True, kinds=_TURNS)
    start_speed: float = number(5.0, 0, 40, "m/s", "Start speed", "Speed at the start of the track; 0 = from rest")
    target_speed: float | Literal["free"] = number(
        "free", 2, 40, "m/s", "Target speed", "Speed to hold by skidding; free = as slope and snow give it", word="free"
    )
    finish: str = choice(
        "glide",
        ("glide", "stop"),
        "Finish",
        "glide = the run ends moving; stop = it runs out down the fall line, the skis are thrown across and it stands",
    )
    first_turn: str = choice(
        "right", ("right", "left"), "First turn", "Side of the first turn", kinds=("turns", "gates", "bumps", "rhythm")
    )
    half_first_turn: bool = flag(
        False,
        "Half first turn",
        "Make the first turn half as long, so that the track runs straight down the slope",
        kinds=_TURNS,
    )
    entry: str = choice(
        "straight",
        ("straight", "turn"),
        "Entry",
        "straight = half a transition leads in and out, or a rhythm begins out of a straight run; turn = the run "
        "starts already in its first turn",
        kinds=("turns", "rhythm"),
    )
    rhythm_duration: float | Literal["auto"] = number(
        "auto",
        2,
        600,
        "s",
        "Rhythm duration",
        "How long the rhythm goes on; auto = a swing past the last [[rhythm]] row, at least four swings in all",
        word="auto",
        kinds=_RHYTHM,
    )
    pace: str = choice(
        "glide",
        ("glide", "held"),
        "Pace",
        "glide = as fast as slope, snow and target speed make it; held = at the start speed whatever they do, for "
        "instant motion of somebody who pedals or is pulled",
        kinds=_RHYTHM,
    )
    tightest_radius: float = number(
        3.5, 1, 100, "m", "Tightest radius", "No turn of a rhythm is tighter: skis and wheels cannot", kinds=_RHYTHM
    )
    steering_rate: float = number(
        1.0,
        0.05,
        10,
        "1/m/s",
        "Steering rate",
        "How fast the curvature of the track may change; skis are slow, a front wheel is quick",
        kinds=_RHYTHM,
        advanced=True,
    )
    gate_setting: str = choice(
        "slalom",
        ("slalom", "giant_slalom", "list"),
        "Gates",
        "slalom, giant_slalom = gates are set by the keys below; list = the document's [[gate]] rows",
        kinds=_GATES,
    )
    gate_count: int = whole(20, 1, 200, "gates", "Gate count", "Number of gates that are set", kinds=_GATES)
    gate_spacing: float | Literal["auto"] = number(
        "auto",
        3,
        60,
        "m",
        "Gate spacing",
        "Distance down the slope from gate to gate; auto = 10 m in slalom, 24 m in giant slalom",
        word="auto",
        kinds=_GATES,
    )
    gate_offset: float | Literal["auto"] = number(
        "auto",
        0,
        30,
        "m",
        "Gate offset",
        "Distance sideways from gate to gate; auto = 2 m in slalom, 4.5 m in giant slalom",
        word="auto",
        kinds=_GATES,
    )
    gate_radius: float | Literal["auto"] = number(
        "auto",
        3,
        200,
        "m",
        "Gate radius",
        "Tightest radius of the turn round each gate; auto = the smoothest line",
        word="auto",
        kinds=_GATES,
    )
    gate_distance: float | Literal["auto"] = number(
        "auto",
        0.2,
        5,
        "m",
        "Gate clearance",
        "Distance from each pole to the middle between the skis; auto = 0.5 m in slalom, 1 m in giant slalom",
        word="auto",
        kinds=_GATES,
    )
    gate_variation: float = number(
        0.0, 0, 1, "", "Gate variation", "How unevenly gates are set, by simulation.seed; 0 = evenly", kinds=_GATES
    )
    run_in: float | Literal["auto"] = number(
        "auto",
        3,
        200,
        "m",
        "Run-in",
        "Distance from the start to the first gate or turn; auto = a little more than from gate to gate",
        word="auto",
        kinds=("gates", "bumps"),
    )
    path_smoothing: float | Literal["auto"] = number(
        "auto",
        0.2,
        50,
        "m",
        "Path smoothing",
        "Bends of the drawn path shorter than this are smoothed away; auto = only where the path is too tight to ski",
        word="auto",
        kinds=("path",),
    )
    run_length: float | Literal["auto"] = number(
        "auto",
        5,
        2000,
        "m",
        "Run length",
        "Length of the run down the slope; auto = past the last bump",
        word="auto",
        kinds=_BUMPS,
    )
    turn_amplitude: float = number(
        0.0,
        0,
        10,
        "m",
        "Turn amplitude",
        "How far beside the bumps' crests the line turns round them; 0 = straight over",
        kinds=_BUMPS,
    )
    turn_spacing: float | Literal["auto"] = number(
        "auto",
        1,
        60,
        "m",
        "Turn spacing",
        "Distance down the slope from turn to turn; auto = from crest to crest",
        word="auto",
        kinds=_BUMPS,
    )
    path_shape: str = choice(
        "spline",
        ("spline", "lines"),
        "Path shape",
        "How the points make the path to follow: round, or straight from point to point",
        kinds=_FOLLOW,
    )
    plan_stages: int = whole(
        10, 2, 16, "stages", "Stages", "How many stages a plan looks ahead; the first is ridden", kinds=_FOLLOW
    )
    plan_stage_time: float = number(
        0.3, 0.1, 0.6, "s", "Stage time", "Duration of a stage, in which the curvature changes evenly", kinds=_FOLLOW
    )
    plan_lean_deg: float = number(
        30.0, 5, 60, "deg", "Planned lean", "Most lean of the body when a path is followed", kinds=_FOLLOW
    )
    plan_radius: float = number(
        4.0, 1, 200, "m", "Planned radius", "Tightest radius of the track when a path is followed", kinds=_FOLLOW
    )
    plan_steering: float = number(
        0.4,
        0.02,
        5,
        "1/m/s",
        "Planned steering",
        "How quickly the track's curvature may change when a path is followed",
        kinds=_FOLLOW,
    )


@record(frozen=True)
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
    speed_limit: float | Literal["unlimited"] = number(
        "unlimited",
        2,
        40,
        "m/s",
        "Speed limit",
        "Speed above which the skier brakes by skidding, whatever the course says",
        word="unlimited",
    )
    skid_max_deg: float = number(
        35.0, 0, 60, "deg", "Most skid", "Largest angle between skis and track when braking in turns", advanced=True
    )
    stop_deceleration: float = number(
        4.0, 1, 7, "m/s^2", "Stop deceleration", "How hard the skier brakes to a stop", advanced=True
    )
    knee_bend_deg: float = number(60.0, 30, 100, "deg", "Knee bend", "Knee bend of the middle stance")
    absorption: float = number(
        1.0, 0, 1, "", "Absorption", "How much of the bumps the legs take up, as far as they reach: 0 = none"
    )
    tuck: float = number(
        0.0,
        0,
        1,
        "",
        "Tuck",
        "How low the skier makes himself against the air: 1 = trunk down, hands ahead, half the drag area",
    )
    look_ahead: float = number(
        1.5, 0.3, 5, "s", "Look ahead", "The head turns to where the skis will be in this time", advanced=True
    )
    load_min: float = number(
        0.25,
        0,
        0.9,
        "body weights",
        "Least load",
        "Snow force kept at a transition; the legs bend to keep it",
        advanced=True,
    )
    balance: str = choice(
        "steering",
        ("steering", "tracking"),
        "Balance",
        "How a skier who is pushed off the plan stays up: steering = moves the skis under the body and comes back to "
        "the track; tracking = only pulls back to the plan",
    )
    pole: str = choice("trail", ("trail",), "Poles", "What the poles do: trail = hang back by their own weight")
    controller: str = choice(
        "whole_body",
        ("whole_body", "open_loop", "inclination_only"),
        "Controller",
        "whole_body = joints, lean and skis are controlled together; to compare: open_loop = joints repeat the plan by "
        "the clock and nothing balances or steers, as in early ski robots; inclination_only = a stiff body that leans",
        advanced=True,
    )
    equations: str = choice(
        "mended",
        ("mended", "paper", "printed_sign", "rigid_lean", "frictionless", "clock"),
        "Equations",
        "To compare with the 2019 paper as printed: paper = its rigid lean, its frictionless plan and its reference by "
        "the clock, which can be had one by one, too; printed_sign = turns bend away from the lean",
        advanced=True,
    )


@record(frozen=True)
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
