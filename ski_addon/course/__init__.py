"""Courses: what the animator asks for, turned into a track on the terrain."""

from __future__ import annotations

from ..spec import RunSpec
from ..terrain import Terrain
from .bump_line import build_bump_track
from .finish import with_run_out
from .follow import CourseRide, build_follow_track, check_clear, ride_course
from .gates import Gates, build_gate_track, course_gates
from .pace import speed_to_hold
from .path import build_path_track
from .rhythm import build_rhythm_track
from .track import LEFT, RIGHT, TRANSITION, Track
from .turns import build_turn_track

__all__ = [
    "LEFT",
    "RIGHT",
    "TRANSITION",
    "CourseRide",
    "Gates",
    "Track",
    "build_track",
    "course_gates",
    "ride_course",
    "speed_to_hold",
]

_BUILDERS = {
    "turns": build_turn_track,
    "gates": build_gate_track,
    "path": build_path_track,
    "bumps": build_bump_track,
    "rhythm": build_rhythm_track,
    "follow": build_follow_track,
}


def build_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return the track of `spec.course` on `terrain`.

    Raises `SpecError` or `PlanInfeasible` for a gate, point or turn that cannot be skied.
    """
    track = _BUILDERS[spec.course.kind](spec, terrain)
    if spec.course.finish == "stop":
        track = with_run_out(track, spec, terrain)
    if spec.course.kind == "follow":
        check_clear(track, spec, terrain)
    return track
