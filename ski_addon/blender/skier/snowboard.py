"""Snowboard with its two bindings, in the board's frame (origin in the middle of the base, x towards the nose)."""

from __future__ import annotations

import numpy as np

from ...frames import Array, rotation_about
from .boots import arch
from .figure import SOLE_ABOVE_SKI_BASE, Figure
from .shapes import Part, box, join, loft
from .soft_boots import boot_half_width, boot_length, shell_size
from .tubes import spindle

TIP_SHARE, TIP_RISE, THICKNESS = 0.135, 0.050, 0.0095
"""Share of the length that bends up and rounds off at each end, how far up [m], and the board's thickness [m]."""
WAIST_SHARE = 0.84
"""Width in the middle over width at the contact points."""


def snowboard(figure: Figure) -> Part:
    """Return the board and its bindings, fitted to the boots."""
    sizes = figure.sizes
    parts = [_board(sizes["length"], sizes["width"])]
    for x, angle in binding_places(figure):
        turn = rotation_about("z", angle)
        parts.append(_binding(figure).turned(turn).moved((x, 0.0, 0.0)))
    return join(parts).bound("board")


def binding_places(figure: Figure) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return place along the board [m] and direction of the toes (angle from the nose [rad]) of both bindings."""
    sizes = figure.sizes
    faces = 1.0 if sizes["goofy"] else -1.0  # to the board's left, or to its right
    front, rear = (faces * (0.5 * np.pi - sizes[name]) for name in ("angle_front", "angle_rear"))
    return (0.5 * sizes["stance"], float(front)), (-0.5 * sizes["stance"], float(rear))


def _half_width(x: Array, length: float, width: float) -> Array:
    """Return the half width [m] at `x` [m] from the middle, both ends round; `width` is that in the middle."""
    effective = (0.5 - TIP_SHARE) * length
    wide = 0.5 * width / WAIST_SHARE
    side = 0.5 * width + (wide - 0.5 * width) * np.minimum(np.abs(x) / effective, 1.0) ** 2
    tip = np.clip((np.abs(x) - effective) / (TIP_SHARE * length), 0.0, 1.0)
    return side * np.sqrt(np.maximum(1.0 - tip**2.3, 0.012))


def _board(length: float, width: float) -> Part:
    tip = np.array([0.372, 0.392, 0.412, 0.430, 0.447, 0.462, 0.475, 0.486, 0.494, 0.4985, 0.5])
    share = np.concatenate((-tip[::-1], np.linspace(-0.35, 0.35, 15), tip))
    x = share * length
    half = _half_width(x, length, width)
    bend = np.clip((np.abs(share) - 0.5 + TIP_SHARE) / TIP_SHARE, 0.0, 1.0)
    rows = [_section(*values) for values in zip(x, half, TIP_RISE * bend**1.9, strict=True)]
    return loft(np.stack(rows), lambda row, column: _material(float(share[row]), column))


def _section(x: float, half: float, base: float) -> Array:
    top = max(half - 0.007, 0.6 * half)
    y = np.array([-half, -half, -top, -0.45 * half, -0.15 * half, 0.15 * half, 0.45 * half, top, half, half])
    z = base + THICKNESS * np.array([0.0, 0.45, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.45, 0.0])
    return np.column_stack((np.full(10, x), y, z))


def _material(share: float, column: int) -> str:
    if column == 9:
        return "skis_base"
    if column in (0, 8):
        return "skis_edge"
    if share > 0.36 or share < -0.40:
        return "board_accent"
    return "board_stripe" if column in (3, 5) and abs(share) > 0.22 else "board"


def _binding(figure: Figure) -> Part:
    """Return disc, base plate, highback and straps, the toes along +x and the binding's middle at the origin."""
    boot, half = boot_length(figure), boot_half_width(figure) + 0.006
    sole = SOLE_ABOVE_SKI_BASE
    setback = figure.skeleton.ankle_setback
    plate = box((0.74 * boot, 1.7 * half, sole - THICKNESS), "bindings", 0.3)
    disc = spindle([(0.055, -0.003), (0.055, 0.003)], "bindings_accent", 20).turned(rotation_about("x", 0.5 * np.pi))
    middle = 0.17 * boot - setback
    parts = [
        plate.moved((middle, 0.0, 0.5 * (sole + THICKNESS))),
        disc.moved((middle, 0.0, THICKNESS + 0.002)),
        _highback(figure, half).moved((-setback, 0.0, sole)),
        *(_strap(figure, *place).moved((-setback, 0.0, sole)) for place in ((0.17, 0.21), (0.47, 0.15))),
    ]
    for side in (1.0, -1.0):
        heel_cup = box((0.40 * boot, 0.008, 0.045), "bindings", 0.3)
        parts.append(heel_cup.moved((-0.14 * boot - setback, side * 1.06 * half, sole + 0.020)))
    return join(parts)


def _highback(figure: Figure, half: float) -> Part:
    """Return the curved plate behind the boot's leg."""
    h, boot = figure.h, boot_length(figure)
    angle = np.linspace(0.62, 2.0 - 0.62, 9) * np.pi
    rows = []
    for z, wide, back in ((0.00, 1.08, 0.375), (0.03, 1.06, 0.375), (0.07, 0.98, 0.345), (0.115, 0.72, 0.330)):
        rise = z * h
        x, y = back * boot * np.cos(angle), wide * half * np.sin(angle)
        outer = np.column_stack((x, y, np.full(9, rise)))
        inner = np.column_stack((x + 0.006, 0.95 * y, np.full(9, rise)))
        rows.append(np.concatenate((outer, inner[::-1])))
    return loft(np.stack(rows), "bindings")


def _strap(figure: Figure, at: float, width: float) -> Part:
    """Return a strap over the boot, `at` a share of its length in front of the ankle; `width` is such a share, too."""
    length = boot_length(figure)
    rows = []
    for shift, grow in ((-0.5, 1.0), (-0.42, 1.07), (0.42, 1.07), (0.5, 1.0)):
        share = at + shift * width
        half, top = shell_size(figure, share)
        rows.append(arch(share * length, grow * half, -0.004, grow * top))
    return loft(np.stack(rows), lambda row, _column: "bindings_accent" if row == 1 else "bindings", (False, False))
