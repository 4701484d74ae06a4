"""Bicycle wheels: tyre, rim, spokes and hub, in the wheel's frame (origin in the hub, y along the axle)."""

from __future__ import annotations

import numpy as np

from ...frames import Array
from .shapes import Part, join
from .tubes import spindle, tube, turned_profile

TYRE_WIDTH = 0.044
SPOKES = 28
_FLANGE_RADIUS, _FLANGE_HALF_WIDTH = 0.026, 0.032
_STEPS = 56


def wheel(radius: float, body: str, *, rear: bool) -> Part:
    """Return a wheel whose tyre reaches `radius` [m], bound to `body`; the `rear` one has a sprocket on the right."""
    parts = [_tyre(radius), _rim(radius), *_spokes(radius), _hub(), _valve(radius)]
    if rear:
        parts.append(sprocket(0.036, 17).moved((0.0, -0.044, 0.0)))
    return join(parts).bound(body)


def sprocket(radius: float, teeth: int, thickness: float = 0.004, hole: float = 0.45) -> Part:
    """Return a toothed disc of the pitch `radius` [m] about the y axis, open within `hole` of its radius."""
    steps = 2 * teeth
    half = 0.5 * thickness
    profile = np.array([(hole * radius, -half), (radius, -half), (radius, half), (hole * radius, half)])
    part = turned_profile([(float(r), float(y)) for r, y in profile], "bicycle_metal", steps)
    vertices = part.vertices.reshape(steps, 4, 3).copy()
    tooth = np.where(np.arange(steps) % 2 == 0, 1.0 + 0.0055 / radius, 1.0 - 0.003 / radius)
    vertices[:, 1:3, [0, 2]] *= tooth[:, None, None]
    part.vertices = vertices.reshape(-1, 3)
    return part


def _tyre(radius: float) -> Part:
    half = 0.5 * TYRE_WIDTH
    centre = radius - half
    angle = 2.0 * np.pi * np.arange(14) / 14
    profile = [(centre + half * float(np.cos(a)), half * float(np.sin(a))) for a in angle]

    def material(_row: int, column: int) -> str:
        return "tyres" if np.cos(angle[column] + np.pi / 14) > 0.2 else "tyre_walls"

    return turned_profile(profile, material, _STEPS)


def _rim(radius: float) -> Part:
    outer = radius - TYRE_WIDTH + 0.010
    profile = [
        *((outer, -0.0125), (outer, 0.0125), (outer - 0.013, 0.0130)),
        *((outer - 0.024, 0.0060), (outer - 0.024, -0.0060), (outer - 0.013, -0.0130)),
    ]
    return turned_profile(profile, "bicycle_parts", _STEPS)


def _spokes(radius: float) -> list[Part]:
    """Return crossed spokes, by turns to the left and the right flange."""
    end = radius - TYRE_WIDTH - 0.012
    parts = []
    for index in range(SPOKES):
        angle = 2.0 * np.pi * index / SPOKES
        side = 1.0 if index % 2 else -1.0
        lead = 0.9 * (1.0 if index % 4 < 2 else -1.0)
        start = _on_wheel(_FLANGE_RADIUS, angle + lead, side * _FLANGE_HALF_WIDTH)
        parts.append(tube([start, _on_wheel(end, angle, side * 0.003)], 0.0011, "bicycle_metal", 4))
    return parts


def _hub() -> Part:
    flange, half = _FLANGE_RADIUS + 0.004, _FLANGE_HALF_WIDTH
    profile = [
        *((0.004, -0.056), (0.007, -0.055), (0.007, -half - 0.004), (flange, -half - 0.003), (flange, -half + 0.003)),
        *((0.014, -half + 0.008), (0.013, 0.0), (0.014, half - 0.008)),
        *((flange, half - 0.003), (flange, half + 0.003), (0.007, half + 0.004), (0.007, 0.055), (0.004, 0.056)),
    ]
    return spindle(profile, "bicycle_metal", 14)


def _valve(radius: float) -> Part:
    end = radius - TYRE_WIDTH - 0.014
    angle = np.pi / SPOKES
    return tube([_on_wheel(end, angle, 0.0), _on_wheel(end - 0.03, angle, 0.0)], 0.0022, "bicycle_metal", 6)


def _on_wheel(radius: float, angle: float, y: float) -> Array:
    return np.array([radius * np.cos(angle), y, radius * np.sin(angle)])
