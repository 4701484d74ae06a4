"""Logging of a step: what has to be noted at once, and what is worked out from it for many steps together.

A step notes its state, forces and the reference it followed. Errors, offsets, the zero-moment point and the like are
computed in batches of `BATCH` steps: by single steps they would cost more than the control itself.
"""

from __future__ import annotations

import math

import numpy as np

from ..body import SkierModel
from ..control import Command, Controller
from ..planning import MotionPlan, Reference
from .recorder import Recorder
from .recording import Recording
from .support import SkiGauge, SkiStates

BATCH = 256
"""Steps that are worked out together."""
NUMBERS = ("time", "progress", "speed", "root_residual", "steering_offset", "capture_margin")
ARRAYS = (
    *("qpos", "qvel", "tau", "torque_ratio", "end_stop", "snow_force", "snow_edge_force", "snow_edge_side"),
    *("edge_angle", "com", "push_force", "disturbance"),
)
PLANNED = {
    "arc_length": "arc_length",
    "edge_angle_reference": "edge_angle",
    "com_reference": "com",
    "turn_phase": "turn_phase",
    "curvature": "curvature",
    "track_position": "track_position",
    "track_tangent": "tangent",
    "surface_normal": "normal",
    "steering": "steering",
}
"""Columns of a recording that are columns of the reference."""


class StepLog:
    """Logs the steps of one simulation.

    The batch is part of the state: worked out at other steps, its last digits could be others.
    """

    STATE = (
        *("_begin", "_value", "_place", "_rotation", "_quaternion", "_offset", "_turn", "_load_moment", "_interval"),
        "_led_astray",
    )

    def __init__(self, plan: MotionPlan, model: SkierModel, reference: Reference, expected: int) -> None:
        """Reserve room for about `expected` steps of `model` along `plan`, whose splines are `reference`."""
        self._model, self._reference = model, reference
        self._columns = reference.columns
        self._labels = (plan.phase, plan.turn)
        self.recorder = Recorder(expected, NUMBERS, ARRAYS)
        self._begin = 0  # step of the recording at which the batch begins
        self.gauge = SkiGauge(model.skeleton, reference.columns)
        self._value = np.zeros((BATCH, reference.width))
        self._place, self._rotation = np.zeros((BATCH, 2, 3)), np.zeros((BATCH, 2, 3, 3))
        self._quaternion = np.zeros((BATCH, 2, 4))
        self._offset, self._turn = np.zeros((BATCH, 2, 3)), np.zeros((BATCH, 2, 3))
        self._load_moment = np.zeros((BATCH, 2, 3))
        self._interval = np.zeros(BATCH, dtype=int)
        self._led_astray = np.zeros(BATCH, dtype=bool)

    def refill(self, recording: Recording, count: int) -> None:
        """Begin with the first `count` steps of `recording`."""
        self.recorder.refill(recording, count)
        self._begin = count

    def add(
        self,
        time: float,
        progress: float,
        command: Command,
        ratio: np.ndarray,
        push: np.ndarray,
        controller: Controller,
    ) -> None:
        """Note one step: the state of the controller's dynamics, and what was decided at it.

        `ratio` (31,) are torques in units of the muscles' limits, `push` (3,) [N, world] the force from outside.
        """
        dynamics, balance, desired, effort = controller.dynamics, controller.balance, controller.desired, command.effort
        k, skis = self.recorder.count - self._begin, self._model.ski_body
        self._value[k] = command.sample[0]
        self._place[k], self._rotation[k] = dynamics.ski_places, dynamics.ski_rotations
        self._quaternion[k] = dynamics.xquat[skis]
        self._offset[k], self._turn[k] = desired.ski_offset, desired.ski_turn
        self._load_moment[k] = effort.load_moment
        self._interval[k] = self._reference.interval(progress)
        self._led_astray[k] = balance.replanned or controller.slide.active
        com_velocity, solution = dynamics.com_velocity, effort.solution
        speed = math.sqrt(com_velocity @ com_velocity)
        numbers = (time, progress, speed, effort.root_residual, balance.steering.offset, balance.margin)
        arrays = (
            *(dynamics.qpos, dynamics.qvel, effort.torque, ratio, effort.end_stop, effort.ski_force),
            *(effort.edge_normal, effort.edge_side, command.edge_angle, dynamics.com, push, balance.push),
        )
        self.recorder.add(numbers, arrays, (0, 0, solution.iterations, solution.status, solution.attempts))
        if k == BATCH - 1:
            self._work_out()
            self._begin = self.recorder.count

    def recording(self, header: dict[str, object]) -> Recording:
        """Return everything logged so far under `header`."""
        self._work_out()
        return self.recorder.recording(header)

    def _work_out(self) -> None:
        """Fill in the rest of the batch so far."""
        recorder, begin = self.recorder, self._begin
        n = recorder.count - begin
        if n == 0:
            return
        value, columns, model = self._value[:n], self._columns, self._model
        skis = SkiStates(self._place[:n], self._rotation[:n], self._quaternion[:n])
        com, normal = recorder.rows("com", begin), value[:, columns["normal"]]
        error = self.gauge.corner_error(skis.rotation, self._offset[:n], self._turn[:n])
        if self._led_astray[:n].any():
            error = np.where(self._led_astray[:n], self.gauge.planned_error(value, skis), error)
        load = recorder.rows("snow_edge_force", begin).sum(axis=2)
        edge_angle = recorder.rows("edge_angle", begin)
        zmp = self.gauge.zero_moment_point(skis, load, self._load_moment[:n], edge_angle, normal)
        hinges = recorder.rows("qpos", begin)[:, model.actuated_qpos]
        margin = np.minimum(hinges - model.joint_lower, model.joint_upper - hinges).min(axis=1)
        worked_out = {
            "inclination": self._inclination(value, skis.place, com),
            "ski_error": error,
            "com_error": np.sqrt(np.sum((com - value[:, columns["com"]]) ** 2, axis=1)),
            "joint_margin": margin,
            "track_offset": self.gauge.track_offset(value, skis.place, com),
            "zmp": zmp[:, :2],
            "zmp_margin": zmp[:, 2],
            "phase": self._labels[0][self._interval[:n]],
            "turn": self._labels[1][self._interval[:n]],
        }
        planned = {name: value[:, columns[column]] for name, column in PLANNED.items()}
        recorder.fill(begin, worked_out | planned)

    def _inclination(self, value: np.ndarray, place: np.ndarray, com: np.ndarray) -> np.ndarray:
        """Return the lean (n,) [rad] of the centre of mass over the skis, wherever these are."""
        columns = self._columns
        planned = value[:, columns["ski_position"]].reshape(-1, 2, 3)
        aside = 0.5 * np.sum(place - planned, axis=1)
        over = com - value[:, columns["track_position"]] - aside
        left, up = (np.sum(over * value[:, columns[name]], axis=1) for name in ("across", "normal"))
        return np.arctan2(left, up)


def present_errors(log: StepLog, command: Command, controller: Controller) -> tuple[float, float]:
    """Return the largest error of a ski corner from where it is steered, and the skis' distance from the track [m]."""
    dynamics, desired = controller.dynamics, controller.desired
    place, rotation = dynamics.ski_places[None], dynamics.ski_rotations[None]
    error = log.gauge.corner_error(rotation, desired.ski_offset[None], desired.ski_turn[None])
    offset = log.gauge.track_offset(command.sample[:1], place, dynamics.com[None])
    return float(error[0]), float(offset[0, 0])
