"""Where the pelvis must be so that the centre of mass is where it is wanted, for all places of a plan at once.

The upper body keeps its angles, so its share of the centre of mass moves with the pelvis. The legs reach from the hips
to the skis, and the boots decide how the skis are edged. Hips and edges follow from each other; both are found by
corrections, mixed for each place by itself. Vectors are (3, ...), their components first: numpy is quickest with whole
rows.
"""

from __future__ import annotations

import numpy as np

from ..body import Skeleton
from ..body.kinematics import moment_of_mass
from ..body.leg_ik import SIDE_LIMIT, reach_of
from ..body.skeleton import SIDES
from ..frames import cross, matrix_from_quaternion
from ..snow import edge_lift
from .mixing import Mixing, dot

BOOT_PLAY = np.deg2rad(4.0)
"""How much of the boot's 5 degrees of side play the plan uses; approached smoothly."""
CLOSE = 1e-10
"""Change [m] and [rad] at which the corrections end."""
MOST_ROUNDS = 25
STRONGER = 1.2
"""The legs go along with the pelvis, but their lower ends stay: a correction is more than what is missing."""
LEG = ("thigh", "shank", "foot", "ski")
Array = np.ndarray


def place_pelvis(
    skeleton: Skeleton, qpos: Array, world_from_skis: Array, position: Array, com: Array, inclination: Array
) -> tuple[Array, Array]:
    """Return the pelvis's places (n, 3) [m, world] and the skis' edge angles (n, 2) [rad].

    `qpos` (n, nq) has the pelvis's rotation and the upper body's angles; the skis lie about `position` (n, 3) in the
    frames `world_from_skis` (n, 3, 3) of the snow, the centre of mass at `com` (n, 3) [m, world]. Without the boots'
    play the skis would be edged by the `inclination` (n,) [rad].
    """
    body = _Standing(skeleton, qpos, world_from_skis, position, com)
    lean = np.repeat(inclination[None], 2, axis=0)
    state = np.concatenate((body.guess(lean), lean))
    mixing = Mixing()
    for _ in range(MOST_ROUNDS):
        moved, misfit = body.missing(state[:3], state[3:])
        misfit -= inclination
        edged = lean + misfit - BOOT_PLAY * np.tanh(misfit / BOOT_PLAY) - state[3:]
        change = np.concatenate((STRONGER * moved, edged))
        if float(np.max(np.abs(change))) < CLOSE:
            break
        state = state + mixing.step(change)
    return np.ascontiguousarray(state[:3].T), np.ascontiguousarray(state[3:].T)


class _Standing:
    """What does not change while the pelvis is moved: (3, 2, n) arrays have the left leg first."""

    def __init__(self, skeleton: Skeleton, qpos: Array, world_from_skis: Array, position: Array, com: Array) -> None:
        thigh, shank, foot, ski = (skeleton.body(f"{part}.L") for part in LEG)
        self.thigh, self.shank = skeleton.lengths["thigh"], skeleton.lengths["shank"]
        self.reach, self.ankle_height, self.ski_width = reach_of(skeleton), skeleton.ankle_height, skeleton.ski_width
        rotation = matrix_from_quaternion(qpos[:, 3:7])
        offsets = np.array([skeleton.offset[skeleton.body(f"thigh.{side}")] for side in SIDES])
        self.hip = np.ascontiguousarray(np.einsum("nij,sj->isn", rotation, offsets))  # from the pelvis
        self.x, self.y, self.z = np.ascontiguousarray(world_from_skis.transpose(2, 1, 0))[:, :, None]
        apart = 0.5 * skeleton.stance_width * np.array([[1.0], [-1.0]])
        self.below = position.T[:, None] + apart * self.y - skeleton.ankle_setback * self.x  # the ankles, in the snow
        upper = [i for i, name in enumerate(skeleton.body_names) if name.partition(".")[0] not in LEG]
        at_origin = qpos.copy()
        at_origin[:, :3] = 0.0
        self.upper, self.all = float(skeleton.mass[upper].sum()), float(skeleton.mass.sum())
        self.wanted = self.all * com.T - moment_of_mass(skeleton, at_origin, upper)
        self.foot = float(skeleton.mass[foot] + skeleton.mass[ski])
        place = skeleton.mass[foot] * skeleton.com[foot] + skeleton.mass[ski] * (
            skeleton.offset[ski] + skeleton.com[ski]
        )
        self.ahead, self.over = place[0], place[2]  # moment of foot and ski about the ankle
        self.limbs = float(skeleton.mass[thigh] + skeleton.mass[shank])
        below = self.foot + skeleton.mass[shank]
        # a leg's moment is that of all its mass at the hip, and these along thigh and shank
        self.along_thigh = float(skeleton.mass[thigh] * skeleton.com[thigh][2] - below * self.thigh)
        self.along_shank = float(skeleton.mass[shank] * skeleton.com[shank][2] - self.foot * self.shank)

    def ankles(self, edge: Array) -> Array:
        """Return the ankles (3, 2, n) [m, world] over skis at `edge` (2, n) [rad]; see `pose.ski_frames`."""
        up = edge_lift(edge, self.ski_width) + self.ankle_height * np.cos(edge)
        return self.below + self.ankle_height * np.sin(edge) * self.y + up * self.z

    def guess(self, edge: Array) -> Array:
        """Return about where (3, n) [m, world] the pelvis is."""
        ankle = self.ankles(edge)
        legs = np.sum(0.5 * self.limbs * (self.hip + ankle) + self.foot * ankle, axis=1)
        return (self.wanted - legs) / (self.upper + self.limbs)

    def missing(self, pelvis: Array, edge: Array) -> tuple[Array, Array]:
        """Return how far (3, n) [m] the centre of mass is from where it should be for a `pelvis` there (3, n), and the
        edges (2, n) [rad] of skis in boots without play.
        """
        hip = pelvis[:, None] + self.hip
        knee_axis, thigh, to_ankle, shank = self._bones(hip, self.ankles(edge))
        rigid = -np.arctan2(dot(self.z, knee_axis), dot(self.y, knee_axis))
        boot = np.clip(rigid - edge, -SIDE_LIMIT, SIDE_LIMIT)
        ahead, over = self.x, cross(self.x, knee_axis)
        if shank is not to_ankle:  # the foot turns with it
            c, s = dot(shank, to_ankle), dot(shank, cross(knee_axis, to_ankle))
            ahead, over = c * ahead - s * over, s * ahead + c * over
        over = np.cos(boot) * over - np.sin(boot) * knee_axis
        legs = self.along_thigh * thigh + self.along_shank * shank + self.ahead * ahead + self.over * over
        legs += (self.limbs + self.foot) * hip
        moment = self.upper * pelvis + np.sum(legs, axis=1)
        return (self.wanted - moment) / self.all, rigid

    def _bones(self, hip: Array, ankle: Array) -> tuple[Array, Array, Array, Array]:
        """Return, (3, 2, n) each, the knees' axes as in `solve_leg`, and the directions up along thighs, up from the
        ankles as they were for a leg within reach, and up along shanks: the same array where all ankles are.
        """
        line = hip - ankle
        distance = np.sqrt(dot(line, line))
        held = np.clip(distance, *self.reach)
        up = line / distance
        knee_axis = cross(up, self.x)
        knee_axis /= np.sqrt(dot(knee_axis, knee_axis))
        cosine = np.clip((held**2 - self.thigh**2 - self.shank**2) / (2.0 * self.thigh * self.shank), -1.0, 1.0)
        sine = np.sqrt(1.0 - cosine**2)
        to_ankle = ((self.shank + self.thigh * cosine) * up + self.thigh * sine * cross(knee_axis, up)) / held
        thigh = line - self.shank * to_ankle
        thigh /= np.sqrt(dot(thigh, thigh))
        if np.all(held == distance):
            return knee_axis, thigh, to_ankle, to_ankle
        return knee_axis, thigh, to_ankle, sine * cross(knee_axis, thigh) + cosine * thigh
