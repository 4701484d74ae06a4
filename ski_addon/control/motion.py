"""The reference by the skier's own time: what the tasks follow at one moment."""

from __future__ import annotations

import numpy as np

from ..planning import Reference


class Motion:
    """Reference values with their first and second derivatives by time, overwritten by every `read`.

    `table` (3, width) in the columns of `Reference`, with its rows `value`, `velocity` and `acceleration`; `spin` and
    `spin_rate` (9,) [rad/s, rad/s^2, world] of the left ski, the right ski and the pelvis, whose `turning` columns are
    by planned time; `leg_freedom` is a factor on the weight of the legs' pose.
    """

    def __init__(self, reference: Reference) -> None:
        """Allocate for `reference`."""
        self.columns = reference.columns
        width = max(column.stop for column in self.columns.values())
        self.table = np.zeros((3, width))
        self.value, self.velocity, self.acceleration = self.table
        self._powers = np.ones((3, 1))
        self.spin, self.spin_rate = np.zeros(9), np.zeros(9)
        self.leg_freedom = 1.0
        self._turning = self.columns["turning"]

    def read(self, sample: np.ndarray, rate: float) -> Motion:
        """Take over `sample` (3, width) of the reference, passed at `rate`; return itself."""
        self._powers[1, 0], self._powers[2, 0] = rate, rate * rate
        np.multiply(sample, self._powers, out=self.table)
        np.multiply(sample[0, self._turning], rate, out=self.spin)
        np.multiply(sample[1, self._turning], rate * rate, out=self.spin_rate)
        self.leg_freedom = 1.0
        return self
