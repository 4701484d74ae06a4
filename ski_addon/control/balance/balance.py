"""Staying up: what is measured, decided and re-planned at every step."""

from __future__ import annotations

import math

import numpy as np

from ...planning import Reference
from ...snow import edge_bearing
from ..dynamics import Dynamics
from ..motion import Motion
from .deviation import Deviation, DeviationGauge
from .observer import DisturbanceObserver
from .preview import Preview, lean_offset
from .regulator import Regulator
from .replan import Replanner
from .steering import Reach, Steering, acceleration_bounds

BEGIN_FROM, BEGIN_TO = 0.025, 0.06
"""Distance from the plan [m] over which re-planning fades in; below it the plan is followed as it is."""
END_FROM, END_TO = 0.006, 0.02
"""Distance from the plan [m] over which it fades out again."""
PUSH_LASTS = 0.129
"""Time [s] for which a push is expected to go on."""
SLIDING_ACCELERATION = 5.0
"""Most acceleration [m/s^2] with which legs shift skis that slide across the track."""
UNFELT = 0.01
"""Forces and moments from outside below this [N, N m] are none."""
LEAST_TIPPING = 0.05
"""A push that turns the body over by less than this [m/s^2] changes nothing by itself."""
EDGE_MARGIN = 0.015
"""Distance [m] the load's middle keeps from the outermost bearing edges."""


class Balance:
    """Re-plans the near future when the skier is off the plan.

    After `update`: `replanned`, whether the motion was changed, and how far, `blend` 0..1; `margin` [m] the capture
    margin, `divergent` [m] the divergent component off what the plan asks, `push` (3,) [N, world] the force from
    outside as felt, and `steering` with the line of the skis.
    """

    STATE = ("blend", "observer", "steering")

    def __init__(
        self, dynamics: Dynamics, reference: Reference, motion: Motion, time_step: float, *, replans: bool
    ) -> None:
        """Set up for one skier on one reference, called every `time_step` [s]; without `replans` it only measures."""
        self._replans = replans
        self._dynamics, self._motion = dynamics, motion
        self.preview = Preview(reference)
        self.observer = DisturbanceObserver(dynamics, time_step)
        self.steering = Steering(Regulator(), time_step)
        self._gauge = DeviationGauge(motion, dynamics)
        self._replanner = Replanner(motion, dynamics)
        skeleton = dynamics.model.skeleton
        self._half_stance, self._half_width = 0.5 * skeleton.stance_width, 0.5 * skeleton.ski_width
        self.blend = self.margin = 0.0
        self.replanned = False
        self.push = np.zeros(3)
        self.divergent = 0.0

    def update(
        self, progress: float, rate: float, sample: np.ndarray, edge_angle: np.ndarray, sliding: float = 0.0
    ) -> None:
        """Measure, decide, and change the motion where it must be. `edge_angle` (2,) [rad] of the skis as they are;
        `sliding` 0..1 says how far they are thrown across the track, where they are shifted, not steered.
        """
        columns, steering = self._motion.columns, self.steering
        outside = self.observer.update()
        deviation = self._gauge.measure()
        omega, even = self.preview.at(progress, rate, steering.offset)
        wanted = lean_offset(even, deviation.planned_y, deviation.planned_h)
        push, tipping = self._felt_push(outside, deviation)
        reach = self._reach(deviation, edge_angle, sliding)
        raw = deviation.y + deviation.y_rate / omega - wanted
        expected = raw + PUSH_LASTS * push / omega
        self.margin = steering.capture_margin(raw, omega, reach)
        self.divergent = raw
        if not self._replans:
            return
        self._dynamics.outside = outside
        self.blend = self._blend_after(expected, wanted, omega)
        steering.update(self.blend * expected, omega, reach)
        self.replanned = self.blend > 0.0 or abs(steering.offset) > 1e-9 or abs(tipping) > LEAST_TIPPING
        if self.replanned:
            planned = float(self._motion.value[columns["across"]] @ sample[2, columns["com"]])
            self._replanner.apply(self.blend, steering, deviation, planned, push, tipping, 1.0 - sliding)
        steering.advance()

    def _blend_after(self, expected: float, wanted: float, omega: float) -> float:
        """Return how far to re-plan.

        It begins late, when the load can no longer be shifted far enough by itself, and ends late, when the skier is
        where the plan is right again: one who is faster than planned is off the plan where he should be.
        """
        steering = self.steering
        line = steering.offset * steering.offset + (steering.rate / omega) ** 2
        begun = _faded(math.sqrt(expected * expected + line), BEGIN_FROM, BEGIN_TO)
        ended = _faded(math.sqrt(expected * expected + wanted * wanted + line), END_FROM, END_TO)
        return max(begun, min(self.blend, ended))

    def _felt_push(self, outside: np.ndarray, deviation: Deviation) -> tuple[float, float]:
        """Return the sideways acceleration [m/s^2] that a push from outside gives the pendulum, and the one by which it
        turns the body over, both positive to the left.

        A push below the centre of mass also turns the body the other way; what the snow takes by that is left out of
        account. Above it the body is let turn.
        """
        dynamics, motion = self._dynamics, self._motion
        self.push[:] = outside[:3]
        if float(outside[:6] @ outside[:6]) < UNFELT * UNFELT:
            return 0.0, 0.0
        arm = dynamics.com - dynamics.body_position(1)
        moment = dynamics.root_rotation @ outside[3:6]
        ax, ay, az = arm.tolist()
        fx, fy, fz = outside[:3].tolist()
        along = motion.value[motion.columns["along"]].tolist()
        rolling = (
            (float(moment[0]) - (ay * fz - az * fy)) * along[0]
            + (float(moment[1]) - (az * fx - ax * fz)) * along[1]
            + (float(moment[2]) - (ax * fy - ay * fx)) * along[2]
        )
        mass = dynamics.model.mass
        straight = float(motion.value[motion.columns["across"]] @ outside[:3]) / mass
        tipping = -rolling / (mass * max(deviation.h, 0.2))
        whole = straight + tipping
        if straight * whole <= 0.0:
            return 0.0, tipping
        return (whole if abs(whole) < abs(straight) else straight), tipping

    def _reach(self, deviation: Deviation, edge_angle: np.ndarray, sliding: float) -> Reach:
        left = right = 0.0
        for angle in edge_angle.tolist():
            bears_left, bears_right = edge_bearing(angle)
            left += bears_left - 0.5
            right += bears_right - 0.5
        left_reach = self._half_stance + self._half_width * left - EDGE_MARGIN
        right_reach = self._half_stance + self._half_width * right - EDGE_MARGIN
        speed = deviation.speed - self.steering.offset * deviation.turning
        centripetal = deviation.centripetal - self.steering.offset * deviation.turning * deviation.turning
        least, most = acceleration_bounds(abs(speed), centripetal)
        least -= sliding * (least + SLIDING_ACCELERATION)
        most -= sliding * (most - SLIDING_ACCELERATION)
        return Reach(-right_reach, left_reach, least, most, abs(speed))


def _faded(value: float, low: float, high: float) -> float:
    """Return 0 up to `low`, 1 from `high` on, and a smooth step between."""
    x = min(max((value - low) / (high - low), 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)
