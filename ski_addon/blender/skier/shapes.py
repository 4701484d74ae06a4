"""Low-poly parts: stacked cross sections (rings) joined by quads, with a material a face and bone weights a vertex."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...frames import Array

Face = tuple[int, ...]


@dataclass(frozen=True)
class Ring:
    """One horizontal cross section at height `z`, around (`x`, `y`) [m].

    Half width `side` to left and right, `front` and `back` half depths; `power` 2 is an ellipse, more is squarer.
    """

    z: float
    side: float
    front: float
    back: float
    x: float = 0.0
    y: float = 0.0
    power: float = 2.0

    def points(self, count: int, seam: float = 0.0) -> Array:
        """Return (count, 3) points, from the front over the left side round.

        With a `seam` the two columns beside the front line are only that wide [rad].
        """
        angle = 2.0 * np.pi * np.arange(count) / count
        if seam:
            angle[1], angle[-1] = seam, 2.0 * np.pi - seam
        c, s = np.cos(angle), np.sin(angle)
        depth = np.where(c >= 0.0, self.front, self.back)
        share = 2.0 / self.power
        x = self.x + depth * np.sign(c) * np.abs(c) ** share
        y = self.y + self.side * np.sign(s) * np.abs(s) ** share
        return np.stack((x, y, np.full(count, self.z)), axis=1)

    def scaled(self, factor: float, z: float | None = None) -> Ring:
        """Return this ring with all half sizes times `factor`, at height `z` if given."""
        return replace(
            self,
            z=self.z if z is None else z,
            side=self.side * factor,
            front=self.front * factor,
            back=self.back * factor,
        )


@dataclass
class Part:
    """A piece of mesh: `vertices` (n, 3) [m], `faces`, one material name a face, weights {body: (n,)}.

    Vertices are in the frame of the whole skier at rest once `build` has placed them.
    """

    vertices: Array
    faces: Sequence[Face]
    materials: list[str]
    weights: dict[str, Array] = field(default_factory=dict)

    def moved(self, offset: Sequence[float] | Array) -> Part:
        """Return this part shifted by `offset` (3,) [m]."""
        return replace(self, vertices=self.vertices + np.asarray(offset, dtype=float))

    def turned(self, rotation: Array) -> Part:
        """Return this part rotated by the matrix `rotation` (3, 3) about its origin."""
        return replace(self, vertices=self.vertices @ np.asarray(rotation).T)

    def bound(self, body: str) -> Part:
        """Return this part wholly bound to `body`."""
        return replace(self, weights={body: np.ones(len(self.vertices))})

    def mirrored(self) -> Part:
        """Return the other side's part: y is flipped, `.L` becomes `.R` and faces keep looking out."""
        return replace(
            self,
            vertices=self.vertices * np.array([1.0, -1.0, 1.0]),
            faces=[tuple(reversed(face)) for face in self.faces],
            weights={_flip_side(name): weight for name, weight in self.weights.items()},
        )


def _flip_side(name: str) -> str:
    swap = {".L": ".R", ".R": ".L"}
    return name[:-2] + swap[name[-2:]] if name[-2:] in swap else name


def join(parts: Sequence[Part]) -> Part:
    """Return all `parts` as one, with weights filled with zeros where a part does not follow a body."""
    count = sum(len(part.vertices) for part in parts)
    weights = {name: np.zeros(count) for part in parts for name in part.weights}
    faces: list[Face] = []
    start = 0
    for part in parts:
        end = start + len(part.vertices)
        for name, weight in part.weights.items():
            weights[name][start:end] = weight
        faces.extend(tuple(start + i for i in face) for face in part.faces)
        start = end
    return Part(
        np.concatenate([part.vertices for part in parts]),
        faces,
        [material for part in parts for material in part.materials],
        weights,
    )


def loft(rings: Array, material: str | Callable[[int, int], str], caps: tuple[bool, bool] = (True, True)) -> Part:
    """Join closed `rings` (m, k, 3) by quads; `caps` close the first and last ring by a fan.

    `material` is a name, or a function of (row, column) that gives one. Faces look outwards.
    """
    rings = np.asarray(rings, dtype=float)
    rows, count = rings.shape[:2]
    named = material if callable(material) else lambda _row, _column: material
    vertices = [rings.reshape(-1, 3)]
    faces: list[Face] = []
    materials: list[str] = []
    for row in range(rows - 1):
        for column in range(count):
            a, b = row * count + column, row * count + (column + 1) % count
            faces.append((a, b, b + count, a + count))
            materials.append(named(row, column))
    for end, row in ((0, 0), (1, rows - 1)):
        if caps[end]:
            centre = sum(len(block) for block in vertices)
            vertices.append(rings[row].mean(axis=0)[None])
            for column in range(count):
                a, b = row * count + column, row * count + (column + 1) % count
                faces.append((b, a, centre) if end == 0 else (a, b, centre))
                materials.append(named(min(row, rows - 2), column))
    return facing_out(Part(np.concatenate(vertices), faces, materials))


def facing_out(part: Part) -> Part:
    """Return `part` with all faces turned over if its signed volume is negative."""
    centred = part.vertices - part.vertices.mean(axis=0)
    volume = 0.0
    for face in part.faces:
        for second, third in zip(face[1:], face[2:], strict=False):
            volume += float(np.dot(centred[face[0]], np.cross(centred[second], centred[third])))
    return part if volume >= 0.0 else replace(part, faces=[tuple(reversed(face)) for face in part.faces])


def stack(rings: Sequence[Ring], count: int, material: str | Callable[[int, int], str],
          caps: tuple[bool, bool] = (True, True), seam: float = 0.0) -> Part:  # fmt: skip
    """Loft horizontal `rings`, each of `count` points; `seam` is passed to `Ring.points`."""
    return loft(np.stack([ring.points(count, seam) for ring in rings]), material, caps)


def dome(ring: Ring, height: float, steps: int = 3) -> list[Ring]:
    """Return rings that close `ring` like a dome of `height` [m] above it (below, if negative), outermost first."""
    angles = 0.5 * np.pi * np.arange(1, steps + 1) / (steps + 0.35)
    return [ring.scaled(float(np.cos(a)), ring.z + height * float(np.sin(a))) for a in angles]


def smooth_step(value: Array, low: float, high: float) -> Array:
    """Return 0 below `low`, 1 above `high` and a smooth rise between (`low` may be above `high`)."""
    share = np.clip((np.asarray(value) - low) / (high - low), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def chain_weights(
    z: Array, names: Sequence[str], joints: Sequence[float], blend: Sequence[float], rising: bool = False
) -> dict[str, Array]:
    """Return weights of bodies that follow each other along z; `names[i]` and `names[i + 1]` meet at `joints[i]`.

    Each joint blends over `blend[i]` [m] to either side. The chain hangs down, or goes up if `rising`.
    """
    sign = 1.0 if rising else -1.0
    z = np.asarray(z, dtype=float)
    passed = [smooth_step(sign * (z - joint), -width, width) for joint, width in zip(joints, blend, strict=True)]
    weights = {}
    for index, name in enumerate(names):
        reached = passed[index - 1] if index > 0 else np.ones_like(z)
        left_behind = passed[index] if index < len(joints) else np.zeros_like(z)
        weights[name] = np.clip(reached - left_behind, 0.0, 1.0)
    return weights


def box(size: Sequence[float] | Array, material: str, bevel: float = 0.2) -> Part:
    """Return a bevelled box of `size` (x, y, z) [m] whose middle is the origin; `bevel` is a share of the height."""
    x, y, z = (0.5 * s for s in size)
    cut = bevel * z
    ring = np.array([[x, -y], [x, y], [-x, y], [-x, -y]])
    small = ring - np.sign(ring) * cut
    rows = [(small, -z), (ring, -z + cut), (ring, z - cut), (small, z)]
    return loft(np.stack([np.column_stack((points, np.full(4, height))) for points, height in rows]), material)
