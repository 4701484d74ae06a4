"""A bicycle saddle: wide behind, a long nose, its top's middle over the seat post at the origin."""

from __future__ import annotations

import numpy as np

from .shapes import Part, box, join, loft
from .tubes import tube

# forward of the post, half width, height of the top, thickness
_SECTIONS = (
    (-0.135, 0.030, 0.006, 0.018),
    (-0.128, 0.055, 0.010, 0.030),
    (-0.100, 0.070, 0.010, 0.040),
    (-0.060, 0.066, 0.004, 0.042),
    (-0.015, 0.046, 0.000, 0.038),
    (0.030, 0.030, 0.000, 0.034),
    (0.080, 0.022, 0.000, 0.030),
    (0.118, 0.018, -0.002, 0.026),
    (0.130, 0.010, -0.007, 0.016),
)


def saddle() -> Part:
    """Return the saddle with its rails and clamp, nose forward."""
    rings = []
    for x, half, top, thick in _SECTIONS:
        y = half * np.array([-1.0, -0.97, -0.75, -0.35, 0.35, 0.75, 0.97, 1.0, 0.6, -0.6])
        z = top - thick * np.array([0.75, 0.35, 0.10, 0.0, 0.0, 0.10, 0.35, 0.75, 1.0, 1.0])
        rings.append(np.column_stack((np.full(10, x), y, z)))
    shell = loft(np.stack(rings), "saddle")
    rails = [
        tube(
            [(-0.085, 1.4 * y, -0.034), (-0.05, y, -0.052), (0.04, y, -0.052), (0.09, 0.5 * y, -0.024)],
            0.0035,
            "bicycle_metal",
            6,
        )
        for y in (0.02, -0.02)
    ]
    return join([shell, *rails, box((0.05, 0.05, 0.016), "bicycle_parts", 0.3).moved((0.0, 0.0, -0.052))])
