"""The skier's surface as capsules, each a line with a radius, to tell how near parts of the body come to each other.

They hold the drawn skier in: clothes, gloves, boots, helmet.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ..body.skeleton import SIDES, Skeleton

Point = tuple[float, float, float]
_TRUNK = {  # part: (ends in statures in the body's frame, radius in statures)
    "pelvis": (((0.0, -0.028, -0.004), (0.0, 0.028, -0.004), 0.068),),
    "abdomen": (((0.0, -0.022, 0.03), (0.0, 0.022, 0.03), 0.064), ((0.0, -0.022, 0.07), (0.0, 0.022, 0.07), 0.064)),
    "chest": (((0.0, -0.038, 0.045), (0.0, 0.038, 0.045), 0.064), ((0.0, -0.034, 0.105), (0.0, 0.034, 0.105), 0.062)),
    "head": (((-0.003, 0.0, 0.035), (-0.003, 0.0, 0.066), 0.073),),
}
_LIMBS = {"upper_arm": 0.034, "forearm": 0.031, "thigh": 0.053, "shank": 0.048}
"""Radius of a part that reaches from its frame down to the next joint [statures]."""
_HAND, _BOOT = 0.030, 0.040
POLE_RADIUS = 0.008
"""Half the thickness of a ski pole [m]."""


@dataclass(frozen=True, eq=False)
class Capsules:
    """c lines in body frames: `body` (c,) index, `first`, `last` (c, 3) [m] their ends, `radius` (c,) [m]."""

    body: np.ndarray
    first: np.ndarray
    last: np.ndarray
    radius: np.ndarray

    def ends(self, position: np.ndarray, rotation: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the ends (n, c, 3) [m, world] of bodies at `position` (n, 20, 3) with `rotation` (n, 20, 3, 3)."""
        at, turn = position[:, self.body], rotation[:, self.body]
        return at + np.einsum("ncij,cj->nci", turn, self.first), at + np.einsum("ncij,cj->nci", turn, self.last)

    def of(self, bodies: Sequence[int]) -> np.ndarray:
        """Return the indices of the capsules of `bodies`."""
        return np.flatnonzero(np.isin(self.body, bodies))


def skier_capsules(skeleton: Skeleton) -> Capsules:
    """Return the capsules of all 20 bodies."""
    lines: list[tuple[int, Point, Point, float]] = []
    h, lengths = skeleton.height, skeleton.lengths
    for part, shapes in _TRUNK.items():
        lines += [(skeleton.body(part), _scaled(a, h), _scaled(b, h), r * h) for a, b, r in shapes]
    half = 0.5 * (skeleton.ski_length - skeleton.ski_width)
    for side in SIDES:
        for part, radius in _LIMBS.items():
            lines.append((skeleton.body(f"{part}.{side}"), (0.0, 0.0, 0.0), (0.0, 0.0, -lengths[part]), radius * h))
        hand = lengths["hand"]
        lines += [
            (skeleton.body(f"hand.{side}"), (0.0, 0.0, -0.15 * hand), (0.0, 0.0, -0.5 * hand), _HAND * h),
            (skeleton.body(f"pole.{side}"), (0.0, 0.0, 0.0), (0.0, 0.0, -skeleton.pole_length), POLE_RADIUS),
            (skeleton.body(f"foot.{side}"), (-0.025 * h, 0.0, -0.02 * h), (0.08 * h, 0.0, -0.02 * h), _BOOT * h),
            (skeleton.body(f"ski.{side}"), (-half, 0.0, 0.0), (half, 0.0, 0.0), 0.5 * skeleton.ski_width),
        ]
    bodies, firsts, lasts, radii = (np.array(column) for column in zip(*lines, strict=True))
    return Capsules(bodies, firsts, lasts, radii)


def _scaled(point: Point, scale: float) -> Point:
    return point[0] * scale, point[1] * scale, point[2] * scale


def segment_distances(p: np.ndarray, q: np.ndarray, r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the least distances (...) [m] of the lines from `p` to `q` and from `r` to `s` (..., 3) [m].

    A line may be a point [Ericson 2005, Real-Time Collision Detection, section 5.1.9].
    """
    d, e, away = q - p, s - r, p - r
    dd, ee, de = _dot(d, d), _dot(e, e), _dot(d, e)
    da, ea = _dot(d, away), _dot(e, away)
    tiny = 1e-12
    area = dd * ee - de * de
    on_first = np.where(area > tiny * dd * ee, (de * ea - da * ee) / np.where(area > 0.0, area, 1.0), 0.0)
    on_first = np.clip(on_first, 0.0, 1.0)
    on_second = np.clip((de * on_first + ea) / np.maximum(ee, tiny), 0.0, 1.0)
    on_first = np.clip((de * on_second - da) / np.maximum(dd, tiny), 0.0, 1.0)
    return np.linalg.norm(away + on_first[..., None] * d - on_second[..., None] * e, axis=-1)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i->...", a, b)
