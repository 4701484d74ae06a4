"""What a hinge may do at one moment: accelerations that keep it in its range, torques of muscles and end stops."""

from __future__ import annotations

import numpy as np

from ..body import SkierModel
from .dynamics import Dynamics
from .gains import ACCELERATION_LIMIT, END_STOP_STRENGTH, JOINT_LIMIT_TIME, RANGE_MARGIN


class HingeRanges:
    """Bounds of the 31 hinges at the state of the last `update`.

    `lower`, `upper` (31,) [rad/s^2] of accelerations; `torque_lower`, `torque_upper` (31,) [N m], the muscles' own
    and, for hinges on their way past the end of their range, what the end stop gives besides: `end_stops` (2, 31)
    [N m] to be taken from the lower and added to the upper one.
    """

    def __init__(self, model: SkierModel) -> None:
        """Allocate for the hinges of `model`."""
        self._model = model
        self._least, self._most = model.joint_lower + RANGE_MARGIN, model.joint_upper - RANGE_MARGIN
        self._end_stop = END_STOP_STRENGTH * np.maximum(-model.torque_lower, model.torque_upper)
        self.torque_lower, self.torque_upper = model.torque_lower.copy(), model.torque_upper.copy()
        hinges = len(self._least)
        self.lower, self.upper = np.zeros(hinges), np.zeros(hinges)
        self.end_stops = np.zeros((2, hinges))
        self._stopping = False

    def update(self, dynamics: Dynamics) -> None:
        """Set the bounds at the present state."""
        model, lower, upper, stops = self._model, self.lower, self.upper, self.end_stops
        reached = dynamics.qpos[model.actuated_qpos] + JOINT_LIMIT_TIME * dynamics.velocity[6:]
        np.subtract(self._least, reached, out=lower)
        np.subtract(self._most, reached, out=upper)
        # critically damped: a hinge comes to rest at its end and does not swing past it
        stopping = float(lower.max()) > 0.0 or float(upper.min()) < 0.0
        if stopping or self._stopping:
            np.multiply(self._end_stop, upper < 0.0, out=stops[0])
            np.multiply(self._end_stop, lower > 0.0, out=stops[1])
            np.subtract(model.torque_lower, stops[0], out=self.torque_lower)
            np.add(model.torque_upper, stops[1], out=self.torque_upper)
            self._stopping = stopping
        for bound in (lower, upper):
            bound *= 4.0 / JOINT_LIMIT_TIME**2
            np.maximum(bound, -ACCELERATION_LIMIT, out=bound)
            np.minimum(bound, ACCELERATION_LIMIT, out=bound)

    def end_stop(self, torque: np.ndarray) -> np.ndarray:
        """Return what of `torque` (31,) [N m] the muscles cannot give, and the end stops do."""
        if not self._stopping:
            return np.zeros(len(torque))
        return torque - np.clip(torque, self._model.torque_lower, self._model.torque_upper)
