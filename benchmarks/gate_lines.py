"""The paper's line past gates beside ours: `python -m benchmarks.gate_lines` prints the table of docs/gates.md.

[SG19 sec. 4.5] puts an arc of radius r about a centre r - d inside of each pole; it ends on the line through the pole
down the slope. Cubic Hermite splines link the arcs, so that heading is continuous there, but curvature is not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ski_addon.course.fair_line import Poles
from ski_addon.course.gate_settings import set_poles
from ski_addon.course.gates import gate_line
from ski_addon.spec import RunSpec

COURSES = {
    "slalom": {"kind": "gates", "gate_count": 20},
    "giant slalom": {"kind": "gates", "gate_setting": "giant_slalom", "gate_count": 15},
    "uneven slalom": {"kind": "gates", "gate_count": 20, "gate_variation": 1.0},
}
STEP = 0.05


def half_chord(radius: float, distance: float) -> float:
    """Return half the chord [m] that the line through the pole cuts from the arc: sqrt(d (2 r - d))."""
    return math.sqrt(distance * (2.0 * radius - distance))


def half_angle(radius: float, distance: float) -> float:
    """Return half the angle [rad] of the arc: acos(1 - d / r)."""
    return math.acos(1.0 - distance / radius)


@dataclass(frozen=True)
class Curve:
    """A plan-view curve: `down`, `left` (n,) [m] and `curvature` (n,) [1/m], positive to the left."""

    down: np.ndarray
    left: np.ndarray
    curvature: np.ndarray

    @property
    def arc(self) -> np.ndarray:
        """Arc length (n,) [m]."""
        return np.concatenate(([0.0], np.cumsum(np.hypot(np.diff(self.down), np.diff(self.left)))))


def paper_line(poles: Poles, radius: float) -> Curve:
    """Return the paper's line past `poles` with arcs of one `radius` [m], from the first arc to the last."""
    pieces: list[np.ndarray] = []
    for k in range(len(poles)):
        side, distance = float(poles.side[k]), float(poles.distance[k])
        reach = half_angle(radius, distance)
        angle = np.linspace(-reach, reach, int(np.ceil(2.0 * reach * radius / STEP)) + 1)
        centre = poles.left[k] + side * (radius - distance)
        arc = np.stack(
            (
                poles.down[k] + radius * np.sin(angle),
                centre - side * radius * np.cos(angle),
                np.full_like(angle, side / radius),
            )
        )
        if pieces:
            pieces.append(_hermite(pieces[-1][:2, -1], -float(poles.side[k - 1]), arc[:2, 0], reach))
        pieces.append(arc)
    return Curve(*np.concatenate(pieces, axis=1))


def _hermite(begin: np.ndarray, side: float, end: np.ndarray, angle: float) -> np.ndarray:
    """Return places and curvature (3, n) of the cubic from `begin` to `end`, headed by `angle` away from `side`."""
    heading = -side * angle
    gap = float(np.linalg.norm(end - begin))
    tangent = gap * np.array([np.cos(heading), np.sin(heading)])
    u = np.linspace(0.0, 1.0, max(int(np.ceil(gap / STEP)), 8) + 1)[1:-1, None]
    place = (2 * u**3 - 3 * u**2 + 1) * begin + (3 * u**2 - 2 * u**3) * end + (2 * u**3 - 3 * u**2 + u) * tangent
    slope = (6 * u**2 - 6 * u) * (begin - end) + (6 * u**2 - 6 * u + 1) * tangent
    bend = (12 * u - 6) * (begin - end) + (12 * u - 6) * tangent
    curvature = (slope[:, 0] * bend[:, 1] - slope[:, 1] * bend[:, 0]) / np.linalg.norm(slope, axis=1) ** 3
    return np.vstack((place.T, curvature))


def our_line(spec: RunSpec, poles: Poles) -> Curve:
    """Return the line that the add-on skis."""
    return Curve(*gate_line(spec, poles).sampled(STEP))


def quickest(curve: Curve, ahead: float = 0.5) -> float:
    """Return the largest change of curvature within `ahead` [m] of the way, per metre [1/m^2]."""
    arc = curve.arc
    later = np.interp(np.minimum(arc + ahead, arc[-1]), arc, curve.curvature)
    return float(np.max(np.abs(later - curve.curvature))) / ahead


def main() -> None:
    """Print tightest radius and quickest change of curvature of both lines."""
    print("| course | line | tightest radius [m] | quickest change of curvature [1/m^2] |\n|---|---|---|---|")
    for name, course in COURSES.items():
        spec = RunSpec.from_dict({"course": course})
        poles = set_poles(spec)
        ours = our_line(spec, poles)
        tightest = 1.0 / float(np.max(np.abs(ours.curvature)))
        for label, curve in (("arcs and Hermite links", paper_line(poles, tightest)), ("smoothest line", ours)):
            print(f"| {name} | {label} | {1.0 / np.max(np.abs(curve.curvature)):.1f} | {quickest(curve):.3f} |")


if __name__ == "__main__":
    main()
