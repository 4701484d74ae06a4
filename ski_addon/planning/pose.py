"""Poses along the plan: angulated upper body and legs by inverse kinematics [SG19 sec. 4.4].

The pelvis leans by (1 + beta_a) of the inclination [SG19 Eq. 15]; the spine rights itself a little more, in proportion
to the angulation, and the head looks ahead (`gaze.py`). The skis are edged by the inclination; where the boots' side
play cannot take the difference between leg and ski, the ski's edge follows the leg, which is how angulation adds edge
on a real skier.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..body import Skeleton
from ..body.leg_ik import ankle_from_ski, solve_leg
from ..body.skeleton import SIDES
from ..frames import matrix_from_quaternion, quaternion_from_matrix, rotation_about
from ..snow import edge_lift
from .gaze import turn_head
from .pendulum import Pendulum
from .stance import Stance
from .standing import place_pelvis

SPINE_SHARE = {"abdomen_x": 0.30, "chest_x": 0.25}
"""Lean taken back by the spine, in units of the pelvis's angulation angle."""
PELVIS_TURN = 0.4
SPINE_TURN = {"abdomen_z": 0.15, "chest_z": 0.20}
"""How far pelvis and spine turn back from skidding skis towards the direction of travel, in units of the steering."""
CROUCH_PITCH = {"pelvis": 1.0, "abdomen_y": 1.0, "chest_y": 0.8}
"""How much further forward pelvis and spine bend for each metre that the legs bend [rad/m], so that the hips can go
back.
"""

ARM_RAISE, ARM_SPREAD, WRIST_TURN = 0.35, 0.35, 0.45
"""How arms follow the lean, in units of the lean: both swing towards the outside; the inside arm rises and its wrist
turns the pole back, the outside one's sink and turn forward. Rise and turn also grow by their factor times the lean
squared [rad] on both sides. It keeps hands level, the inside pole off the snow and the outside one off the leg.
"""


@dataclass(frozen=True)
class PlannedPoses:
    """Poses of a plan: `qpos` (n, nq), `edge_angle` (n, 2) [rad], ski centres `ski_position` (n, 2, 3) [m, world],
    `ski_rotation` (n, 2, 3, 3) and how far [m] the legs are out of reach, `reach_error` (n, 2).
    """

    qpos: np.ndarray
    edge_angle: np.ndarray
    ski_position: np.ndarray
    ski_rotation: np.ndarray
    reach_error: np.ndarray


def plan_poses(
    skeleton: Skeleton,
    stance: Stance,
    world_from_skis: np.ndarray,
    world_from_body: np.ndarray,
    position: np.ndarray,
    com: np.ndarray,
    pendulum: Pendulum,
    angulation: np.ndarray,
    steering: np.ndarray,
    gaze: np.ndarray,
) -> PlannedPoses:
    """Return poses whose skis lie on the track and whose centre of mass is `com` (n, 3) [m, world].

    `world_from_skis` (n, 3, 3) has columns along the skis, across to the left, and up from the snow, `world_from_body`
    the same for the smooth ground; `position` (n, 3) is the middle between the skis; `pendulum` leans the body,
    `angulation` (n,) is beta_a, -1..0, and `steering` (n,) [rad] the skis' angle from the track, out of which the upper
    body turns back; `gaze` (n, 3) is where the face points [world].
    """
    inclination = pendulum.inclination
    count = len(position)
    qpos = np.repeat(stance.qpos[None], count, axis=0)
    crouch = stance.height - np.hypot(pendulum.y, pendulum.h)
    _lean_upper_body(skeleton, qpos, world_from_body, inclination, angulation, steering, crouch, stance.pitch)
    turn_head(skeleton, qpos, gaze)
    qpos[:, :3], edge = place_pelvis(skeleton, qpos, world_from_skis, position, com, inclination)
    ski_position, ski_rotation = ski_frames(skeleton, world_from_skis, position, edge)
    reach_error = _solve_legs(skeleton, qpos, ski_position, ski_rotation)
    return PlannedPoses(qpos, edge, ski_position, ski_rotation, reach_error)


def ski_frames(
    skeleton: Skeleton, world_from_skis: np.ndarray, position: np.ndarray, edge_angle: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the skis' centres (n, 2, 3) [m, world] and rotations (n, 2, 3, 3) at `edge_angle` (n, 2) [rad].

    The skis stand apart within the snow surface; each is raised so that its lower edge, not its middle, is on it.
    """
    rotation = world_from_skis[:, None] @ rotation_about("x", -edge_angle)
    half = 0.5 * skeleton.stance_width * np.array([1.0, -1.0])
    sideways = half[None, :, None] * world_from_skis[:, None, :, 1]
    lift = edge_lift(edge_angle, skeleton.ski_width)[..., None] * world_from_skis[:, None, :, 2]
    return position[:, None] + sideways + lift, rotation


def _lean_upper_body(
    skeleton: Skeleton,
    qpos: np.ndarray,
    frames: np.ndarray,
    inclination: np.ndarray,
    angulation: np.ndarray,
    steering: np.ndarray,
    crouch: np.ndarray,
    pitch: float,
) -> None:
    pelvis_lean = (1.0 + angulation) * inclination
    pelvis = frames @ rotation_about("x", -pelvis_lean) @ rotation_about("z", -PELVIS_TURN * steering)
    qpos[:, 3:7] = quaternion_from_matrix(pelvis @ rotation_about("y", pitch + CROUCH_PITCH["pelvis"] * crouch))
    for hinge in ("abdomen_y", "chest_y"):
        qpos[:, skeleton.qpos_of(hinge)] += CROUCH_PITCH[hinge] * crouch
    for hinge, share in SPINE_TURN.items():
        qpos[:, skeleton.qpos_of(hinge)] -= share * steering
    for hinge, share in SPINE_SHARE.items():
        qpos[:, skeleton.qpos_of(hinge)] += share * -angulation * inclination
    for side, inside in (("L", inclination), ("R", -inclination)):
        qpos[:, skeleton.qpos_of(f"upper_arm_y.{side}")] -= ARM_RAISE * (inside + inside**2)
        qpos[:, skeleton.qpos_of(f"upper_arm_x.{side}")] -= ARM_SPREAD * inclination
        qpos[:, skeleton.qpos_of(f"hand_y.{side}")] += WRIST_TURN * (inside + inside**2)


def _solve_legs(skeleton: Skeleton, qpos: np.ndarray, ski_position: np.ndarray, ski_rotation: np.ndarray) -> np.ndarray:
    """Solve both legs in place in `qpos` and return how far they are out of reach (n, 2) [m]."""
    count = len(qpos)
    rotation = matrix_from_quaternion(qpos[:, 3:7])
    hips = [qpos[:, :3] + rotation @ skeleton.offset[skeleton.body(f"thigh.{side}")] for side in SIDES]
    feet = np.concatenate((ski_rotation[:, 0], ski_rotation[:, 1]))
    ankles = ankle_from_ski(skeleton, np.concatenate((ski_position[:, 0], ski_position[:, 1])), feet)
    legs = solve_leg(skeleton, np.concatenate(hips), np.concatenate((rotation, rotation)), ankles, feet)
    values = (*legs.thigh.T, legs.shank, legs.foot_y, legs.foot_x)
    for hinge, value in zip(("thigh_y", "thigh_x", "thigh_z", "shank_y", "foot_y", "foot_x"), values, strict=True):
        for side, part in zip(SIDES, (value[:count], value[count:]), strict=True):
            qpos[:, skeleton.qpos_of(f"{hinge}.{side}")] = part
    return legs.length_error.reshape(2, count).T.copy()
