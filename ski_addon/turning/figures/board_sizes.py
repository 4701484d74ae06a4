"""Measures of a snowboard and of the stance on it."""

from __future__ import annotations

import numpy as np

from ...body import Skeleton
from ...frames import rotation_about
from ...spec import FigureSpec

BODIES: dict[str, str | None] = {"board": None}
"""Bodies that are ridden, and the body each hangs on."""


def board_sizes(skeleton: Skeleton, figure: FigureSpec) -> dict[str, float]:
    """Return the measures.

    `length`, `width` of the board at its waist, `stance` between the bindings, `ankle_height` over the base,
    `ankle_setback` behind the binding's middle [m]; `angle_front`, `angle_rear` of the feet from straight across,
    positive towards the nose [rad]; `goofy` is 1 with the right foot in front, else 0.
    """
    h = skeleton.height
    return {
        "length": min(0.9 * h, 1.68) if figure.board_length == "auto" else float(figure.board_length),
        "width": float(np.clip(0.15 * h, 0.2, 0.28)),
        "stance": 0.31 * h if figure.foot_distance == "auto" else float(figure.foot_distance),
        "ankle_height": skeleton.ankle_height,
        "ankle_setback": skeleton.ankle_setback,
        "angle_front": float(np.deg2rad(figure.front_foot_deg)),
        "angle_rear": float(np.deg2rad(figure.rear_foot_deg)),
        "goofy": float(figure.stance == "goofy"),
    }


def rest(sizes: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
    """Return place (1, 3) and turn (1, 3, 3) of the board at rest: across under the rider, who faces +x."""
    side = -0.5 * np.pi if sizes["goofy"] else 0.5 * np.pi
    return np.array([[sizes["ankle_setback"], 0.0, 0.0]]), rotation_about("z", np.array([side]))
