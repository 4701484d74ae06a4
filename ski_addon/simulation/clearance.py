"""How the skis passed the gates of a course: on which side, and how near."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..body.kinematics import forward_kinematics
from ..body.skeleton import Skeleton, build_skeleton
from ..course.gates import Gates
from ..spec import RunSpec
from .recording import Recording

POLE_RADIUS = 0.015
"""Half the thickness of a gate's pole [m]."""
_NEAR = 12.0
_CHUNK = 4000


@dataclass(frozen=True)
class SkiPlaces:
    """Skis seen from above at m steps: `middle` (m, 2, 2) of the base [m, world x and y], and the horizontal parts of
    the ski's `along` and `across` (m, 2, 2) unit axes; `half_length`, `half_width` [m]. Axis 1 is left, right.
    """

    middle: np.ndarray
    along: np.ndarray
    across: np.ndarray
    half_length: float
    half_width: float

    def part(self, which: np.ndarray) -> SkiPlaces:
        """Return the skis at some of the steps."""
        return SkiPlaces(self.middle[which], self.along[which], self.across[which], self.half_length, self.half_width)


@dataclass(frozen=True)
class GatePassing:
    """How the gates of a course were passed; arrays (n,), NaN for gates that were not reached.

    `distance` [m] is the smallest from the pole to the middle between the skis, what `gates.distance` asks for;
    `clearance` [m] is what `gate_clearances` gives.
    """

    gates: Gates
    distance: np.ndarray
    clearance: np.ndarray

    @property
    def passed(self) -> np.ndarray:
        """Whether both skis passed each pole on its side without touching it (n,)."""
        return np.nan_to_num(self.clearance, nan=-1.0) > 0.0


def recorded_gates(recording: Recording) -> GatePassing | None:
    """Return how the gates of a recording were passed, or None for a course without gates."""
    gates = Gates.from_lists(recording.header.get("gates", {}))
    if not len(gates):
        return None
    skier = RunSpec.from_text(recording.header["spec"], "the run document in the recording").skier
    return measure_gates(build_skeleton(skier), recording.qpos, gates)


def measure_gates(skeleton: Skeleton, qpos: np.ndarray, gates: Gates) -> GatePassing:
    """Return how `gates` were passed by the skier in the recorded positions `qpos` (m, nq)."""
    skis = ski_places(skeleton, qpos)
    clearance = gate_clearances(skis, gates.position, gates.side)
    distance = np.where(np.isfinite(clearance), pole_distances(skis, gates.position), np.nan)
    return GatePassing(gates, distance, clearance)


def gate_summary(passing: GatePassing) -> dict[str, Any]:
    """Return how gates were passed as plain numbers: the keys of `summary.json` that only gate courses have.

    `gates` and `gates_passed` count; `gates_missed` are the numbers, from 1, of those not passed on their side or not
    reached. `gate_distances_m` and `gate_clearances_m` are those of `GatePassing`, None for gates not reached.
    """
    passed, reached = passing.passed, np.isfinite(passing.clearance)
    return {
        "gates": len(passed),
        "gates_passed": int(passed.sum()),
        "gates_missed": [int(number) for number in np.flatnonzero(~passed) + 1],
        "gate_distances_m": _numbers(passing.distance),
        "gate_clearances_m": _numbers(passing.clearance),
        "gate_clearance_min_m": float(passing.clearance[reached].min()) if reached.any() else None,
    }


def _numbers(values: np.ndarray) -> list[float | None]:
    return [float(value) if np.isfinite(value) else None for value in values]


def ski_places(skeleton: Skeleton, qpos: np.ndarray) -> SkiPlaces:
    """Return where the skis were, from the recorded positions `qpos` (m, nq)."""
    skis = [skeleton.body("ski.L"), skeleton.body("ski.R")]
    parts = [forward_kinematics(skeleton, qpos[i : i + _CHUNK]) for i in range(0, max(len(qpos), 1), _CHUNK)]
    position = np.concatenate([place[:, skis] for place, _ in parts])
    rotation = np.concatenate([turn[:, skis] for _, turn in parts])
    return SkiPlaces(
        middle=position[..., :2],
        along=rotation[..., :2, 0],
        across=rotation[..., :2, 1],
        half_length=0.5 * skeleton.ski_length,
        half_width=0.5 * skeleton.ski_width,
    )


def gate_clearances(skis: SkiPlaces, poles: np.ndarray, sides: np.ndarray) -> np.ndarray:
    """Return the signed clearance (n,) [m] of each gate; NaN where the skis never came past the pole.

    `poles` (n, 2 or 3) [m, world] are the poles' feet, `sides` (n,) +1 for poles to be left to the left of the skis.
    The size is the smallest horizontal distance from the pole's surface to the outline of a ski, over all steps and
    both skis. It is positive if both skis passed on the asked side without touching the pole, negative otherwise.
    """
    return np.array([_clearance(skis, pole[:2], float(side)) for pole, side in zip(poles, sides, strict=True)])


def pole_distances(skis: SkiPlaces, poles: np.ndarray) -> np.ndarray:
    """Return the smallest horizontal distance (n,) [m] from each pole to the middle between the skis."""
    middle = skis.middle.mean(axis=1)
    return np.array([np.min(np.linalg.norm(middle - pole[:2], axis=1), initial=np.inf) for pole in poles])


def _clearance(skis: SkiPlaces, pole: np.ndarray, side: float) -> float:
    """Return the signed clearance of one pole; see `gate_clearances`."""
    near = np.flatnonzero(np.linalg.norm(skis.middle - pole, axis=2).max(axis=1) < _NEAR)
    if len(near) < 2:
        return float("nan")
    some = skis.part(near)
    offset = pole - some.middle
    ahead = _dot(offset, some.along)  # of each ski's middle
    sideways = some.along[..., 0] * offset[..., 1] - some.along[..., 1] * offset[..., 0]  # positive: pole to the left
    right_side = True
    for ski in range(2):
        passing = np.flatnonzero((ahead[:-1, ski] > 0.0) & (ahead[1:, ski] <= 0.0))
        if not len(passing):
            return float("nan")
        closest = passing[np.argmin(np.abs(sideways[passing, ski]))]
        right_side &= bool(side * sideways[closest, ski] > 0.0)
    gap = float(np.min(_outline_distance(some, offset))) - POLE_RADIUS
    return gap if right_side else -abs(gap)


def _outline_distance(skis: SkiPlaces, offset: np.ndarray) -> np.ndarray:
    """Return the distance (m, 2) [m] of points at `offset` (m, 2, 2) from the skis' middles to their outlines.

    From above an edged ski is a slanted rectangle; inside of it the distance is negative.
    """
    long, wide = skis.half_length * skis.along, skis.half_width * skis.across
    corners = np.stack((long + wide, -long + wide, -long - wide, long - wide))
    edge = np.roll(corners, -1, axis=0) - corners
    away = offset[None] - corners
    share = np.clip(_dot(away, edge) / np.maximum(_dot(edge, edge), 1e-12), 0.0, 1.0)
    gap = np.linalg.norm(away - share[..., None] * edge, axis=-1).min(axis=0)
    turning = edge[..., 0] * away[..., 1] - edge[..., 1] * away[..., 0]
    inside = (turning > 0.0).all(axis=0) | (turning < 0.0).all(axis=0)
    return np.where(inside, -gap, gap)


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.einsum("...i,...i", a, b)
