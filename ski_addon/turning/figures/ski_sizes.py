"""Measures of alpine and telemark skis, poles and bindings."""

from __future__ import annotations

import numpy as np

from ...body import Skeleton
from ...spec import FigureSpec

GRIP = 0.055
"""Length of a pole's grip above the hand's middle [m]."""
SOLE_HEIGHT = 0.034
"""Height of a boot's sole over the base of the ski [m]."""


def ski_sizes(skeleton: Skeleton, figure: FigureSpec) -> dict[str, float]:
    """Return the measures [m].

    `ski_length`, `ski_width`; `stance_width` between the skis; `pole_length`, and `tip_distance` from the hand's middle
    to the tip; `ankle_height` over the ski's base and `ankle_setback` behind its middle. Telemark skis also have
    `split`, the distance between the feet fore and aft, and `pivot_forward` and `pivot_height`, the place in the ski's
    frame about which the foot turns when its heel lifts.
    """
    sizes = {
        "ski_length": skeleton.ski_length,
        "ski_width": skeleton.ski_width,
        "stance_width": skeleton.stance_width,
        "pole_length": skeleton.pole_length,
        "tip_distance": skeleton.pole_length - GRIP,
        "ankle_height": skeleton.ankle_height,
        "ankle_setback": skeleton.ankle_setback,
    }
    if figure.kind == "telemark":
        auto = 0.3 * skeleton.height
        sizes |= {
            "stance_width": float(np.clip(0.08 * skeleton.height, skeleton.ski_width + 0.04, skeleton.stance_width)),
            "split": auto if figure.split == "auto" else float(figure.split),
            "pivot_forward": 0.062 * skeleton.height,
            "pivot_height": SOLE_HEIGHT,
        }
    return sizes
