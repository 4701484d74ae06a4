"""What the clothes are cut to: joint places of a `Skeleton` at rest, stature and girth."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from ...body.rest import rest_frames
from ...frames import Array

if TYPE_CHECKING:
    from ...body.skeleton import Skeleton
    from ...turning.figures import FigureModel

ALPINE_GEAR = ("ski.L", "ski.R", "pole.L", "pole.R")
"""Bodies of the alpine skier that are no part of the person."""

REFERENCE_BODY_MASS_INDEX = 50.0 / 1.5**2
"""Body mass index [kg/m^2] of the person the clothes are drawn for."""
SOLE_ABOVE_SKI_BASE = 0.034
"""Height of the boot's sole above the ski's base: ski and binding plate [m]."""


@dataclass(frozen=True)
class Figure:
    """A person with gear at rest: upright, arms hanging, the gear on z = 0, the pelvis above the origin.

    `place` {body: (3,)} [m] and `turn` {body: (3, 3)} of the body frames, parents first; `h` stature [m]; `girth` is
    the factor on the thickness of limbs and trunk; `parent` {body: its parent's name, or ""}; `free` are the bodies
    that also move against their parent; `gear` those that are no part of the person, with its `sizes` [m, rad].
    """

    skeleton: Skeleton
    place: dict[str, Array]
    turn: dict[str, Array]
    h: float
    girth: float
    kind: str = "alpine"
    parent: Mapping[str, str] = field(default_factory=dict)
    free: tuple[str, ...] = ("pelvis",)
    gear: tuple[str, ...] = ALPINE_GEAR
    sizes: Mapping[str, float] = field(default_factory=dict)

    def z(self, body: str) -> float:
        """Return the height [m] of the frame of `body`."""
        return float(self.place[body][2])

    @property
    def sole(self) -> float:
        """Height [m] of the soles."""
        if self.kind == "bicycle":
            return self.z("foot.L") - self.sizes["ankle_height"]
        return self.z("board" if self.kind == "snowboard" else "ski.L") + SOLE_ABOVE_SKI_BASE


def build_figure(skeleton: Skeleton) -> Figure:
    """Return the measures of the alpine skier `skeleton` at rest."""
    position, rotation = rest_frames(skeleton)
    names = skeleton.body_names
    return Figure(
        skeleton=skeleton,
        place={name: position[i] for i, name in enumerate(names)},
        turn={name: rotation[i] for i, name in enumerate(names)},
        h=skeleton.height,
        girth=_girth(skeleton),
        parent=_parents(names, skeleton.parent),
    )


def figure_of(model: FigureModel) -> Figure:
    """Return the measures of a figure of any kind."""
    names = model.body_names
    return Figure(
        skeleton=model.skeleton,
        place={name: np.asarray(model.place[i]) for i, name in enumerate(names)},
        turn={name: np.asarray(model.turn[i]) for i, name in enumerate(names)},
        h=model.skeleton.height,
        girth=_girth(model.skeleton),
        kind=model.kind,
        parent=_parents(names, model.parent),
        free=tuple(model.free),
        gear=tuple(model.gear),
        sizes=model.sizes,
    )


def _girth(skeleton: Skeleton) -> float:
    mass_index = float(skeleton.mass.sum()) / skeleton.height**2
    return float(np.clip(np.sqrt(mass_index / REFERENCE_BODY_MASS_INDEX), 0.85, 1.3))


def _parents(names: tuple[str, ...], parent: Array) -> dict[str, str]:
    return {name: names[parent[i]] if parent[i] >= 0 else "" for i, name in enumerate(names)}
