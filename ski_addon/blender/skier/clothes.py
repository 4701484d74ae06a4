"""Jacket and trousers. Sizes are shares of stature, cut for a slim adult and widened by the figure's girth."""

from __future__ import annotations

import numpy as np

from ...frames import Array
from .figure import Figure
from .shapes import Part, Ring, chain_weights, dome, join, smooth_step, stack

TRUNK_POINTS = 28
LIMB_POINTS = 16

# height above the pelvis, half width, depth in front and behind: from inside the hem to inside the collar
_TRUNK = (
    (-0.040, 0.094, 0.070, 0.073),
    (-0.066, 0.106, 0.082, 0.081),
    (-0.070, 0.111, 0.088, 0.087),
    (-0.061, 0.113, 0.090, 0.089),
    (-0.053, 0.112, 0.089, 0.088),
    (-0.020, 0.107, 0.083, 0.084),
    (0.020, 0.096, 0.073, 0.073),
    (0.055, 0.085, 0.064, 0.064),
    (0.090, 0.086, 0.065, 0.064),
    (0.130, 0.092, 0.070, 0.067),
    (0.175, 0.098, 0.073, 0.071),
    (0.215, 0.101, 0.073, 0.074),
    (0.222, 0.101, 0.0722, 0.0737),
    (0.250, 0.104, 0.068, 0.072),
    (0.275, 0.110, 0.061, 0.068),
    (0.297, 0.109, 0.053, 0.061),
    (0.311, 0.094, 0.045, 0.054),
    (0.321, 0.066, 0.042, 0.047),
    (0.328, 0.0475, 0.043, 0.043),
    (0.347, 0.0450, 0.047, 0.041),
    (0.351, 0.042, 0.044, 0.038),
    (0.345, 0.039, 0.041, 0.035),
    (0.325, 0.037, 0.039, 0.034),
)
_HEM_ROWS, _YOKE_ROW, _ACCENT_ROW = 4, 12, 11
LOOSE = {"snowboard": 0.09}
"""By kind of figure, how much wider than a ski jacket theirs is at the hips."""
_ZIP_WIDTH = 0.05
"""Half width of the zip, as an angle round the trunk [rad]."""

# share of the way from shoulder to wrist, half width, front, back; the last rows turn the cuff in
_SLEEVE = (
    (0.00, 0.0310, 0.0355, 0.0365),
    (0.10, 0.0335, 0.0365, 0.0375),
    (0.24, 0.0333, 0.0350, 0.0365),
    (0.28, 0.0328, 0.0343, 0.0358),
    (0.37, 0.0315, 0.0325, 0.034),
    (0.47, 0.0300, 0.0310, 0.032),
    (0.53, 0.0295, 0.0305, 0.032),
    (0.56, 0.0295, 0.0305, 0.032),
    (0.60, 0.0300, 0.0310, 0.032),
    (0.68, 0.0300, 0.0310, 0.031),
    (0.80, 0.0275, 0.0290, 0.029),
    (0.90, 0.0255, 0.0270, 0.027),
    (0.935, 0.0262, 0.0278, 0.0278),
    (0.975, 0.0258, 0.0275, 0.0275),
    (0.985, 0.0235, 0.0250, 0.0250),
    (0.950, 0.0215, 0.0230, 0.0230),
)
# share of the way from hip to ankle, half width, front, back
_LEG = (
    (0.00, 0.0470, 0.0530, 0.062),
    (0.07, 0.0500, 0.0545, 0.064),
    (0.16, 0.0525, 0.0560, 0.062),
    (0.28, 0.0525, 0.0545, 0.056),
    (0.38, 0.0480, 0.0520, 0.050),
    (0.45, 0.0450, 0.0495, 0.046),
    (0.50, 0.0440, 0.0490, 0.045),
    (0.55, 0.0440, 0.0475, 0.046),
    (0.62, 0.0450, 0.0460, 0.049),
    (0.70, 0.0465, 0.0465, 0.052),
    (0.78, 0.0475, 0.0480, 0.053),
    (0.845, 0.0490, 0.0510, 0.054),
    (0.865, 0.0495, 0.0520, 0.0545),
    (0.870, 0.0470, 0.0490, 0.0520),
    (0.840, 0.0440, 0.0460, 0.0490),
)
_PELVIS = (
    (-0.078, 0.030, 0.026, 0.036),
    (-0.070, 0.055, 0.045, 0.056),
    (-0.055, 0.078, 0.058, 0.071),
    (-0.035, 0.090, 0.064, 0.077),
    (-0.010, 0.091, 0.065, 0.074),
    (0.020, 0.085, 0.062, 0.066),
    (0.050, 0.078, 0.057, 0.058),
)


def jacket(figure: Figure) -> Part:
    """Return trunk with hem and collar, and both sleeves."""
    sleeve = _sleeve(figure)
    return join([_trunk(figure), sleeve, sleeve.mirrored()])


def trousers(figure: Figure) -> Part:
    """Return the seat and both legs, down to the hems over the boots."""
    leg = _leg(figure)
    return join([seat(figure), leg, leg.mirrored()])


def _trunk(figure: Figure) -> Part:
    h, girth = figure.h, figure.girth
    base = figure.z("pelvis")
    loose = LOOSE.get(figure.kind, 0.0)  # at the hem, none at the chest
    widths = [1.0 if z > 0.30 else girth * (1.0 + loose * np.clip(1.0 - z / 0.15, 0.0, 1.0)) for z, *_ in _TRUNK]
    rings = [
        Ring(base + z * h, side * h * g, front * h * g, back * h * g, power=2.5 if z < 0.29 else 2.1)
        for (z, side, front, back), g in zip(_TRUNK, widths, strict=True)
    ]
    part = stack(rings, TRUNK_POINTS, _trunk_material, (False, False), _ZIP_WIDTH)
    part.weights = trunk_weights(figure, part.vertices)
    return part


def _trunk_material(row: int, column: int) -> str:
    if row < _HEM_ROWS or column in (0, TRUNK_POINTS - 1):
        return "jacket_trim"
    if row >= _YOKE_ROW:
        return "jacket_yoke"
    return "jacket_accent" if row == _ACCENT_ROW else "jacket"


def trunk_weights(figure: Figure, vertices: Array) -> dict[str, Array]:
    """Return the weights of a jacket's trunk: the spine, the hem on the thighs, the shoulders on the arms."""
    h = figure.h
    z = vertices[:, 2]
    joints = [figure.z("abdomen"), figure.z("chest")]
    weights = chain_weights(z, ("pelvis", "abdomen", "chest"), joints, (0.06 * h, 0.06 * h), rising=True)
    hem = 0.8 * smooth_step(z, figure.z("thigh.L") + 0.045 * h, figure.z("thigh.L") - 0.04 * h)
    hem = hem * smooth_step(vertices[:, 0], -0.055 * h, 0.045 * h)  # the front of the hem rides up on the thighs
    left = smooth_step(vertices[:, 1], -0.05 * h, 0.05 * h)
    shoulder = (
        0.6
        * smooth_step(np.abs(vertices[:, 1]), 0.05 * h, 0.11 * h)
        * smooth_step(z, figure.z("upper_arm.L") - 0.07 * h, figure.z("upper_arm.L"))
    )
    for side, share in (("L", left), ("R", 1.0 - left)):
        weights[f"thigh.{side}"] = hem * share * weights["pelvis"]
        weights[f"upper_arm.{side}"] = shoulder * share * weights["chest"]
    weights["pelvis"] = weights["pelvis"] * (1.0 - hem)
    weights["chest"] = weights["chest"] * (1.0 - shoulder)
    return weights


def limb_rings(
    rows: tuple[tuple[float, float, float, float], ...], top: Array, bottom: Array, scale: float, x: float = 0.0
) -> list[Ring]:
    """Return rings along a limb from `top` to `bottom` (3,) [m]; `rows` of share of the way, side, front, back."""
    return [
        Ring(
            float(top[2] + share * (bottom[2] - top[2])),
            side * scale,
            front * scale,
            back * scale,
            x=float(top[0] + share * (bottom[0] - top[0])) + x,
            y=float(top[1] + share * (bottom[1] - top[1])),
        )
        for share, side, front, back in rows
    ]


def _sleeve(figure: Figure) -> Part:
    h = figure.h
    shoulder, wrist = (figure.place[name] for name in ("upper_arm.L", "hand.L"))
    rings = limb_rings(_SLEEVE, shoulder, wrist, h * figure.girth)
    cap = dome(rings[0], 0.019 * h * figure.girth, 4)[::-1]
    part = stack(
        [*cap, *rings], LIMB_POINTS, lambda row, column: _sleeve_material(row - len(cap), column), (True, False)
    )
    part.weights = arm_weights(figure, part.vertices)
    return part


def arm_weights(figure: Figure, vertices: Array) -> dict[str, Array]:
    """Return the weights of a left sleeve."""
    h, shoulder = figure.h, figure.z("upper_arm.L")
    z = vertices[:, 2]
    weights = chain_weights(z, ("upper_arm.L", "forearm.L"), [figure.z("forearm.L")], [0.035 * h])
    chest = 0.4 * smooth_step(z, shoulder - 0.02 * h, shoulder + 0.035 * h)
    weights["upper_arm.L"] = weights["upper_arm.L"] * (1.0 - chest)
    weights["chest"] = chest
    return weights


def _sleeve_material(row: int, column: int) -> str:
    if row >= 11:
        return "jacket_trim"
    if row < 2:
        return "jacket_yoke"
    if row == 2:
        return "jacket_accent"
    return "jacket"


def _leg(figure: Figure) -> Part:
    h = figure.h
    hip, ankle = (figure.place[name] for name in ("thigh.L", "foot.L"))
    rings = limb_rings(_LEG, hip, ankle, h * (0.5 + 0.5 * figure.girth))
    cap = dome(rings[0], 0.044 * h, 4)[::-1]
    part = stack([*cap, *rings], LIMB_POINTS, _leg_material, (True, False))
    part.weights = leg_weights(figure, part.vertices)
    return part


def leg_weights(figure: Figure, vertices: Array) -> dict[str, Array]:
    """Return the weights of a left trouser leg."""
    h, hip = figure.h, figure.z("thigh.L")
    z = vertices[:, 2]
    weights = chain_weights(z, ("thigh.L", "shank.L"), [figure.z("shank.L")], [0.04 * h])
    pelvis = 0.5 * smooth_step(z, hip - 0.01 * h, hip + 0.05 * h)
    weights["thigh.L"] = weights["thigh.L"] * (1.0 - pelvis)
    weights["pelvis"] = pelvis
    return weights


def _leg_material(row: int, column: int) -> str:
    if row >= 16:
        return "trousers_trim"
    return "trousers_stripe" if column == 4 and row >= 4 else "trousers"


def seat(figure: Figure, top: float = 1.0) -> Part:
    """Return the seat of the trousers, up to `top` [statures over the pelvis] at most."""
    h, girth = figure.h, figure.girth
    base = figure.z("pelvis")
    rows = [row for row in _PELVIS if row[0] <= top]
    rings = [Ring(base + z * h, s * h * girth, f * h * girth, b * h * girth, power=2.3) for z, s, f, b in rows]
    return stack(rings, TRUNK_POINTS, "trousers").bound("pelvis")
