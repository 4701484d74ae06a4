"""Drawing the members of a crowd: each an ordinary run, from random numbers of its own.

Member k draws from `SeedSequence(seed, spawn_key=(k, t))` at its t-th try, so that it is the same whatever the count
and whoever was drawn before. Every number is drawn whether its spread is used or not: to change one spread changes
nothing else.
"""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ..spec import RunSpec, find_field
from .crowd_spec import CrowdSpec

if TYPE_CHECKING:
    from ..spec import CourseSpec, SkierSpec, TechniqueSpec

LARGEST = 2.0
"""Nobody differs by more than so many standard deviations."""
WAYS = 8
"""Lines beside each other that are tried for a member who may lie anywhere."""
START_STREAM = 0
"""The stream of a member's start; those of its tries follow it."""
OTHER = {"left": "right", "right": "left"}


@dataclass(frozen=True)
class Member:
    """One skier of a crowd: its `index` from 0, the `attempt` it was drawn at (from 1), and its run."""

    index: int
    attempt: int
    spec: RunSpec

    @property
    def number(self) -> int:
        """Its number in messages and files, from 1."""
        return self.index + 1


def draw_member(crowd: CrowdSpec, index: int, attempt: int = 1) -> Member:
    """Return the member `index` (from 0) as its `attempt`-th try draws it (from 1)."""
    rng = _stream(crowd, index, START_STREAM + attempt)
    base, spread = crowd.run_of(index).spec, crowd.spread
    draws = {
        name: _normal(rng) for name in ("height", "mass", "strength", "speed", "radius", "rhythm", "knee", "angulation")
    }
    woman, mirrored = rng.random(), rng.random()
    skier = _person(base.skier, spread, draws)
    if not isinstance(spread.women, str):
        skier = dataclasses.replace(skier, sex="female" if woman < spread.women else "male")
    course = _course(base.course, spread, draws)
    if course.kind == "turns" and mirrored < spread.mirrored:
        course = dataclasses.replace(course, first_turn=OTHER[course.first_turn])
    technique = _technique(base.technique, spread, draws)
    name = f"{base.name[:100]}, member {index + 1}"
    return Member(
        index, attempt, dataclasses.replace(base, name=name, skier=skier, course=course, technique=technique).validate()
    )


def wanted_start(crowd: CrowdSpec, index: int) -> float:
    """Return when the member `index` wants to start [s]."""
    start = crowd.crowd
    shift = start.start_variation * (2.0 * _stream(crowd, index, START_STREAM).random() - 1.0) if index else 0.0
    return max(start.start_interval * (index + 0.5 * shift), 0.0)


def wanted_offsets(crowd: CrowdSpec, index: int) -> np.ndarray:
    """Return the lines [m to the left] of the member `index`, the one it likes best first (1 or `WAYS`,)."""
    own, width = crowd.run_of(index).offset, crowd.spread.offset
    if not width:
        return np.array([own])
    rng = _stream(crowd, index, START_STREAM)
    rng.random()  # that of its start
    return np.round(own + rng.uniform(-width, width, WAYS), 2) + 0.0


def _stream(crowd: CrowdSpec, index: int, stream: int) -> np.random.Generator:
    return np.random.default_rng(np.random.SeedSequence(crowd.crowd.seed, spawn_key=(index, stream)))


def _normal(rng: np.random.Generator) -> float:
    """Return a normal deviate that is not larger than `LARGEST`."""
    while True:
        value = float(rng.standard_normal())
        if abs(value) <= LARGEST:
            return value


def _within(key: str, value: float, digits: int = 4) -> float:
    """Return a value rounded, and within the range of its key."""
    info = find_field(key)
    low = -np.inf if info.low is None else info.low
    high = np.inf if info.high is None else info.high
    return float(min(max(round(value, digits), low), high)) + 0.0


def _person(skier: SkierSpec, spread: Any, draws: dict[str, float]) -> SkierSpec:
    """Return another person: who is taller is heavier, as the square of the height."""
    height = _within("skier.height", skier.height + spread.height * draws["height"], 3)
    mass = skier.mass * (height / skier.height) ** 2 * (1.0 + spread.mass * draws["mass"])
    strength = skier.strength * (1.0 + spread.strength * draws["strength"])
    return dataclasses.replace(
        skier,
        height=height,
        mass=_within("skier.mass", mass, 1),
        strength=_within("skier.strength", strength, 3),
    )


def _course(course: CourseSpec, spread: Any, draws: dict[str, float]) -> CourseSpec:
    """Return another line at another speed; keys that do nothing for its kind stay."""
    speed, radius, rhythm = (1.0 + getattr(spread, name) * draws[name] for name in ("speed", "radius", "rhythm"))
    changes: dict[str, Any] = {"start_speed": course.start_speed * speed}
    if not isinstance(course.target_speed, str):
        changes["target_speed"] = course.target_speed * speed
    if course.kind == "turns":
        changes |= {
            "turn_radius": course.turn_radius * radius,
            "turn_duration": course.turn_duration * rhythm,
            "transition_duration": course.transition_duration * rhythm,
        }
    if course.kind == "gates":
        from ..spec.gate_defaults import gate_defaults

        usual = gate_defaults(course).distance if isinstance(course.gate_distance, str) else course.gate_distance
        changes["gate_distance"] = usual * radius
    rounded: dict[str, Any] = {key: _within(f"course.{key}", value) for key, value in changes.items()}
    return dataclasses.replace(course, **rounded)


def _technique(technique: TechniqueSpec, spread: Any, draws: dict[str, float]) -> TechniqueSpec:
    changes = {"knee_bend_deg": technique.knee_bend_deg + spread.knee_bend_deg * draws["knee"]}
    if not isinstance(technique.angulation, str):
        changes["angulation"] = technique.angulation + spread.angulation * draws["angulation"]
    if not isinstance(technique.speed_limit, str):
        changes["speed_limit"] = technique.speed_limit * (1.0 + spread.speed * draws["speed"])
    rounded: dict[str, Any] = {key: _within(f"technique.{key}", value) for key, value in changes.items()}
    return dataclasses.replace(technique, **rounded)
