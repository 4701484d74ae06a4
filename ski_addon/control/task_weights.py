"""Weights of the tasks as both forms of the program use them."""

from __future__ import annotations

import numpy as np

from ..body import SkierModel
from .gains import Gains


def ski_weights(gains: Gains, length: float, width: float) -> np.ndarray:
    """Return the weights (6,) of a ski's linear acceleration and of its angular one in its own axes.

    They equal the paper's four corners [SG19 Eq. 32] of a ski of `length` and `width` [m], but for the roll's.
    """
    corner = gains.ski.weight
    return np.array(
        [*[4 * corner] * 3, gains.edging.weight, corner * length**2, corner * (length**2 + width**2)], dtype=float
    )


def posture_weights(model: SkierModel, gains: Gains) -> tuple[np.ndarray, np.ndarray]:
    """Return the weights (37,) of the accelerations themselves, and the places (12,) of the legs' among them."""
    weights = np.full(len(model.body_dof), gains.pose.weight)
    weights[:3] = gains.root_position
    weights[3:6] = gains.pelvis.weight
    legs = np.isin(model.body_dof, model.leg_dof)
    weights[legs] = gains.leg_pose.weight
    return weights, np.flatnonzero(legs)
