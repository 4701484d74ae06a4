"""How fast a run is to be skied."""

from __future__ import annotations

import math

from ..spec import RunSpec


def speed_to_hold(spec: RunSpec) -> float:
    """Return the speed [m/s] that the skier keeps to by braking; infinite where nobody asks for one."""
    limits = [limit for limit in (spec.technique.speed_limit, spec.course.target_speed) if not isinstance(limit, str)]
    return min(limits, default=math.inf)
