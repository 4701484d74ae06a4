"""Snowboard boots: soft, laced, round at the toe, of one piece from sole to shaft."""

from __future__ import annotations

import numpy as np

from .boots import arch
from .figure import Figure
from .shapes import Part, Ring, box, chain_weights, join, loft, stack

# along the foot from heel to toe: place, half width, top; in boot lengths and boot heights
_SHELL = (
    (-0.335, 0.50, 0.35),
    (-0.325, 0.78, 0.62),
    (-0.290, 0.93, 0.92),
    (-0.190, 0.98, 1.06),
    (-0.060, 0.98, 1.10),
    (0.070, 0.98, 1.04),
    (0.170, 1.00, 0.92),
    (0.270, 1.05, 0.78),
    (0.380, 1.10, 0.68),
    (0.480, 1.10, 0.64),
    (0.570, 1.00, 0.60),
    (0.625, 0.78, 0.50),
    (0.648, 0.52, 0.36),
)
_SHAFT = (
    (-0.036, 0.0290, 0.030, 0.034),
    (-0.024, 0.0345, 0.040, 0.043),
    (0.000, 0.0350, 0.0420, 0.044),
    (0.030, 0.0355, 0.0415, 0.043),
    (0.065, 0.0370, 0.0425, 0.044),
    (0.105, 0.0395, 0.0450, 0.047),
    (0.120, 0.0410, 0.0465, 0.049),
    (0.123, 0.0370, 0.0430, 0.045),
    (0.095, 0.0340, 0.0390, 0.041),
)


def boot_length(figure: Figure) -> float:
    """Return the length [m] that a boot's places are shares of."""
    return 0.152 * figure.h + 0.050


def boot_half_width(figure: Figure) -> float:
    """Return half the width [m] of a boot at the ankle."""
    return 0.0300 * figure.h + 0.007


def shell_size(figure: Figure, share: float) -> tuple[float, float]:
    """Return half width and height over the sole [m] of the shell at a `share` of its length before the ankle."""
    place, width, top = (np.array(column) for column in zip(*_SHELL, strict=True))
    low, floor = figure.sole - figure.z("foot.L"), _floor(figure)
    high = floor + float(np.interp(share, place, top)) * (0.030 * figure.h - floor)
    return float(np.interp(share, place, width)) * boot_half_width(figure), high - low


def soft_boots(figure: Figure) -> Part:
    """Return both boots."""
    left = _boot(figure)
    return join([left, left.mirrored()])


def _boot(figure: Figure) -> Part:
    lower = join([_shell(figure), _sole(figure), *_laces(figure)]).moved(figure.place["foot.L"]).bound("foot.L")
    return join([lower, _shaft(figure)])


def _floor(figure: Figure) -> float:
    return figure.sole - figure.z("foot.L") + 0.016


def _shell(figure: Figure) -> Part:
    length, half, floor = boot_length(figure), boot_half_width(figure), _floor(figure)
    top = 0.030 * figure.h
    rows = [arch(x * length, w * half, floor, floor + t * (top - floor)) for x, w, t in _SHELL]
    return loft(
        np.stack(rows), lambda row, column: "soft_boots_trim" if row == 9 and 2 <= column <= 9 else "soft_boots"
    )


def _sole(figure: Figure) -> Part:
    length, half = boot_length(figure), boot_half_width(figure)
    low = figure.sole - figure.z("foot.L")
    x = np.array([-0.34, -0.33, -0.25, 0.10, 0.30, 0.48, 0.60, 0.645, 0.655]) * length
    width = half * np.array([0.55, 0.78, 0.98, 0.98, 1.05, 1.10, 0.96, 0.70, 0.50])
    rows = [
        np.array([[a, -w, low], [a, -1.03 * w, low + 0.019], [a, 1.03 * w, low + 0.019], [a, w, low]])
        for a, w in zip(x, width, strict=True)
    ]
    return loft(np.stack(rows), "soft_boots_sole")


def _laces(figure: Figure) -> list[Part]:
    """Return bars of lace across the instep, from the toes up."""
    length, half, floor = boot_length(figure), boot_half_width(figure), _floor(figure)
    rise = 0.030 * figure.h - floor
    place, _, top = (np.array(column) for column in zip(*_SHELL, strict=True))
    bars = []
    for x in (0.36, 0.29, 0.22, 0.15):
        z = floor + float(np.interp(x, place, top)) * rise
        bars.append(box((0.008, 0.75 * half, 0.008), "laces", 0.6).moved((x * length, 0.0, z)))
    return bars


def _shaft(figure: Figure) -> Part:
    """Return the leg of the boot: it bends at the ankle, where a ski boot's cuff would turn."""
    h = figure.h
    ankle = figure.place["foot.L"]
    rings = [Ring(z * h, s * h, f * h, b * h, power=2.2) for z, s, f, b in _SHAFT]
    shaft = stack(rings, 18, lambda row, _column: "soft_boots_trim" if row >= 5 else "soft_boots", (True, False))
    part = shaft.moved(ankle)
    part.weights = chain_weights(part.vertices[:, 2], ("shank.L", "foot.L"), [float(ankle[2]) - 0.008 * h], [0.026 * h])
    return part
