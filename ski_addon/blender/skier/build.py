"""All pieces of a figure: the dressed body in one mesh, and each piece of its gear."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .bicycle import bicycle_part
from .boots import boots
from .clothes import jacket, trousers
from .cycling_helmet import cyclist_head
from .figure import ALPINE_GEAR, Figure, build_figure
from .hands import gloves, mittens, thin_gloves
from .head import head
from .jersey import jersey, shorts
from .paints import dressed_for
from .shapes import Part, join
from .shoes import shoes
from .skis import pole, ski
from .snowboard import snowboard
from .soft_boots import soft_boots
from .telemark import telemark_boots, telemark_ski

if TYPE_CHECKING:
    from ...body.skeleton import Skeleton

EQUIPMENT = ALPINE_GEAR
"""Bodies of the alpine skier whose mesh is an object of its own, so that it can be swapped for another model."""
WARDROBE = {
    "alpine": (trousers, boots, jacket, gloves, head),
    "snowboard": (trousers, soft_boots, jacket, mittens, head),
    "telemark": (trousers, telemark_boots, jacket, gloves, head),
    "bicycle": (shorts, shoes, jersey, thin_gloves, cyclist_head),
}
"""What the figures of each kind wear, from the inside out."""


def body_part(figure: Figure) -> Part:
    """Return the dressed person as one piece at rest, with weights that add up to one at every vertex."""
    part = join([draw(figure) for draw in WARDROBE[figure.kind]])
    total = np.sum(list(part.weights.values()), axis=0)
    part.weights = {name: weight / total for name, weight in part.weights.items()}
    part.materials = dressed_for(figure.kind, part.materials)
    return part


def equipment_part(figure: Figure, body: str) -> Part:
    """Return the piece of gear `body` at rest, wholly bound to it."""
    part = bicycle_part(figure, body) if figure.kind == "bicycle" else _carried(figure, body)
    part.materials = dressed_for(figure.kind, part.materials)
    return part


def _carried(figure: Figure, body: str) -> Part:
    """Return a ski, pole or board, drawn in its own frame and put in its place."""
    name, _, side = body.partition(".")
    if name == "board":
        return snowboard(figure).turned(figure.turn[body]).moved(figure.place[body])
    left = f"{name}.L"
    skis = telemark_ski if figure.kind == "telemark" else ski
    drawn = (skis if name == "ski" else pole)(figure)
    part = drawn.turned(figure.turn[left]).moved(figure.place[left])
    return part if side == "L" else part.mirrored()


def figure_parts(figure: Figure) -> dict[str, Part]:
    """Return all pieces at rest: "body", and each piece of gear by the name of its body."""
    return {"body": body_part(figure), **{name: equipment_part(figure, name) for name in figure.gear}}


def build_parts(skeleton: Skeleton) -> dict[str, Part]:
    """Return the pieces of the alpine skier at rest: {"body", "ski.L", "ski.R", "pole.L", "pole.R"}."""
    return figure_parts(build_figure(skeleton))
