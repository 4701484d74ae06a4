"""The skier as a tree of bodies: 18 bodies and 31 hinges, and two poles held in passive two-axis joints.

`Skeleton` is plain data, so that kinematics and animation need neither MuJoCo nor Blender. Body 0 is the pelvis; the
order is depth first, which is also MuJoCo's (its body 0 is the world). Frames: x fore, y left, z up when the skier
stands upright with hanging arms (the zero configuration). A ski's frame lies in the middle of its base.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from ..frames import quaternion_from_matrix, rotation_about
from ..spec import SkierSpec
from .anthropometry import PAIRED, Segment, person_segments

SIDES = ("L", "R")
BODY_NAMES = (
    *("pelvis", "abdomen", "chest", "head"),
    *(f"{part}.{side}" for side in SIDES for part in ("upper_arm", "forearm", "hand", "pole")),
    *(f"{part}.{side}" for side in SIDES for part in ("thigh", "shank", "foot", "ski")),
)
PARENT_PART = {
    "abdomen": "pelvis",
    "chest": "abdomen",
    "head": "chest",
    "upper_arm": "chest",
    "forearm": "upper_arm",
    "hand": "forearm",
    "pole": "hand",
    "thigh": "pelvis",
    "shank": "thigh",
    "foot": "shank",
    "ski": "foot",
}
HINGES = {
    "abdomen": "yxz",
    "chest": "yxz",
    "head": "yxz",
    "upper_arm": "yxz",
    "forearm": "y",
    "hand": "y",
    "pole": "yx",
    "thigh": "yxz",
    "shank": "y",
    "foot": "yx",
}
"""Hinge axes of a part, outermost first. The ankle has the boot's small side axis, the wrist one axis."""

BOOT_AND_BINDING_HEIGHT = 0.0615
"""What boot sole, binding and ski add below the foot [m]."""
POLE_TILT = np.deg2rad(136.0)
"""Angle from forearm to pole with its spring at rest; in the skiing stance the pole then trails down and back."""


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Kinematic tree with inertia; arrays are read-only, and one is equal to itself only.

    `parent` (20,) index or -1; `offset` (20, 3) [m] and `rotation` (20, 4) of each body frame in its parent's at zero
    angles; `joint_body`, `joint_qpos`, `joint_dof` (35,) indices, `joint_axis` (35, 3) in the body frame; `mass` (20,)
    [kg], `com` (20, 3) [m] and diagonal `inertia` (20, 3) [kg m^2] in body frames; `lengths` [m] by part.
    """

    body_names: tuple[str, ...]
    parent: np.ndarray
    offset: np.ndarray
    rotation: np.ndarray
    joint_names: tuple[str, ...]
    joint_body: np.ndarray
    joint_axis: np.ndarray
    joint_qpos: np.ndarray
    joint_dof: np.ndarray
    mass: np.ndarray
    com: np.ndarray
    inertia: np.ndarray
    lengths: dict[str, float]
    ski_length: float
    ski_width: float
    ski_sidecut_radius: float
    pole_length: float
    ankle_height: float
    ankle_setback: float
    hip_half_width: float
    stance_width: float
    height: float

    @property
    def nq(self) -> int:
        """Number of positions: 7 of the root and one a hinge."""
        return 7 + len(self.joint_names)

    @property
    def nv(self) -> int:
        """Number of velocities: 6 of the root and one a hinge."""
        return 6 + len(self.joint_names)

    @cached_property
    def actuated(self) -> np.ndarray:
        """Indices (31,) into the hinges of those that muscles move: all but the poles'."""
        index = np.array([i for i, name in enumerate(self.joint_names) if not name.startswith("pole")])
        index.setflags(write=False)
        return index

    def body(self, name: str) -> int:
        """Return the index of the body `name`."""
        return self.body_names.index(name)

    def qpos_of(self, joint_name: str) -> int:
        """Return the address in qpos of the hinge `joint_name`."""
        return int(self.joint_qpos[self.joint_names.index(joint_name)])


@lru_cache(maxsize=32)
def build_skeleton(skier: SkierSpec) -> Skeleton:
    """Return the skeleton of a person and equipment: `skier.mass` is all that the snow carries, equipment included.

    The same skier always has the same one.
    """
    equipment = 2 * (skier.boot_mass + skier.ski_mass + skier.pole_mass)
    segments = person_segments(skier.mass - equipment, skier.height, skier.sex)
    sizes = _Sizes.of(skier)
    joints = [(name, axis) for name in BODY_NAMES for axis in HINGES.get(name.partition(".")[0], "")]
    inertial = [_inertial(name, skier, segments, sizes) for name in BODY_NAMES]
    count = len(joints)
    skeleton = Skeleton(
        body_names=BODY_NAMES,
        parent=np.array([_parent_index(name) for name in BODY_NAMES]),
        offset=np.array([_offset(name, sizes) for name in BODY_NAMES]),
        rotation=np.array([_rotation(name) for name in BODY_NAMES]),
        joint_names=tuple(_joint_name(name, axis) for name, axis in joints),
        joint_body=np.array([BODY_NAMES.index(name) for name, _ in joints]),
        joint_axis=np.array([np.eye(3)["xyz".index(axis)] for _, axis in joints]),
        joint_qpos=np.arange(7, 7 + count),
        joint_dof=np.arange(6, 6 + count),
        mass=np.array([m for m, _, _ in inertial]),
        com=np.array([c for _, c, _ in inertial]),
        inertia=np.array([i for _, _, i in inertial]),
        lengths=sizes.lengths,
        ski_length=sizes.ski_length,
        ski_width=skier.ski_width,
        ski_sidecut_radius=skier.ski_sidecut_radius,
        pole_length=sizes.pole_length,
        ankle_height=sizes.ankle_height,
        ankle_setback=sizes.ankle_setback,
        hip_half_width=sizes.hip_half_width,
        stance_width=sizes.stance_width,
        height=skier.height,
    )
    for value in vars(skeleton).values():
        if isinstance(value, np.ndarray):
            value.setflags(write=False)
    return skeleton


@dataclass(frozen=True)
class _Sizes:
    """Lengths [m] that place the joints."""

    height: float
    lengths: dict[str, float]
    ankle_height: float
    ankle_setback: float
    hip_half_width: float
    stance_width: float
    ski_length: float
    pole_length: float

    @classmethod
    def of(cls, skier: SkierSpec) -> _Sizes:
        h = skier.height
        lengths = {
            "pelvis": 0.08 * h,
            "abdomen": 0.0933 * h,
            "chest": 0.1733 * h,
            "head": 0.1234 * h,
            "upper_arm": 0.186 * h,
            "forearm": 0.146 * h,
            "hand": 0.108 * h,
            "thigh": 0.245 * h,
            "shank": 0.246 * h,
            "foot": 0.152 * h,
            "shoulder_half_width": 0.112 * h,
        }
        return cls(
            height=h,
            lengths=lengths,
            ankle_height=0.039 * h + BOOT_AND_BINDING_HEIGHT,
            ankle_setback=0.0333 * h,
            hip_half_width=0.0575 * h,
            stance_width=0.1333 * h if skier.stance_width == "auto" else float(skier.stance_width),
            ski_length=min(h, 1.95) if skier.ski_length == "auto" else float(skier.ski_length),
            pole_length=0.7 * h if skier.pole_length == "auto" else float(skier.pole_length),
        )


def _joint_name(body_name: str, axis: str) -> str:
    part, dot, side = body_name.partition(".")
    return f"{part}_{axis}{dot}{side}"


def _parent_index(name: str) -> int:
    part, _, side = name.partition(".")
    if part not in PARENT_PART:
        return -1
    parent = PARENT_PART[part]
    return BODY_NAMES.index(f"{parent}.{side}" if parent in PAIRED else parent)


def _offset(name: str, sizes: _Sizes) -> tuple[float, float, float]:
    part, _, side = name.partition(".")
    left = {"L": 1.0, "R": -1.0}.get(side, 0.0)
    h, lengths = sizes.height, sizes.lengths
    offsets = {
        "pelvis": (0.0, 0.0, 0.0),
        "abdomen": (0.0, 0.0, 0.0533 * h),
        "chest": (0.0, 0.0, lengths["abdomen"]),
        "head": (0.0, 0.0, lengths["chest"]),
        "upper_arm": (0.0, left * lengths["shoulder_half_width"], 0.1467 * h),
        "forearm": (0.0, 0.0, -lengths["upper_arm"]),
        "hand": (0.0, 0.0, -lengths["forearm"]),
        "pole": (0.0, 0.0, -0.5 * lengths["hand"]),
        "thigh": (0.0, left * sizes.hip_half_width, -0.0267 * h),
        "shank": (0.0, 0.0, -lengths["thigh"]),
        "foot": (0.0, 0.0, -lengths["shank"]),
        "ski": (sizes.ankle_setback, 0.0, -sizes.ankle_height),
    }
    return offsets[part]


def _rotation(name: str) -> np.ndarray:
    angle = POLE_TILT if name.startswith("pole") else 0.0
    return quaternion_from_matrix(rotation_about("y", float(angle)))


def _box(mass: float, x: float, y: float, z: float) -> np.ndarray:
    return mass / 12.0 * np.array([y * y + z * z, x * x + z * z, x * x + y * y])


def _inertial(
    name: str, skier: SkierSpec, segments: dict[str, Segment], sizes: _Sizes
) -> tuple[float, np.ndarray, np.ndarray]:
    """Return mass [kg], centre of mass [m] and diagonal inertia [kg m^2] of a body in its frame."""
    part = name.partition(".")[0]
    h = sizes.height
    if part == "pole":
        mass, length = skier.pole_mass, sizes.pole_length
        bar = mass * length**2 / 12.0
        return mass, np.array([0.0, 0.0, -0.42 * length]), np.array([bar, bar, 1e-4 * mass])
    if part == "ski":
        return skier.ski_mass, np.array([0.0, 0.0, 0.01]), _box(skier.ski_mass, sizes.ski_length, skier.ski_width, 0.02)
    segment = segments[part]
    inertia = np.array(segment.inertia)
    if part in ("upper_arm", "forearm", "hand", "thigh", "shank"):
        return segment.mass, np.array([0.0, 0.0, -segment.com]), inertia
    if part == "foot":
        return _booted_foot(segment, skier, sizes)
    hip_height = 0.0267 * h
    heights = {  # of the centre of mass above the hip line; a segment's cranial end less its tabled distance
        "pelvis": segment.length - segment.com,
        "abdomen": segments["pelvis"].length + segment.length - segment.com,
        "chest": segments["pelvis"].length + segments["abdomen"].length + segment.length - segment.com,
        "head": 0.47 * h - segment.com,
    }
    origins = {"pelvis": 0.0267 * h, "abdomen": hip_height + 0.0533 * h, "chest": hip_height + 0.1466 * h}
    origin = origins.get(part, hip_height + 0.1466 * h + sizes.lengths["chest"])
    return segment.mass, np.array([0.0, 0.0, heights[part] - origin]), inertia


def _booted_foot(segment: Segment, skier: SkierSpec, sizes: _Sizes) -> tuple[float, np.ndarray, np.ndarray]:
    """Join the foot, whose long axis lies fore and aft, and the boot around it."""
    foot_com = np.array([-0.25 * segment.length + segment.com, 0.0, -0.0195 * sizes.height])
    boot_com = np.array([0.02, 0.0, -0.02])
    mass = segment.mass + skier.boot_mass
    com = (segment.mass * foot_com + skier.boot_mass * boot_com) / mass
    fore_aft, sideways, along = segment.inertia
    inertia = np.array([along, sideways, fore_aft]) + _box(skier.boot_mass, 0.3, 0.11, 0.3)
    for m, c in ((segment.mass, foot_com), (skier.boot_mass, boot_com)):
        d = c - com
        inertia = inertia + m * (d @ d - d * d)
    return mass, com, inertia
