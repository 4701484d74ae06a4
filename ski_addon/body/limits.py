"""Joint ranges and the torques a strong adult can give, by hinge.

Ranges follow clinical tables, narrowed where boot and clothes narrow them; torques are those of a strong adult of
75 kg and 1.78 m and scale with mass times stature. Signs follow the hinge axes (x fore, y left, z up): on a hanging
limb a positive y rotation extends the hip, flexes the knee and points the foot down; on the trunk it bends forward.
"""

from __future__ import annotations

from dataclasses import dataclass

REFERENCE_MASS_TIMES_HEIGHT = 75.0 * 1.78
"""Mass times stature [kg m] of the adult that the torque table describes."""


@dataclass(frozen=True)
class HingeLimit:
    """Range of a left (or middle) hinge `lower`..`upper` [deg] and greatest torques `negative`, `positive` [N m]."""

    lower: float
    upper: float
    negative: float
    positive: float


HINGE_LIMITS: dict[str, HingeLimit] = {
    "abdomen_y": HingeLimit(-15, 45, 280, 180),
    "abdomen_x": HingeLimit(-25, 25, 150, 150),
    "abdomen_z": HingeLimit(-25, 25, 90, 90),
    "chest_y": HingeLimit(-15, 40, 280, 180),
    "chest_x": HingeLimit(-20, 20, 150, 150),
    "chest_z": HingeLimit(-30, 30, 90, 90),
    "head_y": HingeLimit(-60, 50, 50, 40),
    "head_x": HingeLimit(-40, 40, 40, 40),
    "head_z": HingeLimit(-75, 75, 25, 25),
    "upper_arm_y": HingeLimit(-170, 60, 90, 90),
    "upper_arm_x": HingeLimit(-40, 150, 90, 90),
    "upper_arm_z": HingeLimit(-80, 80, 50, 50),
    "forearm_y": HingeLimit(-150, 0, 70, 60),
    "hand_y": HingeLimit(-75, 75, 15, 15),
    "thigh_y": HingeLimit(-125, 15, 150, 250),
    "thigh_x": HingeLimit(-45, 45, 130, 130),
    "thigh_z": HingeLimit(-45, 45, 80, 80),
    "shank_y": HingeLimit(2, 135, 250, 130),
    "foot_y": HingeLimit(-42, 20, 60, 180),
    "foot_x": HingeLimit(-5, 5, 100, 100),
}
"""Limits by hinge name without its side. The ankle's side axis is the boot's play; its torque is the shell's."""

MIRRORED_AXES = ("x", "z")
"""Rotations about these axes change sign from the left limb to the right one."""


def hinge_limit(joint_name: str) -> HingeLimit:
    """Return the limits of `joint_name` such as "thigh_x.R"; right limbs mirror the left.

    Raises `KeyError` for a hinge that is not actuated (a pole's).
    """
    base, _, side = joint_name.partition(".")
    limit = HINGE_LIMITS[base]
    if side == "R" and base[-1] in MIRRORED_AXES:
        return HingeLimit(-limit.upper, -limit.lower, limit.positive, limit.negative)
    return limit
