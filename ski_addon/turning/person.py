"""The person of a run as a turning body."""

from __future__ import annotations

from ..spec import RunSpec
from .body import TurningBody

CENTRE_HEIGHT = 0.49
"""Height of a skier's centre of mass over the snow for each metre of body height, on boots and bent knees."""


def leg_length(spec: RunSpec) -> float:
    """Return the height [m] of the person's centre of mass over the snow."""
    return CENTRE_HEIGHT * spec.skier.height


def body_of(spec: RunSpec) -> TurningBody:
    """Return the turning body of a run's person: all mass at the height of a skier's centre of mass."""
    return TurningBody(leg_length=leg_length(spec))
