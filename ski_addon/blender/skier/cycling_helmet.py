"""A cyclist's head: a light helmet of ribs over a dark shell, straps under the chin, and glasses."""

from __future__ import annotations

import numpy as np

from ...frames import Array
from .figure import Figure
from .head import face, grid, helmet_surface, on_head
from .shapes import Part, loft
from .tubes import tube

_AROUND = 36
_RIBS = (0.38, 0.72)
"""Where the ribs beside the middle one run, as shares of the helmet's half width."""
_LENS_LOW, _LENS_HIGH, _LENS_HALF_ANGLE = 0.047, 0.074, np.deg2rad(62.0)


def cyclist_head(figure: Figure) -> Part:
    """Return face, helmet and glasses, bound to the head."""
    return on_head(figure, [*face(), _shell(), *_ribs(), _rim(), _glasses(), *_arms(), *_straps()])


def _rim_angle(azimuth: Array) -> Array:
    """Return the polar angle [rad] of the helmet's rim: over the brow, a little lower behind."""
    return np.deg2rad(84.0 + 14.0 * (0.5 - 0.5 * np.cos(azimuth)))


def _shell() -> Part:
    azimuth = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    rim = _rim_angle(azimuth)
    rings = [helmet_surface(azimuth, share * rim, -0.004) for share in (0.12, 0.35, 0.58, 0.80, 1.0)]
    rings.append(helmet_surface(azimuth, rim - 0.05, -0.014))
    return loft(np.stack(rings), "helmet_trim", (True, False))


def _ribs() -> list[Part]:
    """Return bars from the brow over the top to the nape."""
    left = [_rib(share) for share in _RIBS]
    return [_rib(0.0), *left, *(rib.mirrored() for rib in left)]


def _rib(share: float) -> Part:
    """Return the bar that starts and ends beside the middle by that `share` of the helmet's half width."""
    line = []
    front = float(np.arcsin(0.9 * share))
    side = float(np.arcsin(0.62 * share))
    for along in np.linspace(-1.0, 1.0, 19):
        azimuth = front if along > 0.0 else np.pi - front
        polar = abs(along) * float(_rim_angle(np.array(azimuth)))
        line.append(_over(azimuth, polar, side))
    radius = 0.0085 * np.sqrt(np.clip(1.35 - np.linspace(-1.0, 1.0, 19) ** 2, 0.15, 1.0))
    return tube(line, radius, "helmet", 8)


def _over(azimuth: float, polar: float, side: float) -> Array:
    """Return a point of the shell on a rib that passes the top at the angle `side` [rad] beside its middle."""
    direction = np.array(
        [
            np.sin(polar) * np.cos(azimuth),
            np.sin(polar) * np.sin(azimuth) + np.sin(side) * (1.0 - np.sin(polar)),
            np.cos(polar),
        ]
    )
    direction /= np.linalg.norm(direction)
    around = np.arctan2(direction[1], direction[0])
    return helmet_surface(np.array(around), np.array(np.arccos(direction[2])), 0.0005)


def _rim() -> Part:
    """Return the band round the helmet that the ribs end in."""
    azimuth = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
    line = helmet_surface(azimuth, _rim_angle(azimuth) - 0.04, 0.0)
    return tube(line, 0.0075, "helmet", 8, closed=True)


def _lens(angle: Array, height: float, grow: float) -> Array:
    notch = 0.012 * np.exp(-((angle / 0.16) ** 2))
    taper = 0.007 * np.clip((np.abs(angle) / _LENS_HALF_ANGLE - 0.4) / 0.6, 0.0, 1.0) ** 2
    low, high = _LENS_LOW + notch + taper, _LENS_HIGH - 0.4 * taper
    x = (0.0610 + grow) * np.cos(angle) ** 0.8
    y = (0.0480 + grow) * np.sin(angle)
    return np.stack((x, y, np.broadcast_to(low + height * (high - low), x.shape)), axis=-1)


def _glasses() -> Part:
    angle = np.linspace(-_LENS_HALF_ANGLE, _LENS_HALF_ANGLE, 17)
    rows = [_lens(angle, 0.0, -0.004), _lens(angle, 0.0, 0.0), _lens(angle, 0.5, 0.001), _lens(angle, 0.9, 0.0)]
    rows += [_lens(angle, 0.92, 0.0015), _lens(angle, 1.06, 0.0015), _lens(angle, 1.06, -0.004)]
    part = grid(np.stack(rows), "goggles_lens")
    columns = len(angle) - 1
    part.materials = ["goggles_lens" if i // columns < 3 else "goggles_frame" for i in range(len(part.faces))]
    return part


def _arms() -> list[Part]:
    """Return the glasses' arms, back to the ears."""
    start = _lens(np.array(_LENS_HALF_ANGLE), 0.95, 0.0)
    arm = tube([start, (0.000, 0.0475, 0.070), (-0.020, 0.0470, 0.066)], 0.0022, "goggles_frame", 6)
    return [arm, arm.mirrored()]


def _straps() -> list[Part]:
    """Return the straps from before and behind each ear to the chin."""
    joint, chin = np.array([0.004, 0.0475, 0.030]), np.array([0.030, 0.0, 0.0005])
    left = [
        tube([(0.026, 0.0500, 0.062), joint], 0.0016, "helmet_trim", 6),
        tube([(-0.030, 0.0520, 0.058), joint], 0.0016, "helmet_trim", 6),
        tube([joint, (0.020, 0.040, 0.012), chin], 0.0018, "helmet_trim", 6),
    ]
    return [*left, *(strap.mirrored() for strap in left)]
