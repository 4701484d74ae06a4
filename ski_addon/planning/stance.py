"""The skier's one static pose [SG19 Fig. 1a]: knees bent, trunk forward, hands in front, balanced over the skis."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from ..body import Skeleton, centre_of_mass, forward_kinematics
from ..body.leg_ik import ankle_from_ski, solve_leg
from ..body.skeleton import SIDES
from ..frames import quaternion_from_matrix, rotation_about

PELVIS_PITCH = np.deg2rad(20.0)
"""Forward tilt of the pelvis in the stance."""
STRAIGHTEST_KNEE, DEEPEST_KNEE = np.deg2rad(20.0), np.deg2rad(104.0)
"""Knee bends between which the legs absorb bumps and keep their load."""
UPPER_BODY_DEG = {
    "abdomen_y": 13.0,
    "chest_y": 12.0,
    "head_y": -29.0,
    "upper_arm_y": -52.0,
    "upper_arm_x": 26.0,
    "upper_arm_z": -14.0,
    "forearm_y": -66.0,
    "hand_y": 0.0,
}
"""Hinge angles [deg] of the upper body, left side; x and z rotations mirror on the right."""
TUCK_PITCH, TUCK_KNEES = np.deg2rad(20.0), np.deg2rad(22.0)
"""How much further a full tuck tilts the pelvis and bends the knees."""
TUCK_DEG = {
    "abdomen_y": 10.0,
    "chest_y": 6.0,
    "head_y": -24.0,
    "upper_arm_y": -22.0,
    "upper_arm_x": -14.0,
    "forearm_y": -30.0,
}
"""What a full tuck adds to `UPPER_BODY_DEG` [deg]: back round and level, eyes ahead, hands together in front."""


@dataclass(frozen=True)
class Stance:
    """The balanced pose `qpos` (nq,) over skis side by side on flat ground at the origin, its centre of mass's
    `height` [m] over the snow, how much higher and lower the legs can bring it, `extension`, `retraction` [m], and the
    pelvis's forward tilt `pitch` [rad].
    """

    qpos: np.ndarray
    height: float
    extension: float
    retraction: float
    pitch: float


@lru_cache(maxsize=32)
def build_stance(skeleton: Skeleton, knee_bend: float, tuck: float = 0.0) -> Stance:
    """Return the stance with knees bent by `knee_bend` [rad] and the centre of mass over the middle of the skis; `tuck`
    0..1 makes it low against the air.
    """
    from scipy.optimize import brentq

    thigh, shank = skeleton.lengths["thigh"], skeleton.lengths["shank"]

    def reach_at(knee: float) -> float:
        return float(np.sqrt(thigh**2 + shank**2 + 2 * thigh * shank * np.cos(knee)))

    knee_bend = knee_bend + tuck * TUCK_KNEES
    reach = reach_at(knee_bend)

    def forward(angle: float) -> float:
        return float(_com(skeleton, _pose(skeleton, reach, angle, tuck))[0])

    angle = brentq(forward, -0.9, 0.9, xtol=1e-12)
    qpos = _pose(skeleton, reach, angle, tuck)
    qpos.setflags(write=False)
    extension, retraction = reach_at(STRAIGHTEST_KNEE) - reach, reach - reach_at(DEEPEST_KNEE)
    return Stance(
        qpos,
        float(_com(skeleton, qpos)[2]),
        float(extension * np.cos(angle)),
        float(retraction * np.cos(angle)),
        _pitch(tuck),
    )


def _pitch(tuck: float) -> float:
    return float(PELVIS_PITCH + tuck * TUCK_PITCH)


def upper_body_angles(skeleton: Skeleton, tuck: float = 0.0) -> dict[int, float]:
    """Return {qpos address: angle [rad]} of the stance's upper body."""
    angles = {}
    for hinge, upright in UPPER_BODY_DEG.items():
        degrees = upright + tuck * TUCK_DEG.get(hinge, 0.0)
        if hinge.split("_")[0] in ("abdomen", "chest", "head"):
            angles[skeleton.qpos_of(hinge)] = np.deg2rad(degrees)
            continue
        for side in SIDES:
            sign = -1.0 if side == "R" and hinge[-1] in "xz" else 1.0
            angles[skeleton.qpos_of(f"{hinge}.{side}")] = sign * np.deg2rad(degrees)
    return angles


def _pose(skeleton: Skeleton, reach: float, angle: float, tuck: float) -> np.ndarray:
    """Return qpos with the hips `reach` [m] from the ankles, the leg line tilted forward by `angle` [rad]."""
    qpos = np.zeros((1, skeleton.nq))
    half = 0.5 * skeleton.stance_width
    pelvis = rotation_about("y", np.array([_pitch(tuck)]))
    ski_rotation = np.eye(3)[None]
    ankle = ankle_from_ski(skeleton, np.array([[0.0, half, 0.0]]), ski_rotation)
    sideways = half - skeleton.hip_half_width
    up = np.sqrt(reach**2 - sideways**2)
    hip = ankle + np.array([up * np.sin(angle), -sideways, up * np.cos(angle)])
    hip_in_pelvis = skeleton.offset[skeleton.body("thigh.L")]
    qpos[:, :3] = hip - pelvis @ hip_in_pelvis
    qpos[:, 3:7] = quaternion_from_matrix(pelvis)
    for address, value in upper_body_angles(skeleton, tuck).items():
        qpos[:, address] = value
    legs = solve_leg(skeleton, hip, pelvis, ankle, ski_rotation)
    for side, sign in (("L", 1.0), ("R", -1.0)):
        for name, angles in (
            ("thigh_y", legs.thigh[:, 0]),
            ("thigh_x", sign * legs.thigh[:, 1]),
            ("thigh_z", sign * legs.thigh[:, 2]),
            ("shank_y", legs.shank),
            ("foot_y", legs.foot_y),
            ("foot_x", sign * legs.foot_x),
        ):
            qpos[:, skeleton.qpos_of(f"{name}.{side}")] = angles
    return qpos[0]


def _com(skeleton: Skeleton, qpos: np.ndarray) -> np.ndarray:
    return centre_of_mass(skeleton, *forward_kinematics(skeleton, qpos[None]))[0]
