"""Ski boots: a shell on the foot, a cuff on the shank, sole and buckles. The binding belongs to the ski."""

from __future__ import annotations

import numpy as np

from ...frames import Array
from .figure import Figure
from .shapes import Part, Ring, box, chain_weights, join, loft, stack

# along the foot from heel to toe: place, half width, top of the shell; in boot lengths and boot heights
_SHELL = (
    (-0.345, 0.55, 0.30),
    (-0.335, 0.80, 0.52),
    (-0.300, 0.92, 0.82),
    (-0.200, 0.96, 1.00),
    (-0.080, 0.97, 1.02),
    (0.050, 0.97, 0.98),
    (0.140, 0.98, 0.84),
    (0.240, 1.02, 0.66),
    (0.360, 1.06, 0.55),
    (0.480, 1.05, 0.49),
    (0.570, 0.95, 0.44),
    (0.630, 0.75, 0.38),
    (0.655, 0.50, 0.30),
)
_TOE_LUG = 0.69


def boots(figure: Figure) -> Part:
    """Return both boots."""
    left = _boot(figure)
    return join([left, left.mirrored()])


def boot_length(figure: Figure) -> float:
    """Return the length [m] of a boot's shell."""
    return 0.152 * figure.h + 0.045


def _boot(figure: Figure) -> Part:
    ankle = figure.place["foot.L"]
    lower = join([_shell(figure), _sole(figure), *_shell_buckles(figure)]).moved(ankle).bound("foot.L")
    return join([lower, _cuff(figure)])


def _half_width(figure: Figure) -> float:
    return 0.0285 * figure.h + 0.007


def _shell(figure: Figure) -> Part:
    length, half = boot_length(figure), _half_width(figure)
    floor = figure.sole - figure.z("foot.L") + 0.012
    top = 0.030 * figure.h
    rows = [arch(x * length, w * half, floor, floor + t * (top - floor)) for x, w, t in _SHELL]
    return loft(np.stack(rows), _shell_material)


def _shell_material(row: int, column: int) -> str:
    return "boots_trim" if row in (9,) and 2 <= column <= 9 else "boots"


def arch(x: float, half: float, low: float, high: float) -> Array:
    """Return a flat-bottomed arch (12, 3) across the foot at `x`."""
    y = half * np.array([-0.86, -1.0, -1.0, -0.90, -0.62, -0.25, 0.25, 0.62, 0.90, 1.0, 1.0, 0.86])
    z = low + (high - low) * np.array([0.0, 0.10, 0.42, 0.74, 0.93, 1.0, 1.0, 0.93, 0.74, 0.42, 0.10, 0.0])
    return np.column_stack((np.full(12, x), y, z))


def _sole(figure: Figure) -> Part:
    length, half = boot_length(figure), 0.92 * _half_width(figure)
    low = figure.sole - figure.z("foot.L")
    x = np.array([-0.375, -0.365, -0.25, 0.2, 0.48, 0.60, _TOE_LUG - 0.01, _TOE_LUG]) * length
    width = half * np.array([0.55, 0.72, 0.92, 0.88, 1.0, 0.85, 0.62, 0.55])
    rows = [
        np.array([[a, -w, low], [a, -w, low + 0.018], [a, w, low + 0.018], [a, w, low]])
        for a, w in zip(x, width, strict=True)
    ]
    return loft(np.stack(rows), "boots_sole")


def _cuff(figure: Figure) -> Part:
    h = figure.h
    ankle = figure.place["foot.L"]
    rows = (
        (-0.030, 0.0300, 0.030, 0.034),
        (-0.022, 0.0335, 0.038, 0.041),
        (0.000, 0.0345, 0.0405, 0.042),
        (0.030, 0.0345, 0.0400, 0.041),
        (0.065, 0.0355, 0.0405, 0.042),
        (0.100, 0.0375, 0.0425, 0.0445),
        (0.112, 0.0380, 0.0430, 0.0455),
        (0.114, 0.0340, 0.0390, 0.0410),
        (0.090, 0.0320, 0.0370, 0.0390),
    )
    rings = [Ring(z * h, s * h, f * h, b * h, power=2.3) for z, s, f, b in rows]
    cuff = stack(rings, 18, lambda row, _column: "boots_trim" if row >= 5 else "boots", (True, False))
    part = join([cuff, *_cuff_buckles(figure)]).moved(ankle)
    part.weights = chain_weights(part.vertices[:, 2], ("shank.L", "foot.L"), [float(ankle[2]) - 0.024 * h], [0.012 * h])
    return part


def _cuff_buckles(figure: Figure) -> list[Part]:
    """Return two straps round the cuff, each with its lever on the outer side."""
    h = figure.h
    parts = []
    for z, side, front, back in ((0.040, 0.0349, 0.0402, 0.0412), (0.078, 0.0362, 0.0414, 0.0430)):
        rows = ((-0.0075, 0.99), (-0.006, 1.045), (0.006, 1.045), (0.0075, 0.99))
        rings = [Ring((z + dz) * h, side * h * s, front * h * s, back * h * s, power=2.3) for dz, s in rows]
        parts.append(stack(rings, 18, "boots_trim", (False, False)))
        parts.append(_lever((0.020 * h, 0.0345 * h * 1.02, z * h)))
    return parts


def _shell_buckles(figure: Figure) -> list[Part]:
    """Return two straps over the instep, each with its lever on the outer side."""
    length, half = boot_length(figure), _half_width(figure)
    floor = figure.sole - figure.z("foot.L") + 0.012
    rise = 0.030 * figure.h - floor
    place, width, top = (np.array(column) for column in zip(*_SHELL, strict=True))
    parts = []
    for x in (0.19, 0.33):
        rows = []
        for shift, grow in ((-0.032, 0.99), (-0.025, 1.06), (0.025, 1.06), (0.032, 0.99)):
            w, t = float(np.interp(x + shift, place, width)), float(np.interp(x + shift, place, top))
            rows.append(arch((x + shift) * length, grow * w * half, floor, floor + grow * t * rise))
        parts.append(loft(np.stack(rows), "boots_trim", (False, False)))
        parts.append(_lever((x * length, 1.02 * half, floor + 0.40 * float(np.interp(x, place, top)) * rise)))
    return parts


def _lever(place: tuple[float, float, float]) -> Part:
    return box((0.030, 0.008, 0.012), "buckles", 0.4).moved(place)
