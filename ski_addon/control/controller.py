"""One step of control: reference at the skier's progress, tasks, program, torques and snow forces."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ..planning import Reference
from ..snow import Snow
from .balance import Balance
from .baselines import FreeSkis
from .dynamics import Dynamics
from .effort import Effort
from .gains import Gains
from .program import Program
from .slide import Slide
from .tasks import Desired, TaskSet, progress_rate


@dataclass(frozen=True)
class Command:
    """What the controller decided at one step.

    `effort` of muscles and snow; `rate` of progress, 1 as planned; `sample` (3, width) the reference; `edge_angle` (2,)
    [rad] of the skis as they are.
    """

    effort: Effort
    rate: float
    sample: np.ndarray
    edge_angle: np.ndarray


class Controller:
    """Computes torques and snow forces that follow a reference."""

    STATE = ("program", "balance", "slide")

    def __init__(
        self,
        dynamics: Dynamics,
        reference: Reference,
        snow: Snow,
        segments: int,
        gains: Gains,
        time_step: float,
        *,
        solver: str = "small",
        replans: bool = True,
        by_clock: bool = False,
        free_skis: FreeSkis | None = None,
    ) -> None:
        """Set up tasks and program for one skier on one plan, to be asked every `time_step` [s].

        `solver` "small" solves the program the fast way where it can, "osqp" always as it is written down.
        With `replans` a skier who is off the plan is given a new one that leads back, else the plan is tracked always.
        To compare: `by_clock` passes the plan as time passes, and `free_skis` leaves the skis to the snow.
        """
        self.dynamics, self.reference = dynamics, reference
        self.tasks = TaskSet(reference, gains, dynamics)
        self.program = Program(dynamics.model, snow, gains, segments, solver)
        self.balance = Balance(dynamics, reference, self.tasks.motion, time_step, replans=replans)
        self.slide = Slide(dynamics, self.tasks.motion, time_step)
        self._by_clock, self._free_skis = by_clock, free_skis
        self._normal = reference.columns["normal"]

    @property
    def desired(self) -> Desired:
        """The tasks' last desired accelerations and errors."""
        return self.tasks.desired

    def step(self, progress: float) -> Command:
        """Return the command at the dynamics' present state with the skier `progress` [s] into the plan."""
        dynamics = self.dynamics
        sample = self.reference.at(progress)
        rate = 1.0 if self._by_clock else progress_rate(self.reference, sample, dynamics)
        normal = sample[0, self._normal]
        edge_angle = edge_angles(dynamics.ski_rotations, normal)
        motion = self.tasks.motion.read(sample, rate)
        self.slide.apply()
        self.balance.update(progress, rate, sample, edge_angle, self.slide.share)
        desired = self.tasks.follow(motion)
        if self._free_skis is not None:
            self._free_skis.release(desired)
        effort = self.program.solve(dynamics, desired, edge_angle, normal, motion.leg_freedom)
        self.balance.observer.commanded(effort.torque, effort.snow)
        return Command(effort, rate, sample, edge_angle)


def edge_angles(ski_rotations: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the skis' edge angles (2,) [rad] to a snow surface of unit `normal` (3,), positive when they tip to the
    left; `ski_rotations` (2, 3, 3) are world from ski.
    """
    nx, ny, nz = normal.tolist()
    angles = []
    for (_, ax, ux), (_, ay, uy), (_, az, uz) in ski_rotations.tolist():
        angles.append(-math.atan2(ax * nx + ay * ny + az * nz, ux * nx + uy * ny + uz * nz))
    return np.array(angles)
