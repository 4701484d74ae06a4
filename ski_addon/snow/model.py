"""Snow: how deep an edge penetrates, what shear and friction it gives [SG19 sec. 5, Eq. 20-24].

The controller chooses forces, not depths: the depth occurs in no objective, so it is recovered from the force by
inverting Eq. 20, which also avoids the overstated depth of the paper's linearisation (Eq. 21).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..spec import SkierSpec, SnowSpec

AIR_DENSITY = 1.2
"""Density of air at a ski resort on a cold day [kg/m^3]."""
TUCKED_AWAY = 0.5
"""Share of the drag area that a full tuck takes away."""


@dataclass(frozen=True)
class Snow:
    """Snow under one skier.

    `hardness` H_V [N/m^3], `shear_strength` S_f [N/m^2], `friction` mu_0 and `friction_per_speed` mu_1 [s/m],
    `shear_limit` per ski [N] (infinite: unlimited grip, as in the paper), `drag_factor` = rho CdA / (2 m) [1/m].
    """

    hardness: float
    shear_strength: float
    friction: float
    friction_per_speed: float
    shear_limit: float
    drag_factor: float

    @classmethod
    def of(cls, snow: SnowSpec, skier: SkierSpec, tuck: float = 0.0) -> Snow:
        """Return the snow of a run document for a skier whose drag it also carries; `tuck` 0..1 lessens the drag."""
        limit = np.inf if snow.shear_limit == "unlimited" else float(snow.shear_limit)
        drag = 0.5 * AIR_DENSITY * skier.drag_area * (1.0 - TUCKED_AWAY * tuck) / skier.mass
        return cls(snow.hardness, snow.shear_strength, snow.friction, snow.friction_per_speed, limit, drag)

    def friction_coefficient(self, speed: np.ndarray | float) -> np.ndarray | float:
        """Return mu at `speed` [m/s] [SG19 Eq. 24]."""
        return self.friction + self.friction_per_speed * speed

    def glide_acceleration(self, gravity: float, normal: float, speed: float) -> float:
        """Return dv/dt [m/s^2] along the track.

        `gravity` is gravity's part along the track, `normal` the snow's normal force per mass, both [m/s^2].
        """
        friction = (self.friction + self.friction_per_speed * speed) * normal
        return gravity - friction - self.drag_factor * speed * speed


def penetration_depth(snow: Snow, force: np.ndarray, edge_angle: np.ndarray, length: float, width: float) -> np.ndarray:
    """Return how deep [m] an edge of `length` [m] on a ski of `width` [m] sits in the snow under `force` [N].

    Inverts SG19 Eq. 20: the displaced snow is a triangle under the edge and, once that reaches the ski's far edge, a
    trapezium under its whole base; a flat ski is the limit.
    """
    force = np.maximum(np.asarray(force, dtype=float), 0.0)
    tangent = np.abs(np.tan(np.array(edge_angle, dtype=float, order="C")))
    triangle = np.sqrt(2.0 * force * tangent / (snow.hardness * length))
    trapezium = force / (snow.hardness * length * width) + 0.5 * width * tangent
    return np.where(triangle < width * tangent, triangle, trapezium)
