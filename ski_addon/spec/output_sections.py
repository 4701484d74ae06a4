"""The sections of a run document about computing and baking; attribute names are the TOML keys."""

from __future__ import annotations

from .fields import choice, number, text, whole
from .records import record


@record(frozen=True)
class SimulationSpec:
    """How the physics is stepped."""

    time_step: float = number(0.001, 0.0005, 0.005, "s", "Time step", "Length of a physics step", advanced=True)
    segments: int = whole(5, 2, 20, "per edge", "Edge segments", "Snow contact points on each ski edge", advanced=True)
    seed: int = whole(0, 0, 2**31 - 1, "", "Seed", "Seed of every random number", advanced=True)
    solver: str = choice(
        "small",
        ("small", "osqp"),
        "Solver",
        "How each step's program is solved: small = exactly by a small system, OSQP only where a muscle or hinge is at "
        "its limit; osqp = always by OSQP, slower, to compare with",
        advanced=True,
    )


@record(frozen=True)
class BakeSpec:
    """How the motion becomes keyframes."""

    fps: float = number(24.0, 1, 240, "1/s", "Frame rate", "Frames per second of the animation")
    subframes: int = whole(1, 1, 8, "per frame", "Keys per frame", "Keyframes on each frame", advanced=True)
    frame_start: int = whole(1, -100000, 1000000, "", "First frame", "Frame at which the run starts")
    action: str = text("Ski run", 60, "Action", "Name of the new action in Blender")
