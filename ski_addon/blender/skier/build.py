"""All pieces of the skier from one `Skeleton`: the body in one mesh, and two skis and two poles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .boots import boots
from .clothes import jacket, trousers
from .figure import Figure, build_figure
from .hands import gloves
from .head import head
from .shapes import Part, join
from .skis import pole, ski

if TYPE_CHECKING:
    from ...body.skeleton import Skeleton

EQUIPMENT = ("ski.L", "ski.R", "pole.L", "pole.R")
"""Bodies whose mesh is an object of its own, so that it can be swapped for another model."""


def body_part(figure: Figure) -> Part:
    """Return the dressed skier as one piece at rest, with weights that add up to one at every vertex."""
    part = join([trousers(figure), boots(figure), jacket(figure), gloves(figure), head(figure)])
    total = np.sum(list(part.weights.values()), axis=0)
    part.weights = {name: weight / total for name, weight in part.weights.items()}
    return part


def equipment_part(figure: Figure, body: str) -> Part:
    """Return the ski or pole `body` at rest, wholly bound to it."""
    name, _, side = body.partition(".")
    left = f"{name}.L"
    drawn = (ski if name == "ski" else pole)(figure)
    part = drawn.turned(figure.turn[left]).moved(figure.place[left])
    return part if side == "L" else part.mirrored()


def build_parts(skeleton: Skeleton) -> dict[str, Part]:
    """Return {"body", "ski.L", "ski.R", "pole.L", "pole.R"}: pieces at rest, as `body.rest` has it."""
    figure = build_figure(skeleton)
    return {"body": body_part(figure), **{name: equipment_part(figure, name) for name in EQUIPMENT}}
