"""Head: face, helmet and goggles, all drawn in the head's frame (origin at the base of the neck, z up)."""

from __future__ import annotations

import numpy as np

from ...frames import Array
from .figure import Figure
from .shapes import Part, Ring, facing_out, join, loft, smooth_step, stack

# height, half width, front, back
_FACE = (
    (-0.030, 0.030, 0.026, 0.034),
    (-0.005, 0.029, 0.026, 0.033),
    (0.006, 0.029, 0.036, 0.036),
    (0.011, 0.033, 0.045, 0.042),
    (0.022, 0.038, 0.0495, 0.047),
    (0.034, 0.041, 0.0505, 0.050),
    (0.048, 0.043, 0.0500, 0.052),
    (0.066, 0.044, 0.0490, 0.053),
    (0.085, 0.044, 0.0500, 0.052),
    (0.105, 0.036, 0.0400, 0.040),
)
HELMET_CENTRE = np.array([-0.003, 0.0, 0.066])
HELMET_SIZE = {"front": 0.0655, "back": 0.0745, "side": 0.0590, "top": 0.0720}
AROUND = 36
GOGGLES_LOW, GOGGLES_HIGH, GOGGLES_HALF_ANGLE = 0.034, 0.085, np.deg2rad(74.0)


def head(figure: Figure) -> Part:
    """Return face, helmet and goggles with their strap, bound to the head."""
    return on_head(figure, [*face(), _helmet(), _visor(), _goggles(), _strap()])


def on_head(figure: Figure, parts: list[Part]) -> Part:
    """Return `parts`, drawn in shares of stature in the head's frame, where the head of `figure` is."""
    whole = join(parts)
    whole.vertices = whole.vertices * figure.h
    return whole.moved(figure.place["head"]).bound("head")


def face() -> list[Part]:
    """Return neck, face and nose, in shares of stature."""
    return [_face(), _nose()]


def _face() -> Part:
    rings = [Ring(z, side, front, back, x=0.004, power=2.2) for z, side, front, back in _FACE]
    return stack(rings, 20, "skin")


def _nose() -> Part:
    rings = [
        Ring(0.028, 0.0055, 0.004, 0.006, x=0.056),
        Ring(0.030, 0.0075, 0.0075, 0.006, x=0.055),
        Ring(0.036, 0.0065, 0.0060, 0.006, x=0.055),
        Ring(0.052, 0.0040, 0.0030, 0.006, x=0.053),
    ]
    return stack(rings, 8, "skin")


def helmet_surface(azimuth: Array, polar: Array, grow: float = 0.0) -> Array:
    """Return points (..., 3) of the helmet's shell, `polar` [rad] from its top, `azimuth` [rad] from the front.

    Below its widest line the shell draws in less than an ellipsoid would. `grow` is an offset outwards.
    """
    azimuth, polar = np.broadcast_arrays(azimuth, polar)
    size = {name: value + grow for name, value in HELMET_SIZE.items()}
    depth = np.where(np.cos(azimuth) >= 0.0, size["front"], size["back"])
    below = np.maximum(polar - 0.5 * np.pi, 0.0)
    across = np.where(below > 0.0, np.cos(0.55 * below), np.sin(polar) ** 0.9)
    x = depth * across * np.cos(azimuth)
    y = size["side"] * across * np.sin(azimuth)
    z = size["top"] * np.where(below > 0.0, -0.85 * np.sin(below), np.cos(polar))
    return np.stack((x, y, z), axis=-1) + HELMET_CENTRE


def _rim(azimuth: Array) -> Array:
    """Return the polar angle [rad] of the helmet's rim: high over the goggles, low over ears and neck."""
    turn = np.abs(np.angle(np.exp(1j * azimuth)))
    side = smooth_step(turn, np.deg2rad(56), np.deg2rad(84))
    back = smooth_step(turn, np.deg2rad(110), np.deg2rad(160))
    return np.deg2rad(77.0 + 63.0 * side - 12.0 * back)


def _helmet() -> Part:
    azimuth = np.linspace(0.0, 2.0 * np.pi, AROUND, endpoint=False)
    rim = _rim(azimuth)
    shares = (0.10, 0.25, 0.42, 0.58, 0.74, 0.88, 1.0)
    outer = [helmet_surface(azimuth, share * rim) for share in shares]
    lip = helmet_surface(azimuth, rim + 0.03, -0.003)
    inner = helmet_surface(azimuth, rim - 0.06, -0.009)
    deep = helmet_surface(azimuth, rim - 0.5, -0.010)
    rings = np.stack([*outer, lip, inner, deep])
    return loft(rings, _helmet_material, (True, False))


def _helmet_material(row: int, column: int) -> str:
    if row >= 5:
        return "helmet_trim"
    return "helmet_stripe" if column in (0, AROUND - 1, AROUND // 2, AROUND // 2 - 1) else "helmet"


def _visor() -> Part:
    """Return the small peak above the goggles."""
    azimuth = np.linspace(-0.95, 0.95, 9)
    rim = _rim(azimuth)
    root = helmet_surface(azimuth, rim - 0.10, 0.0005)
    reach = 0.011 * np.cos(azimuth / 0.95 * 0.5 * np.pi)[:, None] ** 0.6
    out = np.stack((np.cos(azimuth), np.sin(azimuth), np.full_like(azimuth, -0.15)), axis=-1)
    tip = helmet_surface(azimuth, rim + 0.02, 0.001) + out * reach
    under = helmet_surface(azimuth, rim + 0.02, -0.002)
    return grid(np.stack((root, tip, under)), "helmet_trim")


def grid(points: Array, material: str) -> Part:
    """Return an open sheet of quads through `points` (m, k, 3)."""
    rows, count = points.shape[:2]
    faces = [
        (r * count + c, r * count + c + 1, (r + 1) * count + c + 1, (r + 1) * count + c)
        for r in range(rows - 1)
        for c in range(count - 1)
    ]
    return facing_out(Part(points.reshape(-1, 3), faces, [material] * len(faces)))


def _goggle_point(angle: Array, height: float, grow: float) -> Array:
    """Return points of the goggles at `angle` [rad] to the side and `height` 0..1; the nose takes a notch below."""
    notch = 0.010 * np.exp(-((angle / 0.20) ** 2))
    taper = 0.006 * smooth_step(np.abs(angle), 0.75 * GOGGLES_HALF_ANGLE, GOGGLES_HALF_ANGLE)
    low, high = GOGGLES_LOW + notch + taper, GOGGLES_HIGH - taper
    z = low + height * (high - low)
    bulge = 0.004 * (1.0 - (2.0 * height - 1.0) ** 2)
    x = (0.0655 + grow + bulge) * np.cos(angle) ** 0.8
    y = (0.0560 + grow) * np.sin(angle)
    return np.stack((x, y, z), axis=-1)


def _goggles() -> Part:
    angle = np.linspace(-GOGGLES_HALF_ANGLE, GOGGLES_HALF_ANGLE, 17)
    rows = (
        _goggle_point(angle, 0.02, -0.012),
        _goggle_point(angle, 0.0, 0.003),
        _goggle_point(angle, 0.10, 0.0045),
        _goggle_point(angle, 0.16, 0.0025),
        _goggle_point(angle, 0.38, 0.0025),
        _goggle_point(angle, 0.62, 0.0025),
        _goggle_point(angle, 0.84, 0.0025),
        _goggle_point(angle, 0.90, 0.0045),
        _goggle_point(angle, 1.0, 0.003),
        _goggle_point(angle, 0.98, -0.012),
    )
    part = grid(np.stack(rows), "goggles_frame")
    columns = len(angle) - 1
    part.materials = [
        "goggles_lens" if 3 <= i // columns <= 5 and 1 <= i % columns < columns - 1 else "goggles_frame"
        for i in range(len(part.faces))
    ]
    return part


def _strap() -> Part:
    azimuth = np.linspace(np.deg2rad(66), np.deg2rad(294), 25)
    rise = 0.010 * np.sin((azimuth - azimuth[0]) / (azimuth[-1] - azimuth[0]) * np.pi)
    rows = []
    for height, grow in ((0.050, 0.0), (0.050, 0.0025), (0.069, 0.0025), (0.069, 0.0)):
        rows.append(_helmet_at_height(azimuth, height + rise, grow))
    return grid(np.stack(rows), "goggles_strap")


def _helmet_at_height(azimuth: Array, height: Array, grow: float) -> Array:
    above = height - HELMET_CENTRE[2]
    polar = np.where(
        above >= 0.0,
        np.arccos(np.clip(above / HELMET_SIZE["top"], -1.0, 1.0)),
        0.5 * np.pi + np.arcsin(np.clip(-above / (0.85 * HELMET_SIZE["top"]), -1.0, 1.0)),
    )
    return helmet_surface(azimuth, polar, grow)
