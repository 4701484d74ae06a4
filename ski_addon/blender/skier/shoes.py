"""A cyclist's shoes: low, with a stiff sole and two straps; the sock and the leg come out of them."""

from __future__ import annotations

import numpy as np

from ...frames import Array
from .boots import arch
from .figure import Figure
from .shapes import Part, join, loft

# along the foot from heel to toe: place, half width, top; in shoe lengths, and in heights from sole to ankle
_UPPER = (
    (-0.290, 0.45, 0.28),
    (-0.282, 0.66, 0.60),
    (-0.250, 0.80, 0.92),
    (-0.170, 0.86, 1.02),
    (-0.060, 0.86, 0.95),
    (0.040, 0.86, 0.96),
    (0.120, 0.87, 0.90),
    (0.220, 0.92, 0.72),
    (0.330, 0.98, 0.57),
    (0.440, 1.00, 0.47),
    (0.540, 0.92, 0.40),
    (0.610, 0.72, 0.33),
    (0.640, 0.45, 0.24),
)
_SOLE_THICKNESS = 0.012


def shoe_length(figure: Figure) -> float:
    """Return the length [m] that a shoe's places are shares of."""
    return 0.152 * figure.h + 0.028


def ball_of(figure: Figure, side: str) -> Array:
    """Return the place (3,) [m] on the sole below the foot's ball, in the frame of the foot on that `side`."""
    return np.array([figure.sizes["ball_forward"], 0.0, figure.sole - figure.z(f"foot.{side}")])


def shoes(figure: Figure) -> Part:
    """Return both shoes, bound to the feet."""
    left = join([_upper(figure), _sole(figure), *_straps(figure)]).moved(figure.place["foot.L"]).bound("foot.L")
    return join([left, left.mirrored()])


def _measures(figure: Figure) -> tuple[float, float, float, float]:
    """Return length, half width, height of the sole's top and of the ankle opening, from the ankle [m]."""
    floor = figure.sole - figure.z("foot.L") + _SOLE_THICKNESS
    return shoe_length(figure), 0.0255 * figure.h + 0.006, floor, 0.012 * figure.h


def _upper(figure: Figure) -> Part:
    length, half, floor, top = _measures(figure)
    rows = [arch(x * length, w * half, floor, floor + t * (top - floor)) for x, w, t in _UPPER]
    return loft(
        np.stack(rows), lambda row, column: "shoes_trim" if row < 3 or (row == 4 and 4 <= column <= 7) else "shoes"
    )


def _sole(figure: Figure) -> Part:
    length, half, floor, _ = _measures(figure)
    low = floor - _SOLE_THICKNESS
    x = np.array([-0.288, -0.28, -0.22, -0.05, 0.15, 0.40, 0.55, 0.625, 0.645]) * length
    width = half * np.array([0.45, 0.66, 0.80, 0.72, 0.80, 1.00, 0.90, 0.62, 0.42])
    rows = [
        np.array([[a, -0.94 * w, low], [a, -w, floor + 0.003], [a, w, floor + 0.003], [a, 0.94 * w, low]])
        for a, w in zip(x, width, strict=True)
    ]
    return loft(np.stack(rows), "shoes_sole")


def _straps(figure: Figure) -> list[Part]:
    length, half, floor, top = _measures(figure)
    place, width, height = (np.array(column) for column in zip(*_UPPER, strict=True))
    parts = []
    for x in (0.10, 0.28):
        rows = []
        for shift, grow in ((-0.040, 0.99), (-0.034, 1.05), (0.034, 1.05), (0.040, 0.99)):
            w, t = (float(np.interp(x + shift, place, column)) for column in (width, height))
            rows.append(arch((x + shift) * length, grow * w * half, floor, floor + grow * t * (top - floor)))
        parts.append(loft(np.stack(rows), "shoes_trim", (False, False)))
    return parts
