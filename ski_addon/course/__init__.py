"""Courses: what the animator asks for, turned into a track on the terrain."""

from __future__ import annotations

from ..spec import RunSpec
from ..terrain import Terrain
from .finish import with_run_out
from .pace import speed_to_hold
from .track import LEFT, RIGHT, TRANSITION, Track
from .turns import build_turn_track

__all__ = ["LEFT", "RIGHT", "TRANSITION", "Track", "build_track", "speed_to_hold"]


def build_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return the track of `spec.course` on `terrain`; raises `PlanInfeasible` where it cannot be skied."""
    track = build_turn_track(spec, terrain)
    return with_run_out(track, spec, terrain) if spec.course.finish == "stop" else track
