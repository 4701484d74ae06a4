"""Gates that were dragged off the snow: which ones, how far, said in words, and put back where they stand."""

from __future__ import annotations

from typing import Any

import bpy
import numpy as np

from ..frames import Array
from ..spec import RunSpec
from ..spec.records import record
from .course_objects import standing_gates
from .gate_placing import put_object
from .placing import moved, run_from_world, terrain_of

SLACK = 0.05
"""How far over or under the snow a gate's foot may be [m] before it is said."""


@record(frozen=True)
class OffSnow:
    """A gate that is not on the snow: its `number`, its pole's `place` (3,) [m, world], and its `height` over the snow
    [m], negative under it; NaN where there is no ground at all.
    """

    number: int
    place: Array
    height: float

    @property
    def words(self) -> str:
        """What is wrong with it, without its name."""
        if np.isnan(self.height):
            return "stands beside the slope"
        if self.height < 0.0:
            return f"is {-self.height:.2f} m under the snow"
        return f"hangs {self.height:.2f} m over the snow"


def gates_off_snow(settings: Any, spec: RunSpec) -> tuple[OffSnow, ...]:
    """Return the gates that stand in the scene for a skier but not on the snow of `spec`, in their order."""
    poles = standing_gates(settings, spec)
    if not poles:
        return ()
    world = np.array([pole.matrix_world.translation for pole in poles])
    terrain, place = terrain_of(spec.slope), moved(run_from_world(settings), world)
    x, y = place[:, 0], place[:, 1]
    known = np.broadcast_to(terrain.contains(x, y), len(poles))
    height = np.where(known, place[:, 2] - terrain.height(x, y), np.nan)
    off = np.flatnonzero(~(np.abs(height) <= SLACK))
    return tuple(OffSnow(int(index) + 1, world[index], float(height[index])) for index in off)


def off_snow_words(off: tuple[OffSnow, ...]) -> str:
    """Return one line on gates that are not on the snow and what to do, or nothing if all are."""
    if not off:
        return ""
    lost = [gate for gate in off if np.isnan(gate.height)]
    if lost:
        return f"gate {lost[0].number} {lost[0].words}: move it back"
    if len(off) == 1:
        return f"gate {off[0].number} {off[0].words}: put it on the snow"
    *first, last = [str(gate.number) for gate in off]
    furthest = max(off, key=lambda gate: abs(gate.height))
    which = f"gates {', '.join(first)} and {last} are" if len(off) < 9 else f"{len(off)} gates are"
    return f"{which} off the snow; gate {furthest.number} {furthest.words}: put them on the snow"


def put_on_snow(settings: Any, spec: RunSpec) -> int:
    """Put the gates that are off the snow straight down or up on it, and return how many.

    Number and colour stay. A gate beside the slope has no snow to be put on and stays where it is.
    """
    poles, off = standing_gates(settings, spec), gates_off_snow(settings, spec)
    there = [gate for gate in off if not np.isnan(gate.height)]
    for gate in there:
        put_object(poles[gate.number - 1], gate.place - np.array((0.0, 0.0, gate.height)))
    bpy.context.view_layer.update()
    return len(there)
