"""Controllers to compare with: joints by the clock without balance, and a stiff body that leans.

Both are the same quadratic program with other weights. Open loop [SG19 sec. 2 on Yoneyama 2009] keeps the joints alone;
nobody steers the skis then, so what the program is told to do with them is what snow does: it holds a ski up and along
its own direction, and an edged ski carves round the circle of its side.
"""

from __future__ import annotations

import math

import numpy as np

from ..snow import Snow, edge_lift
from ..terrain import Terrain
from .dynamics import Dynamics
from .gains import Gains, TaskGain
from .tasks import Desired

HOLD = TaskGain(400.0, 40.0, 100.0)
"""How firmly snow holds a ski at its surface."""
GRIP = 40.0
"""Rate [1/s] at which a ski's slip across itself, and its turning off its circle, die away."""
CARVE_FROM = math.radians(3.0)
"""Edge angle [rad] about which a ski begins to carve its circle; a flat one runs straight."""

OPEN_LOOP = Gains(
    ski=HOLD,
    edging=TaskGain(0.0, 0.0, 0.0),
    com=TaskGain(0.0, 0.0, 0.0),
    pose=TaskGain(400.0, 40.0, 1.0),
    leg_pose=TaskGain(400.0, 40.0, 1.0),
    pelvis=TaskGain(0.0, 0.0, 0.0),
    angular_momentum=TaskGain(0.0, 0.0, 0.0),
)
INCLINATION_ONLY = Gains(pose=TaskGain(400.0, 40.0, 1.0), angular_momentum=TaskGain(0.0, 0.0, 0.0))


def gains_of(controller: str) -> Gains:
    """Return the gains of a `technique.controller`."""
    return {"open_loop": OPEN_LOOP, "inclination_only": INCLINATION_ONLY}.get(controller, Gains())


class FreeSkis:
    """Skis that nobody steers: overwrites the skis' desired accelerations by what snow does to them."""

    def __init__(self, dynamics: Dynamics, snow: Snow, terrain: Terrain) -> None:
        """Bind to the skier of `dynamics` on `snow` that lies on `terrain`."""
        self._dynamics, self._snow, self._terrain = dynamics, snow, terrain
        skeleton = dynamics.model.skeleton
        self._width, self._radius = skeleton.ski_width, skeleton.ski_sidecut_radius

    def release(self, desired: Desired) -> None:
        """Replace the skis' part of `desired`."""
        for ski in range(2):
            self._release(desired, ski)

    def _release(self, desired: Desired, ski: int) -> None:
        dynamics = self._dynamics
        place, rotation = dynamics.ski_position(ski), dynamics.ski_rotation(ski)
        velocity = dynamics.ski_velocity[ski]
        normal = np.asarray(self._terrain.normal(place[0], place[1]), dtype=float)
        across = np.cross(normal, rotation[:, 0])
        across /= math.sqrt(across @ across)
        along = np.cross(across, normal)
        edge = float(-np.arctan2(rotation[:, 1] @ normal, rotation[:, 2] @ normal))
        sink = float(place[2] - self._terrain.height(place[0], place[1])) * normal[2]
        sink -= float(edge_lift(np.array(edge), self._width))
        speed = float(velocity[:3] @ along)
        turning = speed * self._curvature(edge)
        gravity = -9.81 * along[2]
        desired.ski[ski, :3] = (
            self._snow.glide_acceleration(gravity, 9.81 * normal[2], speed) * along
            + (turning * speed - GRIP * float(velocity[:3] @ across)) * across
            - (HOLD.kp * sink + HOLD.kd * float(velocity[:3] @ normal)) * normal
        )
        pitch = math.asin(min(max(float(rotation[:, 0] @ normal), -1.0), 1.0))
        spin = velocity[3:]
        wanted = (HOLD.kp * pitch - HOLD.kd * float(spin @ across)) * across + GRIP * (
            turning - float(spin @ normal)
        ) * normal
        desired.ski[ski, 3:] = wanted @ rotation

    def _curvature(self, edge: float) -> float:
        """Return the curvature [1/m] that a ski of this side carves at `edge` [rad], positive to the left."""
        return math.tanh(edge / CARVE_FROM) / (self._radius * max(math.cos(edge), 0.2))
