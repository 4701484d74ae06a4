"""Sec. 7: what the four figures do at six moments of a swing."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from ..spec import RunSpec
from ..turning.figures import build_figure, poses_at
from ..turning.figures.sampling import Run
from ..turning.preview import preview_motion
from .sticks import draw_sheet

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PHASES = (0, 45, 90, 180, 225, 270)
"""Degrees: upright on the way to the left, in the turn to the left, and the same to the right."""
LEANS = {"alpine": 26.0, "telemark": 22.0, "snowboard": 28.0, "bicycle": 18.0}
PERIOD, SPEED = 2.4, 8.0


def draw_figure(figure: Figure, kind: str) -> None:
    """Draw a figure of `kind` at six phases of a swing on a slope of 10 degrees, in the frame of its own lean."""
    swing = [{"time": 0.0, "period": PERIOD, "sharpness_deg": LEANS[kind]}]
    course = {"kind": "rhythm", "start_speed": SPEED, "pace": "held"}
    spec = RunSpec.from_dict(
        {"slope": {"angle_deg": 10.0}, "figure": {"kind": kind}, "course": course, "rhythm": swing}
    )
    model, motion = build_figure(spec), preview_motion(spec)
    first = 2.0 * np.pi * np.ceil(np.unwrap(motion.phase)[len(motion.time) // 3] / (2.0 * np.pi))
    time = np.interp(first + np.deg2rad(PHASES), np.unwrap(motion.phase), motion.time)
    titles = [f"{phase}°" for phase in PHASES]
    draw_sheet(figure, model, poses_at(model, spec, motion, time), titles, Run(motion).at(time).body)


draw_alpine, draw_telemark, draw_snowboard, draw_bicycle = (partial(draw_figure, kind=kind) for kind in LEANS)
