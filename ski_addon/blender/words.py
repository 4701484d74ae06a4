"""What the sidebar says about a plan, a simulation and a bake, in a few short lines."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..gravity import STANDARD_GRAVITY
from ..spec.estimate import show_duration

if TYPE_CHECKING:
    from ..planning import MotionPlan
    from ..simulation.recording import Recording
    from .bake import BakeResult


def plan_lines(plan: MotionPlan) -> list[str]:
    """Return what a plan looks like."""
    lean, edge = (float(np.degrees(np.abs(values).max())) for values in (plan.inclination, plan.edge_angle))
    return [
        f"Can be skied: {plan.length:.0f} m in {plan.duration:.1f} s",
        f"Speed {plan.speed.min():.1f} to {plan.speed.max():.1f} m/s",
        f"Leans up to {lean:.0f}\N{DEGREE SIGN}, edges up to {edge:.0f}\N{DEGREE SIGN}",
        f"Load {plan.load.min():.2f} to {plan.load.max():.2f} body weights",
    ]


def recording_lines(recording: Recording) -> list[str]:
    """Return how a simulation went: how it ended, then speed, lean and force."""
    if not len(recording.time):
        return [ending(recording)]
    weight = float(recording.header["mass"]) * STANDARD_GRAVITY
    force = float(np.linalg.norm(recording.snow_force.sum(axis=1), axis=1).max()) / weight
    lean = float(np.degrees(np.abs(recording.inclination).max()))
    return [
        ending(recording),
        f"Speed {recording.speed.min():.1f} to {recording.speed.max():.1f} m/s",
        f"Leans up to {lean:.0f}\N{DEGREE SIGN}",
        f"Snow force up to {force:.2f} body weights",
    ]


def ending(recording: Recording) -> str:
    """Return how a run ended, in one sentence: where, when and why if it was not at the end of the track."""
    header = recording.header
    if header["status"] == "finished":
        return f"Skied to the end in {show_duration(recording.duration)}"
    if header["status"] == "cancelled":
        return f"Stopped after {show_duration(recording.duration)} of skiing"
    detail: dict[str, Any] = header.get("status_detail") or {}
    verb = "Fell" if header["status"] == "fell" else "Diverged"
    when, where = float(detail.get("time", 0.0)), float(detail.get("where", 0.0))
    return f"{verb} at {when:.1f} s, {where:.0f} m: {detail.get('what', '')}; {detail.get('why', '')}"


def bake_lines(result: BakeResult) -> list[str]:
    """Return what a bake made."""
    lines = [f"Baked frames {result.frame_first:g} to {result.frame_last:g}", f"on {result.armature.name}"]
    return [*lines, f"Note: {result.note}"] if result.note else lines
