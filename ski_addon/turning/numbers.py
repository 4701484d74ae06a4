"""One formula for one body and for thousands: the functions that differ between plain numbers and arrays."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Numbers:
    """Functions of one kind of number. Plain numbers are ten times quicker than arrays of one."""

    sin: Callable[[Any], Any]
    cos: Callable[[Any], Any]
    tan: Callable[[Any], Any]
    least: Callable[[Any, Any], Any]
    most: Callable[[Any, Any], Any]
    choose: Callable[[Any, Any, Any], Any]

    def held(self, value: Any, low: Any, high: Any) -> Any:
        """Return `value`, or the limit it is beyond."""
        return self.least(self.most(value, low), high)


def _choose(condition: bool, one: Any, other: Any) -> Any:
    return one if condition else other


ARRAYS = Numbers(np.sin, np.cos, np.tan, np.minimum, np.maximum, np.where)
PLAIN = Numbers(math.sin, math.cos, math.tan, min, max, _choose)
