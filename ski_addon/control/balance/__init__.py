"""Balance on line: feel a push, steer the skis under the body, return to the plan."""

from .balance import Balance
from .observer import DisturbanceObserver
from .preview import Preview
from .regulator import Regulator, Weights, regulator_gains
from .replan import Replanner
from .steering import Reach, Steering, acceleration_bounds

__all__ = [
    "Balance",
    "DisturbanceObserver",
    "Preview",
    "Reach",
    "Regulator",
    "Replanner",
    "Steering",
    "Weights",
    "acceleration_bounds",
    "regulator_gains",
]
