"""Gravity, the same everywhere."""

from __future__ import annotations

import numpy as np

STANDARD_GRAVITY = 9.81
"""Gravity's size [m/s^2]; a body weight is mass times this."""
GRAVITY = np.array([0.0, 0.0, -STANDARD_GRAVITY])
"""Gravity in the world frame [m/s^2]; read-only."""
GRAVITY.setflags(write=False)
