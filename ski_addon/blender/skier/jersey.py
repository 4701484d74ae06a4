"""What a cyclist wears: jersey with short sleeves, shorts, bare arms and legs, socks."""

from __future__ import annotations

from .clothes import LIMB_POINTS, TRUNK_POINTS, arm_weights, leg_weights, limb_rings, seat, trunk_weights
from .figure import Figure
from .shapes import Part, Ring, chain_weights, dome, join, stack

# height above the pelvis, half width, depth in front and behind: closer than a jacket, longer behind
_TRUNK = (
    (-0.052, 0.090, 0.066, 0.071),
    (-0.062, 0.097, 0.074, 0.079),
    (-0.056, 0.098, 0.075, 0.080),
    (-0.030, 0.098, 0.076, 0.080),
    (0.010, 0.092, 0.071, 0.071),
    (0.055, 0.082, 0.062, 0.061),
    (0.090, 0.080, 0.060, 0.060),
    (0.130, 0.086, 0.064, 0.063),
    (0.175, 0.093, 0.068, 0.067),
    (0.200, 0.096, 0.069, 0.069),
    (0.222, 0.098, 0.068, 0.070),
    (0.250, 0.101, 0.064, 0.069),
    (0.275, 0.107, 0.058, 0.065),
    (0.297, 0.106, 0.050, 0.058),
    (0.311, 0.092, 0.043, 0.052),
    (0.321, 0.062, 0.039, 0.044),
    (0.328, 0.0400, 0.037, 0.038),
    (0.338, 0.0370, 0.037, 0.036),
    (0.340, 0.0345, 0.035, 0.034),
    (0.326, 0.0320, 0.032, 0.031),
)
_BAND_ROWS = (8, 9)
# share of the way from shoulder to wrist, half width, front, back
_ARM = (
    (0.00, 0.0300, 0.0340, 0.0355),
    (0.10, 0.0315, 0.0345, 0.0355),
    (0.24, 0.0300, 0.0325, 0.0335),
    (0.36, 0.0290, 0.0310, 0.0320),
    (0.40, 0.0290, 0.0310, 0.0320),
    (0.405, 0.0255, 0.0270, 0.0280),
    (0.48, 0.0240, 0.0250, 0.0265),
    (0.53, 0.0230, 0.0245, 0.0260),
    (0.56, 0.0230, 0.0245, 0.0260),
    (0.60, 0.0240, 0.0255, 0.0260),
    (0.68, 0.0240, 0.0255, 0.0255),
    (0.80, 0.0205, 0.0220, 0.0220),
    (0.92, 0.0170, 0.0185, 0.0185),
    (1.02, 0.0165, 0.0180, 0.0180),
)
_HEM_ARM, _BARE_ARM = 3, 4
# share of the way from hip to ankle, half width, front, back
_LEG = (
    (0.00, 0.0455, 0.0510, 0.060),
    (0.07, 0.0480, 0.0525, 0.062),
    (0.16, 0.0490, 0.0530, 0.059),
    (0.28, 0.0470, 0.0505, 0.052),
    (0.38, 0.0410, 0.0455, 0.044),
    (0.41, 0.0395, 0.0440, 0.0425),
    (0.415, 0.0375, 0.0420, 0.0405),
    (0.45, 0.0350, 0.0395, 0.0380),
    (0.50, 0.0335, 0.0380, 0.0360),
    (0.55, 0.0325, 0.0345, 0.0380),
    (0.64, 0.0335, 0.0325, 0.0430),
    (0.72, 0.0315, 0.0310, 0.0410),
    (0.80, 0.0260, 0.0270, 0.0325),
    (0.825, 0.0255, 0.0265, 0.0310),
    (0.83, 0.0268, 0.0278, 0.0323),
    (0.90, 0.0225, 0.0240, 0.0265),
    (0.96, 0.0210, 0.0225, 0.0250),
    (1.03, 0.0215, 0.0240, 0.0260),
)
_HEM_LEG, _BARE_LEG, _SOCK_LEG = 4, 5, 13


def jersey(figure: Figure) -> Part:
    """Return trunk with collar, both sleeves and the arms down to the wrists."""
    arm = _arm(figure)
    return join([_trunk(figure), arm, arm.mirrored()])


def shorts(figure: Figure) -> Part:
    """Return the seat, both legs of the shorts, and below them knees, calves and socks."""
    leg = _leg(figure)
    return join([seat(figure, 0.0), leg, leg.mirrored()])


def _trunk(figure: Figure) -> Part:
    h, base = figure.h, figure.z("pelvis")
    rings = []
    for z, side, front, back in _TRUNK:
        g = h * (1.0 if z > 0.30 else figure.girth)
        rings.append(Ring(base + z * h, side * g, front * g, back * g, power=2.4 if z < 0.29 else 2.1))
    part = stack(rings, TRUNK_POINTS, _trunk_material, (False, False), 0.05)
    part.weights = trunk_weights(figure, part.vertices)
    return part


def _trunk_material(row: int, column: int) -> str:
    if row < 2 or row >= 16 or column in (0, TRUNK_POINTS - 1):
        return "jacket_trim"
    return "jacket_accent" if row in _BAND_ROWS else "jacket"


def _arm(figure: Figure) -> Part:
    scale = figure.h * figure.girth
    rings = limb_rings(_ARM, figure.place["upper_arm.L"], figure.place["hand.L"], scale)
    cap = dome(rings[0], 0.018 * scale, 4)[::-1]

    def material(row: int, _column: int) -> str:
        row -= len(cap)
        return "skin" if row >= _BARE_ARM else "jacket_trim" if row == _HEM_ARM else "jacket"

    part = stack([*cap, *rings], LIMB_POINTS, material, (True, False))
    part.weights = arm_weights(figure, part.vertices)
    return part


def _leg(figure: Figure) -> Part:
    scale = figure.h * (0.5 + 0.5 * figure.girth)
    ankle = figure.place["foot.L"]
    rings = limb_rings(_LEG, figure.place["thigh.L"], ankle, scale)
    cap = dome(rings[0], 0.042 * figure.h, 4)[::-1]

    def material(row: int, column: int) -> str:
        row -= len(cap)
        if row >= _SOCK_LEG:
            return "socks"
        if row >= _BARE_LEG:
            return "skin"
        return "trousers_stripe" if row == _HEM_LEG or (column == 4 and row >= 0) else "trousers"

    part = stack([*cap, *rings], LIMB_POINTS, material, (True, False))
    part.weights = leg_weights(figure, part.vertices)
    foot = chain_weights(part.vertices[:, 2], ("shank.L", "foot.L"), [float(ankle[2])], [0.02 * figure.h])
    part.weights["foot.L"] = part.weights["shank.L"] * foot["foot.L"]
    part.weights["shank.L"] = part.weights["shank.L"] * foot["shank.L"]
    return part
