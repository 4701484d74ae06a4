"""How near hands, arms and poles come to the rest of the skier, and to the snow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..body.skeleton import SIDES, Skeleton
from ..terrain import Terrain
from .capsules import Capsules, segment_distances, skier_capsules

ARM = ("upper_arm", "forearm", "hand", "pole")
"""Parts whose distances are measured: against everything but the neighbours they hang on."""
_JOINED = {("forearm", "pole")}
"""Parts of one side that are held by the same third one, besides a part and what it hangs on."""


@dataclass(frozen=True)
class Nearness:
    """Least distances over a run [m], negative where surfaces pass through each other.

    `pairs` by names of two bodies; `snow` by name of a body; poles' tips and skis against snow are not among them.
    """

    pairs: dict[tuple[str, str], float]
    snow: dict[str, float]


def measure_nearness(skeleton: Skeleton, position: np.ndarray, rotation: np.ndarray, terrain: Terrain) -> Nearness:
    """Return the least distances of bodies at `position` (n, 20, 3) [m, world] with `rotation` (n, 20, 3, 3)."""
    capsules = skier_capsules(skeleton)
    first, last = capsules.ends(position, rotation)
    return Nearness(_pairs(skeleton, capsules, first, last), _over_snow(skeleton, capsules, first, last, terrain))


def body_pairs(skeleton: Skeleton) -> list[tuple[int, int]]:
    """Return the pairs of bodies that must not touch, by index: each arm and pole against all but its neighbours."""
    arms = [skeleton.body(f"{part}.{side}") for side in SIDES for part in ARM]
    pairs = []
    for one in arms:
        for other in range(len(skeleton.body_names)):
            if other in arms and other <= one:
                continue
            if not _neighbours(skeleton, one, other):
                pairs.append((one, other))
    return pairs


def _neighbours(skeleton: Skeleton, one: int, other: int) -> bool:
    (part, _, side), (other_part, _, other_side) = (skeleton.body_names[body].partition(".") for body in (one, other))
    held = side == other_side and tuple(sorted((part, other_part))) in _JOINED
    return one == other or held or int(skeleton.parent[one]) == other or int(skeleton.parent[other]) == one


def _pairs(skeleton: Skeleton, capsules: Capsules, first: np.ndarray, last: np.ndarray) -> dict[tuple[str, str], float]:
    found, names = {}, skeleton.body_names
    for one, other in body_pairs(skeleton):
        a, b = (grid.ravel() for grid in np.meshgrid(capsules.of([one]), capsules.of([other]), indexing="ij"))
        gap = segment_distances(first[:, a], last[:, a], first[:, b], last[:, b])
        gap -= capsules.radius[a] + capsules.radius[b]
        found[names[one], names[other]] = float(gap.min(initial=np.inf))
    return found


def _over_snow(
    skeleton: Skeleton, capsules: Capsules, first: np.ndarray, last: np.ndarray, terrain: Terrain
) -> dict[str, float]:
    """Return the least height of all bodies but skis over the snow, at right angles to it."""
    found = {}
    for body, name in enumerate(skeleton.body_names):
        if name.startswith("ski"):
            continue
        which = capsules.of([body])
        ends = np.concatenate((first[:, which], last[:, which]))
        x, y, z = ends.reshape(-1, 3).T
        up = terrain.normal(x, y)[:, 2]
        height = ((z - terrain.height(x, y)) * up).reshape(len(ends), -1) - capsules.radius[which]
        found[name] = float(height.min(initial=np.inf))
    return found
