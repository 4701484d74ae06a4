"""The turning body: an inverted pendulum whose support is steered [VP93 sec. 3, Appendix A].

A lean cannot be commanded: it comes about because the support turns away from under the body. `lean_acceleration`
says what a curvature of the support's path does to the lean, `curvature_for` which curvature brings a wanted
acceleration about. Everything works on arrays, so that thousands of bodies are one call.

Signs: lean, curvature and heading are positive to the left. Gravity may have a part across the path
(`gravity_across`, positive to the left), as in a traverse; with none and `gravity_normal` = g this is the flat
ground of the paper.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..gravity import STANDARD_GRAVITY

Array = np.ndarray


@dataclass(frozen=True)
class TurningBody:
    """What leans: mass on a leg, and how its support can be steered.

    `leg_length` [m] from support to centre of mass; `inertia` [m^2] about the centre of mass and the direction of
    travel, per mass (I / m); `curvature_bound` [1/m] and `curvature_rate_bound` [1/m/s] of the support's path.
    Fields may be arrays that broadcast against the state: one body each.
    """

    leg_length: Array | float = 1.0
    inertia: Array | float = 0.0
    curvature_bound: Array | float = 0.3
    curvature_rate_bound: Array | float = 1.0

    def lean_acceleration(
        self,
        lean: Array,
        curvature: Array,
        speed: Array | float,
        gravity_normal: Array | float = STANDARD_GRAVITY,
        gravity_across: Array | float = 0.0,
    ) -> Array:
        """Return the acceleration of `lean` [rad/s^2] while the support curves with `curvature` [1/m] [VP93 Eq. 2].

        `speed` [m/s] is that of the centre of mass.
        """
        pull = gravity_normal * np.sin(lean) + gravity_across * np.cos(lean)
        return steered_acceleration(
            pull, np.sin(lean), np.cos(lean), curvature, speed, self.leg_length, self.effective_length
        )

    def curvature_for(
        self,
        lean: Array,
        acceleration: Array,
        speed: Array | float,
        gravity_normal: Array | float = STANDARD_GRAVITY,
        gravity_across: Array | float = 0.0,
    ) -> Array:
        """Return the curvature [1/m] that accelerates `lean` by `acceleration` [rad/s^2]; bounds are not applied.

        The printed quadratic [VP93 Eq. 1] has the factor (1 - C l sin lean) too many: one root is always
        1 / (l sin lean), the centre of mass on the turn's axis. This is the other root, in closed form; it is 0 for
        an upright body at rest, where the printed formula divides by 0.
        """
        pull = gravity_normal * np.sin(lean) + gravity_across * np.cos(lean)
        push = pull - acceleration * self.effective_length
        return push / (push * self.leg_length * np.sin(lean) + np.square(speed) * np.cos(lean))

    def leg_force(
        self,
        lean: Array,
        lean_rate: Array,
        curvature: Array,
        speed: Array | float,
        gravity_normal: Array | float = STANDARD_GRAVITY,
        gravity_across: Array | float = 0.0,
    ) -> tuple[Array, Array]:
        """Return the ground's force on the support per mass [m/s^2]: to the left, and along the ground's normal.

        [VP93 Eqs. 14-18] with the centrifugal term of Eq. 17 mended: curving to the left accelerates to the left.
        """
        sine, cosine = np.sin(lean), np.cos(lean)
        length = self.leg_length
        acceleration = self.lean_acceleration(lean, curvature, speed, gravity_normal, gravity_across)
        support = support_speed(lean, curvature, speed, length)
        left = (
            np.square(support) * curvature * (1.0 - curvature * length * sine)
            + length * cosine * acceleration
            - length * sine * np.square(lean_rate)
        )
        up = -length * sine * acceleration - length * cosine * np.square(lean_rate)
        return left - gravity_across, up + gravity_normal

    @property
    def effective_length(self) -> Array | float:
        """(I + m l^2) / (m l) [m]."""
        return self.leg_length + self.inertia / self.leg_length


def steered_acceleration(pull: Any, sine: Any, cosine: Any, curvature: Any, speed: Any, leg: Any, length: Any) -> Any:
    """Return the lean's acceleration [rad/s^2] [VP93 Eq. 2], of numbers as of arrays.

    `pull` [m/s^2] is gravity across the leg, `sine` and `cosine` those of the lean, `leg` and `length` [m] the body's
    `leg_length` and `effective_length`.
    """
    return (pull - curvature * speed * speed * cosine / (1.0 - curvature * leg * sine)) / length


def support_speed(lean: Array, curvature: Array, speed: Array | float, leg_length: Array | float) -> Array:
    """Return the speed [m/s] of the support when the centre of mass moves with `speed` [VP93 Eq. 21]."""
    return speed / (1.0 - curvature * leg_length * np.sin(lean))
