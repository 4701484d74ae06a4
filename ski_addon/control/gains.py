"""Gains and weights of the controller's tasks.

`kp` [1/s^2] and `kd` [1/s] act on errors; `kd = 2 sqrt(kp)` is critical damping. Weights balance squared acceleration
errors [SG19 Eq. 29]. The motion is forgiving: each of these may change by a factor of ten without a fall.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class TaskGain:
    """Stiffness `kp` [1/s^2], damping `kd` [1/s] and `weight` of one task."""

    kp: float
    kd: float
    weight: float


@dataclass(frozen=True)
class Gains:
    """All tasks. A ski is tracked as a whole, which equals the paper's four corners [SG19 Eq. 32] except that
    `edging` (its roll) has a weight of its own: through corners a narrow ski's roll would weigh 460 times less than
    its pitch. `force` weighs snow forces in units of `FORCE_UNIT`.
    """

    ski: TaskGain = TaskGain(400.0, 40.0, 10.0)
    edging: TaskGain = TaskGain(400.0, 40.0, 5.0)
    com: TaskGain = TaskGain(100.0, 20.0, 10.0)
    pose: TaskGain = TaskGain(100.0, 20.0, 0.1)
    leg_pose: TaskGain = TaskGain(100.0, 20.0, 0.02)
    pelvis: TaskGain = TaskGain(100.0, 20.0, 0.3)
    angular_momentum: TaskGain = TaskGain(0.0, 20.0, 0.001)
    force: float = 0.1
    root_position: float = 1e-6


FORCE_UNIT = 100.0
"""Snow forces are unknowns in this unit [N], so that they are of the order of the accelerations."""
JOINT_LIMIT_TIME = 0.03
"""A hinge must be able to stop at its limit within this time [s]."""
RANGE_MARGIN = math.radians(0.5)
"""A hinge is brought to rest this far from the end of its range [rad]."""
ACCELERATION_LIMIT = 800.0
"""Bound on hinge accelerations [rad/s^2]: keeps the limits compatible with the torque limits."""
END_STOP_STRENGTH = 10.0
"""Most torque of a joint's end stop (bone, ligament, the boot's shell), in units of its muscles' greatest torque."""
FORCE_LIMIT_WEIGHTS = 6.0
"""Most normal force at one contact point, in units of the skier's weight."""
EDGE_SHEAR_RATIO = 6.0
"""Most side force at one contact point on an unlimited snow, in units of the skier's weight."""
LIFTING_EDGE_WEIGHTS = 0.5
"""Most force on a whole edge that begins to lift, in units of the skier's weight; it fades to nothing from there."""
