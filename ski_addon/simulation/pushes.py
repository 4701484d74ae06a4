"""Pushes from outside: forces on single bodies that act in the forward dynamics and are not told to the controller."""

from __future__ import annotations

import numpy as np

from ..body import SkierModel
from ..control import Dynamics
from ..errors import SpecError
from ..spec import PushSpec, RunSpec
from ..spec.fields import show_number

AXES = {"forward": (1, 0, 0), "back": (-1, 0, 0), "left": (0, 1, 0), "right": (0, -1, 0), "up": (0, 0, 1),
        "down": (0, 0, -1)}  # fmt: skip
"""Directions of a push in the track's frame: along the tangent, to the left within the surface, along its normal."""


class Pushes:
    """The pushes of a run, by steps: `update` once a step, then read `generalised` and `force`.

    `generalised` (nv,) [N, N m] is the sum of all that act now, `force` (3,) [N, world] the sum of their forces.
    A push acts at the centre of mass of its body, with a direction fixed in the world when it starts, for the whole
    steps nearest to its start and duration (at least one).
    """

    STATE = ("_world", "_begun")

    def __init__(self, pushes: tuple[PushSpec, ...], model: SkierModel, time_step: float) -> None:
        """Take over `pushes` for the bodies of `model`, in steps of `time_step` [s]."""
        import mujoco

        self._mj = mujoco
        self._pushes = pushes
        self._bodies = [model.skeleton.body(push.body) + 1 for push in pushes]
        self._first = [round(push.start / time_step) for push in pushes]
        self._count = [max(round(push.duration / time_step), 1) for push in pushes]
        self._world = np.zeros((len(pushes), 3))  # [N], fixed when a push has begun
        self._begun = np.zeros(len(pushes), dtype=bool)
        self._jacobian = np.zeros((3, model.mujoco.nv))
        self.generalised = np.zeros(model.mujoco.nv)
        self.force = np.zeros(3)

    def update(self, step: int, dynamics: Dynamics, tangent: np.ndarray, normal: np.ndarray) -> None:
        """Set the forces of `step` at the present state; `tangent` and `normal` (3,) are the track's frame here."""
        if not self._pushes:
            return
        self.generalised[:] = self.force[:] = 0.0
        for i, push in enumerate(self._pushes):
            if not 0 <= step - self._first[i] < self._count[i]:
                continue
            if not self._begun[i]:
                self._world[i], self._begun[i] = world_force(push, tangent, normal), True
            self._mj.mj_jacBodyCom(dynamics.model.mujoco, dynamics.data, self._jacobian, None, self._bodies[i])
            self.generalised += self._world[i] @ self._jacobian
            self.force += self._world[i]


def world_force(push: PushSpec, tangent: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the force (3,) [N, world] of a push in the track frame of unit `tangent` and surface `normal` (3,)."""
    frame = np.stack((tangent, np.cross(normal, tangent), normal))
    return push.force * (np.array(AXES[push.direction], dtype=float) @ frame)


def check_pushes(spec: RunSpec, duration: float) -> None:
    """Raise `SpecError` for a push that would start only when the run of `duration` [s] is over."""
    for number, push in enumerate(spec.push, start=1):
        if push.start >= duration:
            allowed = f"0..{show_number(round(duration, 2))} s, the planned run"
            hint = "start it earlier or make the course longer"
            raise SpecError(f"push {number}: start", push.start, allowed, hint)
