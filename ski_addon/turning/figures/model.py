"""`FigureModel`: the bodies of a turning figure, how they hang together, and where they are at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...body import Skeleton, build_skeleton
from ...body.rest import rest_frames
from ...spec import RunSpec
from . import bicycle_sizes, board_sizes, ski_sizes

GEAR_PARTS = ("ski", "pole")
"""Parts of the skeleton that are gear; the other 16 bodies are the person."""


@dataclass(frozen=True)
class FigureModel:
    """A figure at rest: upright, arms hanging, facing +x, the ground at z = 0; arrays over its b bodies, read-only.

    `kind` of the run document; `skeleton` of the person; `body_names` with parents first; `parent` (b,) index or -1
    (the rig's root); `free` names of bodies that move against their parent, the others only turn; `place` (b, 3) [m]
    and `turn` (b, 3, 3) of the body frames at rest; `gear` names of what is not the person; `sizes` of the gear in
    [m] or [rad], named in `ski_sizes`, `board_sizes` and `bicycle_sizes`.

    Frames: x forward, y left, z up at rest. A ski's is in the middle of its base, a board's too, its x towards the
    nose; a pole's in the grip, the tip along -z; the bicycle's are told in `bicycle_sizes`.
    """

    kind: str
    skeleton: Skeleton
    body_names: tuple[str, ...]
    parent: np.ndarray
    free: frozenset[str]
    place: np.ndarray
    turn: np.ndarray
    gear: tuple[str, ...]
    sizes: dict[str, float]

    def body(self, name: str) -> int:
        """Return the index of the body `name`."""
        return self.body_names.index(name)

    @property
    def person(self) -> tuple[str, ...]:
        """Names of the person's bodies."""
        return tuple(name for name in self.body_names if name not in self.gear)


def build_figure(spec: RunSpec) -> FigureModel:
    """Return the figure of `spec.figure.kind` with the measures of `spec.skier`."""
    skeleton = build_skeleton(spec.skier)
    if spec.figure.kind == "snowboard":
        return _ridden(spec, skeleton, board_sizes.board_sizes(skeleton, spec.figure), board_sizes.BODIES)
    if spec.figure.kind == "bicycle":
        return _ridden(spec, skeleton, bicycle_sizes.bicycle_sizes(skeleton), bicycle_sizes.BODIES)
    place, turn = rest_frames(skeleton)
    free = {"pelvis", "ski.L", "ski.R"} if spec.figure.kind == "telemark" else {"pelvis"}
    gear = tuple(name for name in skeleton.body_names if name.partition(".")[0] in GEAR_PARTS)
    sizes = ski_sizes.ski_sizes(skeleton, spec.figure)
    parent = np.array(skeleton.parent)
    return _model(spec.figure.kind, skeleton, skeleton.body_names, parent, free, place, turn, gear, sizes)


def _ridden(spec: RunSpec, skeleton: Skeleton, sizes: dict[str, float], bodies: dict[str, str | None]) -> FigureModel:
    """Return a person without skis and poles, and the bodies {name: parent's name} of what is ridden."""
    person = [name for name in skeleton.body_names if name.partition(".")[0] not in GEAR_PARTS]
    names = (*person, *bodies)
    index = [skeleton.body(name) for name in person]
    parent = [person.index(skeleton.body_names[skeleton.parent[i]]) if skeleton.parent[i] >= 0 else -1 for i in index]
    parent += [names.index(above) if above else -1 for above in bodies.values()]
    place, turn = rest_frames(skeleton)
    foot = skeleton.body("foot.L")
    place = place + [0.0, 0.0, sizes["ankle_height"] - place[foot, 2]]
    rest = board_sizes.rest if spec.figure.kind == "snowboard" else bicycle_sizes.rest
    gear_place, gear_turn = rest(sizes)
    free = {"pelvis", *(name for name, above in bodies.items() if not above)}
    return _model(
        spec.figure.kind,
        skeleton,
        names,
        np.array(parent),
        free,
        np.concatenate((place[index], gear_place)),
        np.concatenate((turn[index], gear_turn)),
        tuple(bodies),
        sizes,
    )


def _model(
    kind: str,
    skeleton: Skeleton,
    names: tuple[str, ...],
    parent: np.ndarray,
    free: set[str],
    place: np.ndarray,
    turn: np.ndarray,
    gear: tuple[str, ...],
    sizes: dict[str, float],
) -> FigureModel:
    for array in (parent, place, turn):
        array.setflags(write=False)
    return FigureModel(kind, skeleton, names, parent, frozenset(free), place, turn, gear, sizes)
