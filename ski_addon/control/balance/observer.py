"""Feeling a push: what moves the skier that neither muscles, snow nor air explain.

A skier feels how joints and body accelerate. What is left over in the equations of motion,

    tau_outside = M q'' + h - tau - J' f,

is a force from outside, as a generalised force. It is taken from the change of velocity over the last step, with what
was commanded there, and smoothed by a first-order filter.
"""

from __future__ import annotations

import numpy as np

from ..dynamics import Dynamics

SMOOTHING_TIME = 0.005
"""Time constant of the filter [s]."""


class DisturbanceObserver:
    """Estimates the outside generalised force (37,) from step to step: `estimate` [N, N m]."""

    STATE = ("estimate", "_inertia", "_explained", "_velocity", "_known")

    def __init__(self, dynamics: Dynamics, time_step: float) -> None:
        """Watch `dynamics`, which moves on by `time_step` [s] between two calls of `update`."""
        self._dynamics, self._step = dynamics, time_step
        self._share = min(time_step / SMOOTHING_TIME, 1.0)
        size = len(dynamics.bias)
        self.estimate = np.zeros(size)
        self._inertia = np.zeros((size, size))
        self._explained = np.zeros(size)
        self._velocity = np.zeros(size)
        self._known = False

    def update(self) -> np.ndarray:
        """Return the estimate with the step that has just been made; the same array at every call."""
        if self._known:
            change = (self._dynamics.velocity - self._velocity) / self._step
            outside = self._inertia @ change
            outside -= self._explained
            outside -= self.estimate
            outside *= self._share
            self.estimate += outside
        return self.estimate

    def commanded(self, torque: np.ndarray, snow: np.ndarray) -> None:
        """Note the hinge torques (31,) [N m] and the snow's generalised force (37,) of the step to come."""
        dynamics = self._dynamics
        np.copyto(self._inertia, dynamics.inertia)
        np.copyto(self._velocity, dynamics.velocity)
        np.subtract(snow, dynamics.bias, out=self._explained)
        self._explained[6:] += torque
        self._known = True
