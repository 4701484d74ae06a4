"""Skis with sidecut, shovel, tail and bindings, and poles with grip, shaft, basket and strap."""

from __future__ import annotations

import numpy as np

from ...frames import Array
from .boots import boot_length
from .figure import SOLE_ABOVE_SKI_BASE, Figure
from .shapes import Part, Ring, box, join, loft, stack

SHOVEL_SHARE, TAIL_SHARE = 0.105, 0.035
"""Shares of the ski's length that bend up and round off, in front and behind."""
SHOVEL_RISE, TAIL_RISE = 0.060, 0.012
POLE_ABOVE_HAND = 0.055
"""Length of the grip above the hand's middle [m]."""


def ski(figure: Figure) -> Part:
    """Return the left ski and its binding, in the ski's frame (origin in the middle of the base)."""
    return join([board(figure), *_binding(figure)]).bound("ski.L")


def pole(figure: Figure) -> Part:
    """Return the left pole in the pole's frame (origin in the grip, the tip along -z)."""
    length = figure.skeleton.pole_length - POLE_ABOVE_HAND
    return join([_grip(), _shaft(length), _basket(length), _strap()]).bound("pole.L")


def half_width(x: Array, length: float, waist: float, radius: float) -> Array:
    """Return the half width [m] of a ski at `x` [m] from its middle: a circular sidecut, rounded at both ends."""
    x = np.asarray(x, dtype=float)
    side = 0.5 * waist + radius - np.sqrt(radius**2 - x**2)
    shovel = np.clip((x - (0.5 - SHOVEL_SHARE) * length) / (SHOVEL_SHARE * length), 0.0, 1.0)
    tail = np.clip((-x - (0.5 - TAIL_SHARE) * length) / (TAIL_SHARE * length), 0.0, 1.0)
    return side * np.sqrt(np.maximum(1.0 - shovel**2.2, 0.01)) * np.sqrt(np.maximum(1.0 - 0.75 * tail**2.5, 0.01))


def board(figure: Figure) -> Part:
    """Return the left ski without binding, in its own frame, unbound."""
    skeleton = figure.skeleton
    length = skeleton.ski_length
    share = np.concatenate(
        (
            np.array([-0.5, -0.497, -0.49, -0.478, -0.465]),
            np.linspace(-0.43, 0.39, 15),
            np.array([0.412, 0.432, 0.450, 0.466, 0.480, 0.490, 0.496, 0.5]),
        )
    )
    x = share * length
    half = half_width(x, length, skeleton.ski_width, skeleton.ski_sidecut_radius)
    front = np.clip((share - 0.5 + SHOVEL_SHARE) / SHOVEL_SHARE, 0.0, 1.0)
    behind = np.clip((-share - 0.5 + TAIL_SHARE) / TAIL_SHARE, 0.0, 1.0)
    base = SHOVEL_RISE * front**1.8 + TAIL_RISE * behind**1.6
    thick = 0.007 + 0.010 * np.clip(1.0 - (np.abs(share) / 0.5) ** 1.6, 0.0, 1.0)
    rows = [_board_section(*values) for values in zip(x, half, base, thick, strict=True)]
    return loft(np.stack(rows), lambda row, column: _board_material(row, column, len(x) - 1))


def _board_section(x: float, half: float, base: float, thick: float) -> Array:
    top = max(half - 0.006, 0.6 * half)
    y = np.array([-half, -half, -top, -0.33 * half, 0.33 * half, top, half, half])
    z = base + thick * np.array([0.0, 0.45, 1.0, 1.0, 1.0, 1.0, 0.45, 0.0])
    return np.column_stack((np.full(8, x), y, z))


def _board_material(row: int, column: int, rows: int) -> str:
    if column == 7:
        return "skis_base"
    if column in (0, 6):
        return "skis_edge"
    share = row / rows
    if share > 0.74 or share < 0.10:
        return "skis_accent"
    return "skis_stripe" if column == 3 and (share > 0.58 or share < 0.32) else "skis"


def _binding(figure: Figure) -> list[Part]:
    """Return plate, toe piece, heel piece and brake, fitted to the boot."""
    setback = figure.skeleton.ankle_setback
    boot = boot_length(figure)
    heel, toe = -0.375 * boot - setback, 0.69 * boot - setback
    width = 0.86 * figure.skeleton.ski_width
    low, sole = 0.015, SOLE_ABOVE_SKI_BASE
    middle = 0.5 * (heel + toe)
    return [
        box((toe - heel + 0.10, width, sole - low), "bindings", 0.3).moved((middle, 0, 0.5 * (low + sole))),
        box((0.060, width, 0.034), "bindings", 0.5).moved((toe + 0.026, 0, sole + 0.014)),
        box((0.034, 0.55 * width, 0.020), "bindings_accent", 0.4).moved((toe + 0.002, 0, sole + 0.026)),
        box((0.058, 0.92 * width, 0.056), "bindings", 0.5).moved((heel - 0.026, 0, sole + 0.024)),
        box((0.036, 0.60 * width, 0.020), "bindings_accent", 0.4).moved((heel - 0.004, 0, sole + 0.040)),
    ]


def _grip() -> Part:
    rows = (
        (0.055, 0.009),
        (0.053, 0.0155),
        (0.045, 0.0185),
        (0.034, 0.0160),
        (0.010, 0.0150),
        (-0.020, 0.0155),
        (-0.045, 0.0150),
        (-0.060, 0.0170),
        (-0.066, 0.0120),
    )
    return stack([Ring(z, 0.92 * r, r, r) for z, r in rows], 10, "poles_grip")


def _shaft(length: float) -> Part:
    shares = (0.0, 0.12, 0.125, 0.24, 0.245, 0.70, 0.705, 0.85, 1.0)
    rings = [Ring(-0.055 - s * (length - 0.085), *(3 * (0.0088 - 0.0034 * s,))) for s in shares]
    shaft = stack(rings, 10, lambda row, _column: "poles_accent" if row in (2, 6) else "poles")
    tip = stack([Ring(-length + 0.035, *(3 * (0.0054,))), Ring(-length, *(3 * (0.0016,)))], 8, "poles_grip")
    return join([shaft, tip])


def _basket(length: float) -> Part:
    z = -length + 0.062
    rows = (
        (0.014, 0.009),
        (0.010, 0.014),
        (0.0, 0.042),
        (-0.003, 0.045),
        (-0.006, 0.042),
        (-0.002, 0.014),
        (-0.012, 0.010),
    )
    return stack([Ring(z + dz, *(3 * (r,))) for dz, r in rows], 14, "poles_grip")


def _strap() -> Part:
    """Return the strap: a flat loop from the top of the grip round the back of the hand."""
    angle = np.linspace(0.0, 2.0 * np.pi, 14, endpoint=False)
    centre = np.stack(
        (-0.012 - 0.040 * (1 - np.cos(angle)), 0.016 * np.sin(angle), 0.040 - 0.012 * (1 - np.cos(angle))), axis=1
    )
    tangent = np.roll(centre, -1, axis=0) - np.roll(centre, 1, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    across = np.array([0.0, 0.0, 1.0])
    out = np.cross(tangent, across)
    ring = [
        0.0007 * out + 0.006 * across,
        -0.0007 * out + 0.006 * across,
        -0.0007 * out - 0.006 * across,
        0.0007 * out - 0.006 * across,
    ]
    rows = np.stack([centre + offset for offset in ring], axis=1)
    rows = np.concatenate((rows, rows[:1]))
    return loft(rows, "poles_accent", (False, False))
