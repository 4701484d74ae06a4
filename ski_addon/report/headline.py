"""What stands over a report: the run's name and how it ended, who skied what."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..spec import RunSpec
from ..spec.rhythm_defaults import rhythm_duration

if TYPE_CHECKING:
    from ..simulation import Recording


def headline(recording: Recording) -> tuple[str, str]:
    """Return the name of a recorded run, with its end if that came too soon, and a line of facts about it."""
    spec = RunSpec.from_text(recording.header["spec"], "the run document in the recording")
    status = recording.header["status"]
    ended = "" if status == "finished" else f" ({status} at {float(recording.time[-1]):.2f} s)"
    facts = (
        f"{spec.skier.mass:g} kg, {spec.skier.height:g} m on {spec.slope.angle_deg:g} degrees: {_course_words(spec)}"
    ) + _comparison_words(spec)
    return " ".join(spec.name.split()) + ended, facts


def _comparison_words(spec: RunSpec) -> str:
    """Return what is run to compare with, or nothing for a skier who uses all he can."""
    technique = spec.technique
    chosen = (technique.controller, "whole_body"), (technique.equations, "mended")
    return "".join(f", {word.replace('_', ' ')}" for word, usual in chosen if word != usual)


def _course_words(spec: RunSpec) -> str:
    """Return what the course is, in a few words."""
    course = spec.course
    if course.kind == "gates":
        setting = {"list": "gates", "slalom": "slalom gates", "giant_slalom": "giant slalom gates"}[course.gate_setting]
        return f"{len(spec.gate) if course.gate_setting == 'list' else course.gate_count} {setting}"
    if course.kind == "path":
        return f"a drawn path of {len(spec.point)} points"
    if course.kind == "follow":
        return f"a path of {len(spec.point)} points past {len(spec.obstacle)} obstacles"
    if course.kind == "rhythm":
        return f"a rhythm of {len(spec.rhythm)} rows, {rhythm_duration(course, spec.rhythm):g} s"
    if course.kind == "bumps":
        way = f"turning {course.turn_amplitude:g} m beside the crests" if course.turn_amplitude else "straight"
        return f"over {spec.slope.kind}, {way}"
    return (
        f"{course.turn_count} turns of {course.turn_radius:g} m, {course.turn_duration:g} s each, "
        f"{course.transition_duration:g} s between them"
    )
