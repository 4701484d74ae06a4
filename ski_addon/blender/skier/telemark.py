"""Telemark boots, whose toes stay on the ski while the heel rises, and the ski's binding with its cable."""

from __future__ import annotations

import numpy as np

from ...frames import Array
from .boots import arch, boot_length, boots
from .figure import SOLE_ABOVE_SKI_BASE, Figure
from .shapes import Part, box, join, loft, smooth_step
from .skis import board
from .tubes import tube

_BLEND = 0.05
"""Half length of the bellows, in boot lengths."""


def ball_share(figure: Figure) -> float:
    """Return how far in front of the ankle the boot bends, in boot lengths."""
    return (figure.sizes["pivot_forward"] + figure.sizes["ankle_setback"]) / boot_length(figure)


def telemark_boots(figure: Figure) -> Part:
    """Return both boots with the cables round their heels."""
    drawn = boots(figure)
    drawn.materials = [f"telemark_{name}" if name in ("boots", "boots_trim") else name for name in drawn.materials]
    left = join([_bellows(figure), _cable(figure)]).moved(figure.place["foot.L"]).bound("foot.L")
    return bent_at_the_toes(join([drawn, left, left.mirrored()]), figure)


def bent_at_the_toes(part: Part, figure: Figure) -> Part:
    """Return `part` with what lies in front of the ball of the foot bound to the ski instead of the foot."""
    ball = ball_share(figure)
    for side in "LR":
        foot, ski = f"foot.{side}", f"ski.{side}"
        ahead = part.vertices[:, 0] - figure.place[foot][0]
        length = boot_length(figure)
        share = smooth_step(ahead, (ball - _BLEND) * length, (ball + _BLEND) * length)
        part.weights[ski] = share * part.weights[foot]
        part.weights[foot] = (1.0 - share) * part.weights[foot]
    return part


def telemark_ski(figure: Figure) -> Part:
    """Return the left ski with a toe piece and a heel plate, in the ski's frame."""
    setback, boot, sole = figure.skeleton.ankle_setback, boot_length(figure), SOLE_ABOVE_SKI_BASE
    width = 0.86 * figure.skeleton.ski_width
    toe, low = 0.69 * boot - setback, 0.015
    front = ball_share(figure) * boot - setback
    heel = -0.30 * boot - setback
    parts = [
        board(figure),
        box((toe - front + 0.07, width, sole - low), "bindings", 0.3).moved(
            (0.5 * (toe + front), 0, 0.5 * (low + sole))
        ),
        box((0.045, width, 0.030), "bindings", 0.5).moved((toe + 0.020, 0, sole + 0.010)),
        box((0.055, 0.7 * width, sole - low), "bindings", 0.3).moved((heel, 0, 0.5 * (low + sole))),
        box((0.060, 0.8 * width, 0.006), "bindings_accent", 0.3).moved((heel, 0, sole - 0.003)),
    ]
    for side in (1.0, -1.0):
        cheek = box((0.085, 0.007, 0.030), "bindings", 0.3)
        parts.append(cheek.moved((toe - 0.035, side * 0.62 * width, sole + 0.010)))
    return join(parts).bound("ski.L")


def _bellows(figure: Figure) -> Part:
    """Return the ribbed fold over the ball of the foot."""
    length, half = boot_length(figure), 0.0285 * figure.h + 0.007
    floor = figure.sole - figure.z("foot.L") + 0.012
    top = floor + 0.535 * (0.030 * figure.h - floor)
    places = ball_share(figure) * length + np.linspace(-1.2, 1.2, 9) * _BLEND * length
    rows = []
    for index, x in enumerate(places):
        grow = 1.10 if index % 2 else 1.04
        rows.append(arch(float(x), 1.07 * grow * half, floor + 0.004, floor + grow * 1.04 * (top - floor)))
    return loft(np.stack(rows), "bellows", (False, False))


def _cable(figure: Figure) -> Part:
    """Return the cable from the toe piece round the heel, with its springs beside the sole."""
    length, half = boot_length(figure), 0.0285 * figure.h + 0.007
    z = figure.sole - figure.z("foot.L") + 0.016
    line: list[Array] = []
    for x, w in ((0.60, 1.06), (0.50, 1.16), (0.40, 1.18), (0.30, 1.14), (0.10, 1.08), (-0.20, 1.06), (-0.32, 0.80)):
        line.append(np.array([x * length, w * half, z]))
    heel = [np.array([-0.372 * length, y * half, z]) for y in (0.40, -0.40)]
    cable = tube([*line, *heel, *(p * [1.0, -1.0, 1.0] for p in reversed(line))], 0.0028, "cable", 6)
    springs = [
        tube([(0.28 * length, s * 1.13 * half, z), (0.10 * length, s * 1.09 * half, z)], 0.0065, "buckles", 8)
        for s in (1.0, -1.0)
    ]
    return join([cable, *springs])
