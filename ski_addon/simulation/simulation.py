"""Stepping the skier through a plan."""

from __future__ import annotations

import math
import time as clock
from collections.abc import Callable
from typing import Any

import numpy as np

from ..body import SkierModel
from ..control import Controller, Dynamics, FreeSkis, gains_of
from ..course import course_gates
from ..frames import matrix_from_quaternion
from ..gravity import GRAVITY
from ..planning import BY_CLOCK, MotionPlan, Reference
from ..snow import Snow
from ..spec import RunSpec
from ..terrain import Terrain
from .checkpoint import Checkpoints
from .falls import Fall, FallWatch
from .pushes import Pushes
from .recording import Recording
from .step_log import StepLog, present_errors
from .versions import library_versions

Progress = Callable[[float, str], "bool | None"]
"""Called with the fraction done and a line of text; returning False cancels."""

CHECK_INTERVAL = 10
"""Steps between two looks for a fall."""


class Simulation:
    """A run in progress: `advance` it by steps, then take its `recording`.

    The same specification on the same machine gives the same bytes: nothing depends on time or on chance.
    `STATE`, and what was logged, are all that the rest of a run depends on; see `checkpoint.py`.
    """

    STATE = ("step_done", "progress", "arc_length", "finished", "dynamics", "controller", "_watch", "_pushes", "log")

    def __init__(self, spec: RunSpec, plan: MotionPlan, model: SkierModel, terrain: Terrain) -> None:
        """Put the skier at the start of `plan`, moving as planned."""
        self.spec, self.plan, self.model = spec, plan, model
        self.gates = course_gates(spec, terrain)
        self.time_step = spec.simulation.time_step
        self.snow = Snow.of(spec.snow, spec.skier, spec.technique.tuck)
        self.reference = Reference(plan, model)
        self.dynamics = Dynamics(model, self.snow.drag_factor)
        steered = spec.technique.controller != "open_loop"
        self.controller = Controller(
            self.dynamics,
            self.reference,
            self.snow,
            spec.simulation.segments,
            gains_of(spec.technique.controller),
            self.time_step,
            solver=spec.simulation.solver,
            replans=_replans(spec),
            by_clock=spec.technique.equations in BY_CLOCK or not steered,
            free_skis=None if steered else FreeSkis(self.dynamics, self.snow, terrain),
        )
        self.step_total = math.ceil(plan.duration / self.time_step)
        self.step_done = 0
        self.progress = 0.0  # [s] into the plan
        self.arc_length = 0.0
        self.finished = False
        self.fall: Fall | None = None
        self.step_seconds: list[float] = []
        self._watch = FallWatch(self.dynamics, self.reference, terrain, on_track=steered)
        self._pushes = Pushes(spec.push, model, self.time_step)
        self.log = StepLog(plan, model, self.reference, self.step_total + 256)
        self._start()

    @property
    def fraction(self) -> float:
        """How much of the run is done, 0..1."""
        return min(self.progress / self.plan.duration, 1.0)

    @property
    def running(self) -> bool:
        """Whether there is more to step."""
        return not self.finished and self.fall is None

    def advance(self, step_count: int) -> bool:
        """Make up to `step_count` steps; return True while the run goes on."""
        for _ in range(step_count):
            if not self.running:
                return False
            begin = clock.perf_counter()
            self.step()
            self.step_seconds.append(clock.perf_counter() - begin)
        return self.running

    def step(self) -> None:
        """Make one step: dynamics, control, record, integrate."""
        dynamics, now = self.dynamics, self.step_done * self.time_step
        self.fall = self._watch.divergence(now, self.arc_length)
        if self.fall is not None:
            return
        dynamics.update()
        command = self.controller.step(self.progress)
        effort, value, columns = command.effort, command.sample[0], self.reference.columns
        self.arc_length = float(value[columns["arc_length"]][0])
        muscles = effort.torque - effort.end_stop
        ratio = np.maximum(muscles / self.model.torque_upper, muscles / self.model.torque_lower)
        self._watch.note_torques(now, ratio)
        if self.step_done % CHECK_INTERVAL == 0 or effort.solution.status != 0:
            errors = present_errors(self.log, command, self.controller)
            self.fall = self._watch.check(now, self.arc_length, command, *errors)
        self._pushes.update(self.step_done, dynamics, value[columns["tangent"]], value[columns["normal"]])
        self.log.add(now, self.progress, command, ratio, self._pushes.force, self.controller)
        if self.fall is not None:
            return
        acceleration = dynamics.accelerations(effort.torque, effort.snow, self._pushes.generalised)
        dynamics.integrate(acceleration, self.time_step)
        self.progress += command.rate * self.time_step
        self.step_done += 1
        self.finished = self.progress >= self.plan.duration

    def recording(self, status: str | None = None) -> Recording:
        """Return the recording so far. `status` defaults to what happened: "finished", "fell", "diverged", or
        "cancelled" for a run that was left before its end.
        """
        if status is None:
            status = "finished" if self.finished else self.fall.status if self.fall else "cancelled"
        return self.log.recording(self._header(status))

    def restore(self, recording: Recording, index: int, progress: float) -> None:
        """Go on from the state at step `index` of `recording`, so far [s] into the plan; see `resuming.resume`."""
        self.log.refill(recording, index)
        self.step_done, self.progress = index, progress
        self.finished = progress >= self.plan.duration
        self.arc_length = float(recording.arc_length[index])
        self.dynamics.qpos[:], self.dynamics.qvel[:] = recording.qpos[index], recording.qvel[index]
        self.dynamics.update()

    def _start(self) -> None:
        """Set the planned pose and velocity at the start of the track."""
        dynamics, model, columns = self.dynamics, self.model, self.reference.columns
        value, slope, _ = self.reference.at(0.0)
        dynamics.qpos[:] = self.plan.pose[0]
        velocity = np.zeros(model.mujoco.nv)
        velocity[model.actuated_dof] = slope[columns["joints"]]
        velocity[3:6] = matrix_from_quaternion(self.plan.pose[0, 3:7]).T @ value[columns["turning"]][6:9]
        dynamics.qvel[:] = velocity
        dynamics.update()
        velocity[:3] = slope[columns["com"]] - dynamics.com_velocity
        dynamics.qvel[:] = velocity

    def _header(self, status: str) -> dict[str, Any]:
        skeleton = self.model.skeleton
        return {
            "spec": self.spec.to_toml(),
            "spec_hash": self.spec.content_hash(),
            "model_hash": self.model.model_hash,
            "versions": library_versions(),
            "seed": self.spec.simulation.seed,
            "status": status,
            "status_detail": self.fall.detail() if self.fall else {},
            "body_names": list(skeleton.body_names),
            "joint_names": list(skeleton.joint_names),
            "actuated_joint_names": [skeleton.joint_names[i] for i in skeleton.actuated],
            "time_step": self.time_step,
            "gravity": GRAVITY.tolist(),
            "mass": self.model.mass,
            "gates": self.gates.lists() if self.gates else {},
        }


def _replans(spec: RunSpec) -> bool:
    """Return whether a skier who is off the plan gets a new one; what is there to compare with does not balance."""
    technique = spec.technique
    compares = technique.controller != "whole_body" or technique.equations != "mended"
    # a plan without lean is not balanced: there is nothing to come back to
    return technique.balance == "steering" and technique.inclination and not compares


def simulate(
    spec: RunSpec,
    plan: MotionPlan,
    model: SkierModel,
    terrain: Terrain,
    progress: Progress | None = None,
    checkpoints: Checkpoints | None = None,
) -> tuple[Recording, list[float]]:
    """Simulate the whole run; return its recording and the wall time of each step [s].

    `progress(fraction, text)` is called about every 0.1 s of simulated time; when it returns False the run is
    cancelled and what is done is kept. A fall is not an error here: the recording's status tells.
    With `checkpoints` it goes on from the one that is there, and saves one from time to time and when it is cancelled;
    the recording is the same with and without. Raises `OutputError` when a checkpoint cannot be written.
    """
    simulation = Simulation(spec, plan, model, terrain)
    if checkpoints is not None:
        checkpoints.load(simulation)
    chunk = max(int(0.1 / simulation.time_step), 1)
    cancelled = False
    while not cancelled and simulation.advance(chunk):
        if progress is not None:
            text = f"simulating {simulation.step_done * simulation.time_step:.1f} of {plan.duration:.1f} s"
            cancelled = progress(simulation.fraction, text) is False
        if checkpoints is not None and simulation.running:
            (checkpoints.save if cancelled else checkpoints.offer)(simulation)
    return simulation.recording(), simulation.step_seconds
