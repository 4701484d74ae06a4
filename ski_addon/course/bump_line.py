"""A line over bumps and moguls: straight down the fall line, or turning round one crest after the other."""

from __future__ import annotations

import numpy as np

from ..errors import SpecError
from ..spec import RunSpec
from ..spec.bump_defaults import PAST_LAST, PLAIN_SPACING, bump_crests
from ..spec.gate_defaults import MARGIN
from ..terrain import Terrain
from .fair_line import STEEPEST, FairLine, Poles, fair_line, turning_curvature
from .gate_settings import alternate, run_in_of
from .labels import label_turns
from .surface import track_on_surface
from .track import Track

SPACING = 0.05
"""Distance between neighbouring places of the plan-view line [m]."""
LEAST_BEND = 0.01
"""Slighter bends [1/m] are no turns."""
RADIUS_MIN = 1.5
"""Turns round moguls are tighter than those round gates, but not tighter than this [m]."""


def build_bump_track(spec: RunSpec, terrain: Terrain) -> Track:
    """Return a track straight down, or one that turns round the crests `course.turn_amplitude` beside them.

    The first turn is to `course.first_turn`. Raises `SpecError` for turns that are too tight or too wide.
    """
    crests = crest_places(spec)
    start = float(crests[0]) - run_in_of(spec.course, crests)
    usual_end = float(crests[-1]) + MARGIN * _step(crests) + PAST_LAST
    end = usual_end if isinstance(spec.course.run_length, str) else start + spec.course.run_length
    down, left, curvature = _turning(spec, crests[crests < end - MARGIN * _step(crests)])
    before = np.arange(down[0] - SPACING, start, -SPACING)[::-1]
    after = np.arange(down[-1] + SPACING, end, SPACING)
    down, left = np.concatenate((before, down, after)), np.pad(left, (len(before), len(after)), mode="edge")
    left = left + _between_columns(spec)
    phase, turn = label_turns(np.pad(curvature, (len(before), len(after))), LEAST_BEND)
    return track_on_surface(terrain, down, left, phase, turn, spec.course.start_speed)


def crest_places(spec: RunSpec) -> np.ndarray:
    """Return the places (n,) [m down] that the line turns round: crests, or `course.turn_spacing` apart."""
    spacing, count = bump_crests(spec.slope, spec.course)
    return spec.slope.bump_start + spacing * np.arange(1, count + 1)


def _between_columns(spec: RunSpec) -> float:
    """Return where to the left [m] a line that turns runs down a field of moguls: between two of its columns."""
    slope = spec.slope
    if slope.kind != "moguls" or spec.course.turn_amplitude == 0.0:
        return 0.0
    return 0.5 * (slope.mogul_spacing if isinstance(slope.mogul_across, str) else slope.mogul_across)


def _step(crests: np.ndarray) -> float:
    return float(crests[-1] - crests[-2]) if len(crests) > 1 else PLAIN_SPACING


def _turning(spec: RunSpec, crests: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return `down`, `left` [m] and `curvature` [1/m] of the line past the crests, straight for no amplitude."""
    amplitude = spec.course.turn_amplitude
    if amplitude == 0.0 or not len(crests):
        straight = np.arange(3) * SPACING + (crests[0] if len(crests) else 0.0)
        return straight, np.zeros(3), np.zeros(3)
    poles, line = _line(spec, crests, amplitude)
    if not _turns_well(line):
        works = _largest_amplitude(spec, crests)
        problem = f"makes turns tighter than {RADIUS_MIN:g} m at a spacing of {_step(crests):g} m"
        hint = f"at most {works:.2f} m would work" if works else "make course.turn_spacing larger"
        raise SpecError("course.turn_amplitude", amplitude, problem=problem, hint=hint)
    down, left, _ = line.sampled(SPACING)
    return down, left, turning_curvature(poles, line, down)


def _line(spec: RunSpec, crests: np.ndarray, amplitude: float) -> tuple[Poles, FairLine]:
    side = alternate(spec.course.first_turn, len(crests))
    lead_in = min(run_in_of(spec.course, crests), MARGIN * _step(crests))
    zero = np.zeros(len(crests))
    poles = Poles(crests, zero, side, np.full(len(crests), amplitude), np.full(len(crests), np.nan))
    return poles, fair_line(poles, lead_in, MARGIN * _step(crests))


def _turns_well(line: FairLine) -> bool:
    if not line.settled or line.steepest > STEEPEST:
        return False
    places = np.linspace(line.begin, line.end, 40 * len(line.apex))
    return bool(np.max(np.abs(line.sines(places, 1))) < 1.0 / RADIUS_MIN)


def _largest_amplitude(spec: RunSpec, crests: np.ndarray) -> float:
    """Return the largest amplitude [m], in hundredths, that works; 0 if none does."""
    some, low, high = crests[:6], 0.0, min(spec.course.turn_amplitude, 0.6 * _step(crests))
    for _ in range(8):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _turns_well(_line(spec, some, middle)[1]) else (low, middle)
    return float(np.floor(98.0 * low)) / 100.0
