"""Gloves closed around the grips. Drawn for a hanging hand: fingers down, thumb forward, palm towards the thigh."""

from __future__ import annotations

from dataclasses import replace

from ...frames import rotation_about
from .figure import Figure
from .shapes import Part, Ring, dome, join, stack

# height below the wrist, half width across the palm (side), front, back, shift inwards; in hand lengths
_FIST = (
    (0.27, 0.225, 0.245, 0.245, 0.00),
    (0.28, 0.275, 0.292, 0.292, 0.00),
    (0.22, 0.285, 0.302, 0.302, 0.00),
    (0.00, 0.245, 0.265, 0.265, 0.00),
    (-0.10, 0.190, 0.220, 0.220, 0.00),
    (-0.20, 0.185, 0.260, 0.235, 0.02),
    (-0.34, 0.190, 0.320, 0.275, 0.04),
    (-0.50, 0.205, 0.340, 0.295, 0.05),
    (-0.64, 0.200, 0.325, 0.285, 0.05),
    (-0.72, 0.165, 0.280, 0.245, 0.05),
    (-0.76, 0.080, 0.160, 0.140, 0.05),
)
_THIN_FIST = (
    (0.02, 0.185, 0.200, 0.200, 0.00),
    (0.03, 0.210, 0.226, 0.226, 0.00),
    (-0.03, 0.205, 0.222, 0.222, 0.00),
    (-0.05, 0.190, 0.210, 0.210, 0.00),
    *_FIST[4:],
)


def gloves(figure: Figure) -> Part:
    """Return both gloves, bound to the hands."""
    return _both(_glove(figure.skeleton.lengths["hand"]), figure)


def thin_gloves(figure: Figure) -> Part:
    """Return both gloves of a cyclist: closed as a skier's, but thin and with a short cuff, bound to the hands."""
    size = figure.skeleton.lengths["hand"]
    hand = _glove(size, _THIN_FIST)
    return _both(replace(hand, vertices=hand.vertices * (0.80, 0.80, 0.97)), figure)


def _both(left: Part, figure: Figure) -> Part:
    left = left.moved(figure.place["hand.L"]).bound("hand.L")
    return join([left, left.mirrored()])


def _glove(size: float, rows: tuple[tuple[float, ...], ...] = _FIST) -> Part:
    rings = [
        Ring(z * size, side * size, front * size, back * size, y=-inward * size, power=2.6)
        for z, side, front, back, inward in rows
    ]
    fist = stack(rings, 14, lambda row, _column: "gloves_cuff" if row < 3 else "gloves")
    return join([fist, _thumb(size), *_knuckles(size)])


def _thumb(size: float) -> Part:
    """Return the thumb, laid over the grip at the front of the fist and pointing inwards."""
    ring = Ring(0.0, 0.085 * size, 0.085 * size, 0.085 * size)
    rows = [ring.scaled(0.85, 0.0), ring.scaled(1.05, -0.14 * size), ring.scaled(1.0, -0.28 * size)]
    tip = dome(rows[-1], -0.08 * size, 3)
    thumb = stack([*rows, *tip], 8, "gloves")
    tilt = rotation_about("x", -0.55) @ rotation_about("y", -0.35)
    return thumb.turned(tilt).moved((0.22 * size, 0.05 * size, -0.27 * size))


def _knuckles(size: float) -> list[Part]:
    """Return four rounded finger backs across the fist's lower outer edge."""
    parts = []
    for index in range(4):
        ring = Ring(0.0, 0.062 * size, 0.075 * size, 0.075 * size, power=2.4)
        rows = [ring.scaled(0.8, 0.02 * size), ring, replace(ring, z=-0.16 * size)]
        finger = stack([*dome(rows[0], 0.03 * size, 2)[::-1], *rows, *dome(rows[-1], -0.07 * size, 2)], 8, "gloves")
        x = (0.215 - 0.145 * index) * size
        parts.append(finger.moved((x, 0.125 * size, -0.52 * size)))
    return parts


# as _FIST, for an open hand in a mitten
_MITTEN = (
    (0.27, 0.225, 0.245, 0.245, 0.00),
    (0.28, 0.275, 0.292, 0.292, 0.00),
    (0.22, 0.285, 0.302, 0.302, 0.00),
    (0.00, 0.245, 0.265, 0.265, 0.00),
    (-0.10, 0.175, 0.215, 0.220, 0.00),
    (-0.22, 0.160, 0.250, 0.250, 0.02),
    (-0.42, 0.155, 0.275, 0.265, 0.04),
    (-0.62, 0.145, 0.270, 0.260, 0.07),
    (-0.82, 0.125, 0.250, 0.235, 0.12),
    (-0.96, 0.100, 0.200, 0.185, 0.17),
    (-1.03, 0.060, 0.110, 0.105, 0.20),
)


def mittens(figure: Figure) -> Part:
    """Return both mittens, the fingers a little bent, bound to the hands."""
    size = figure.skeleton.lengths["hand"]
    rings = [
        Ring(z * size, side * size, front * size, back * size, y=-inward * size, power=2.4)
        for z, side, front, back, inward in _MITTEN
    ]
    hand = stack(rings, 14, lambda row, _column: "gloves_cuff" if row < 3 else "gloves")
    ring = Ring(0.0, 0.095 * size, 0.095 * size, 0.095 * size)
    rows = [ring.scaled(0.8, 0.02 * size), ring.scaled(1.1, -0.16 * size), ring.scaled(1.0, -0.32 * size)]
    thumb = stack([*rows, *dome(rows[-1], -0.08 * size, 3)], 8, "gloves")
    tilt = rotation_about("x", -0.35) @ rotation_about("y", -0.40)
    return _both(join([hand, thumb.turned(tilt).moved((0.20 * size, -0.04 * size, -0.24 * size))]), figure)
