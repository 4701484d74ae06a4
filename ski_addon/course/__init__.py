"""Courses: what the animator asks for, turned into a track on the terrain."""

from __future__ import annotations

from ..spec import RunSpec
from ..terrain import Terrain
from .bump_line import build_bump_track
from .gates import Gates, build_gate_track, course_gates
from .path import build_path_track
from .track import LEFT, RIGHT, TRANSITION, Track
from .turns import build_turn_track

__all__ = ["LEFT", "RIGHT", "TRANSITION", "Gates", "Track", "build_track", "course_gates"]

_BUILDERS = {
    "turns": build_turn_track,
    "gates": build_gate_track,
    "path": build_path_track,
    "bumps": build_bump_track,
}


def build_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return the track of `spec.course` on `terrain`.

    Raises `SpecError` or `PlanInfeasible` for a gate, point or turn that cannot be skied.
    """
    return _BUILDERS[spec.course.kind](spec, terrain)
