"""What the clothes are cut to: joint places of a `Skeleton` at rest, stature and girth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ...body.rest import rest_frames
from ...frames import Array

if TYPE_CHECKING:
    from ...body.skeleton import Skeleton

REFERENCE_BODY_MASS_INDEX = 50.0 / 1.5**2
"""Body mass index [kg/m^2] of the person the clothes are drawn for."""
SOLE_ABOVE_SKI_BASE = 0.034
"""Height of the boot's sole above the ski's base: ski and binding plate [m]."""


@dataclass(frozen=True)
class Figure:
    """A skier at rest: upright, arms hanging, ski bases on z = 0, the pelvis above the origin.

    `place` {body: (3,)} [m] and `turn` {body: (3, 3)} of the body frames; `h` stature [m]; `girth` is the factor on
    the thickness of limbs and trunk.
    """

    skeleton: Skeleton
    place: dict[str, Array]
    turn: dict[str, Array]
    h: float
    girth: float

    def z(self, body: str) -> float:
        """Return the height [m] of the frame of `body`."""
        return float(self.place[body][2])

    @property
    def sole(self) -> float:
        """Height [m] of the boots' soles."""
        return self.z("ski.L") + SOLE_ABOVE_SKI_BASE


def build_figure(skeleton: Skeleton) -> Figure:
    """Return the measures of `skeleton` at rest."""
    position, rotation = rest_frames(skeleton)
    mass_index = float(skeleton.mass.sum()) / skeleton.height**2
    names = skeleton.body_names
    return Figure(
        skeleton=skeleton,
        place={name: position[i] for i, name in enumerate(names)},
        turn={name: rotation[i] for i, name in enumerate(names)},
        h=skeleton.height,
        girth=float(np.clip(np.sqrt(mass_index / REFERENCE_BODY_MASS_INDEX), 0.85, 1.3)),
    )
