"""One step of control: reference at the skier's progress, tasks, program, torques and snow forces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..planning import Reference
from ..snow import Snow
from .balance import Balance
from .baselines import FreeSkis
from .dynamics import Dynamics
from .formulation import Formulation
from .gains import Gains
from .slide import Slide
from .solver import OsqpSolver, Solution
from .tasks import Desired, TaskSet, progress_rate


@dataclass(frozen=True)
class Command:
    """What the controller decided at one step.

    `torque` (31,) [N m] of each hinge, of which `end_stop` (31,) is more than its muscles can give: the end of its
    range gives that, and only to a hinge on its way past it; `snow` (37,) generalised snow force; `edge_normal`,
    `edge_side` (2, 2) [N] by ski and edge; `load_moment` (2, 3) normal forces times their places from the ski's
    middle [N m, world]; `ski_force` (2, 3) [N, world]; `rate` of progress, 1 as planned; `sample` (3, width) the
    reference; `edge_angle` (2,) [rad] of the skis as they are; `root_residual` [N, N m]; and the solver's `solution`.
    """

    torque: np.ndarray
    end_stop: np.ndarray
    snow: np.ndarray
    edge_normal: np.ndarray
    edge_side: np.ndarray
    load_moment: np.ndarray
    ski_force: np.ndarray
    rate: float
    sample: np.ndarray
    edge_angle: np.ndarray
    root_residual: float
    solution: Solution


class Controller:
    """Computes torques and snow forces that follow a reference."""

    def __init__(
        self,
        dynamics: Dynamics,
        reference: Reference,
        snow: Snow,
        segments: int,
        gains: Gains,
        time_step: float,
        *,
        replans: bool = True,
        by_clock: bool = False,
        free_skis: FreeSkis | None = None,
    ) -> None:
        """Set up tasks, formulation and solver for one skier on one plan, to be asked every `time_step` [s].

        With `replans` a skier who is off the plan is given a new one that leads back, else the plan is tracked always.
        To compare: `by_clock` passes the plan as time passes, and `free_skis` leaves the skis to the snow.
        """
        self.dynamics, self.reference = dynamics, reference
        self.tasks = TaskSet(reference, gains, dynamics)
        self.formulation = Formulation(dynamics.model, snow, gains, segments)
        self.solver = OsqpSolver(self.formulation)
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
        dynamics, formulation = self.dynamics, self.formulation
        sample = self.reference.at(progress)
        rate = 1.0 if self._by_clock else progress_rate(self.reference, sample, dynamics)
        normal = sample[0, self._normal]
        edge_angle = np.array([edge_angle_of(dynamics.ski_rotation(ski), normal) for ski in range(2)])
        motion = self.tasks.motion.read(sample, rate)
        self.slide.apply()
        self.balance.update(progress, rate, sample, edge_angle, self.slide.share)
        desired = self.tasks.follow(motion)
        if self._free_skis is not None:
            self._free_skis.release(desired)
        problem = formulation.build(dynamics, desired, edge_angle, normal, motion.leg_freedom)
        solution = self.solver.solve(problem)
        x = solution.unknowns
        torque = np.clip(formulation.torques(dynamics, x), formulation.torque_lower, formulation.torque_upper)
        end_stop = torque - np.clip(torque, dynamics.model.torque_lower, dynamics.model.torque_upper)
        snow = formulation.snow_force(x)
        self.balance.observer.commanded(torque, snow)
        edge_normal, edge_side = formulation.edge_forces(x)
        return Command(
            torque=torque,
            end_stop=end_stop,
            snow=snow,
            edge_normal=edge_normal,
            edge_side=edge_side,
            load_moment=formulation.load_moments(x),
            ski_force=formulation.ski_forces(x),
            rate=rate,
            sample=sample,
            edge_angle=edge_angle,
            root_residual=formulation.root_residual(dynamics, x),
            solution=solution,
        )


def edge_angle_of(ski_rotation: np.ndarray, normal: np.ndarray) -> float:
    """Return a ski's edge angle [rad] to a snow surface of unit `normal` (3,), positive when it tips to the left."""
    across, up = ski_rotation[:, 1], ski_rotation[:, 2]
    return float(-np.arctan2(across @ normal, up @ normal))
