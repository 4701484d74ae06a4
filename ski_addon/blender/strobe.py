"""The strobe picture: the slope with the skier at several instants of one run."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..frames import Array
from .headless import check_target, require_blender
from .turns import turn_starts

if TYPE_CHECKING:
    from ..simulation.recording import Recording
    from ..spec import RunSpec

SIZE = (1600, 900)
SAMPLES = 20
STROBE_TURNS = 2.0
"""Turns the strobe picture shows: from the apex of one to that of the next but one."""
STROBE_AZIMUTH, STROBE_HEIGHT = -12.0, 15.0
"""Where the strobe's camera stands: below the turns, beside their line, and over the slope's plane [deg]."""
STROBE_LENS = 30.0
SUN_BESIDE = 100.0
"""Azimuth of the sun beside the line of the turns: low, so that shadows fall long across the slope [deg]."""


def render_strobe(
    recording: Recording,
    spec: RunSpec,
    target: str | Path,
    instants: int = 10,
    *,
    size: tuple[int, int] = SIZE,
    samples: int = SAMPLES,
) -> Path:
    """Write `target`, one picture of the slope with the skier at `instants` moments, as in [SG19 Fig. 11].

    Raises `BlenderMissingError`, `RenderError` or `OutputError`. The open file is closed.
    """
    require_blender("the picture")
    check_target(target)
    from .camera import build_framing_camera, direction_from
    from .pictures import render_to, set_render
    from .posing import leave_copies, posed, remove_rig
    from .rig import build_rig
    from .stage import add_collection, build_stage, empty_file

    scene = empty_file()
    time = strobe_times(recording, instants)
    line = line_azimuth_deg(recording, time)
    skeleton, _ = build_stage(recording, spec, scene, sun_azimuth_deg=line + SUN_BESIDE)
    figures = add_collection(scene, "Instants")
    rig = build_rig(skeleton, scene)
    points = [leave_copies(rig, figures) for _ in posed(rig, recording, skeleton, time)]
    remove_rig(rig)
    set_render(scene, size, samples)
    height = STROBE_HEIGHT - descent_deg(recording, time)
    view = direction_from(line + STROBE_AZIMUTH, height)
    points.append(points[0] + np.array([0.0, 0.0, 7.0]))  # room for trees and sky over the highest skier
    cameras = add_collection(scene, "Camera")
    build_framing_camera(np.concatenate(points), view, scene, cameras, lens=STROBE_LENS, fill=0.90)
    render_to(scene, target)
    return Path(target)


def line_azimuth_deg(recording: Recording, time: Array) -> float:
    """Return the azimuth (0 is +x, 90 is +y) of the straight line from the first to the last of `time` (m,) [s]."""
    x, y, _ = _line(recording, time)
    return float(np.degrees(np.arctan2(y, x)))


def descent_deg(recording: Recording, time: Array) -> float:
    """Return how steeply the straight line from the first to the last of `time` (m,) [s] goes down [deg]."""
    x, y, z = _line(recording, time)
    return float(np.degrees(np.arctan2(-z, np.hypot(x, y))))


def _line(recording: Recording, time: Array) -> Array:
    clock = np.asarray(recording.time) - recording.time[0]
    first, last = (recording.track_position[np.searchsorted(clock, t)] for t in (time[0], time[-1] - 1e-9))
    return np.asarray(last - first)


def strobe_times(recording: Recording, instants: int, turns: float = STROBE_TURNS) -> Array:
    """Return `instants` times [s] evenly over about `turns` turns in the middle of `recording`."""
    clock = np.asarray(recording.time) - recording.time[0]
    edges = np.array([0.0, *clock[turn_starts(recording)], clock[-1]])
    shown = min(turns, len(edges) - 1.0)
    first = np.floor(0.5 * (len(edges) - 1.0 - shown)) + 0.5 * (shown < len(edges) - 1.0)
    first = min(first, len(edges) - 1.0 - shown)
    low, high = np.interp((first, first + shown), np.arange(len(edges)), edges)
    return np.linspace(low, high, instants)
