"""The largest push that anybody could survive: the capture bound of a pendulum on skis that can be steered."""

from __future__ import annotations

import math

import numpy as np

from ..body import forward_kinematics
from ..body.skeleton import Skeleton
from ..gravity import GRAVITY
from ..planning import MotionPlan

CURVATURE_MAX = 0.25
"""Tightest path a ski can be steered to [1/m]."""
ACCELERATION_MAX = 12.0
"""Most sideways acceleration of the skis [m/s^2]."""
TURN_RATE_MAX = 3.0
"""Fastest change of the skis' heading [rad/s]."""
DELAY = 0.1
"""Time [s] from the start of a push until the skis go their new way."""
LEAST_LEVER = 0.25
"""A push below this share of the centre of mass's height does not tip anybody: it has no bound of this kind."""


def capture_bound(height: float, gravity: float, reach: float, sideways: float, duration: float, mass: float) -> float:
    """Return the largest force [N] at the centre of mass, sideways for `duration` [s], that can be survived.

    Let y be the sideways distance of the centre of mass from the planned path, E that of the skis, and s that of the
    point under the skis where the snow's force acts from their middle, at most `reach` [m]. With w^2 = `gravity` /
    `height`, small leans give y'' = w^2 (y - E - s) + F / m. Of the two parts of this motion only
    x = y + y' / w grows by itself: x' = w (x - E - s) + F / (m w). Multiplied by exp(-w t) and integrated from rest,

        x(t) exp(-w t) = integral of exp(-w t) (F / (m w) - w (E + s)),

    and x stays bounded only if the right side does not stay positive for ever. A push of the duration T contributes
    F (1 - exp(-w T)) / (m w^2). The best answer to it is s = `reach` at once, which contributes -`reach`, and skis that
    from a delay d on move sideways with the acceleration a = `sideways` [m/s^2], E = a (t - d)^2 / 2, which
    contributes -a exp(-w d) / w^2. So

        F <= (m w^2 reach + m a exp(-w d)) / (1 - exp(-w T)).
    """
    w = math.sqrt(gravity / height)
    held = mass * w * w * reach + mass * sideways * math.exp(-w * DELAY)
    return held / (1.0 - math.exp(-w * duration))


def push_bound(
    plan: MotionPlan, place: int, skeleton: Skeleton, body: str, direction: str, duration: float
) -> float | None:
    """Return the capture bound [N] of a push on `body` at the `place` (index) of a plan, or None if it has none.

    Forward, backward, upward and downward pushes have none (the skis glide along under the body), nor has one near
    the snow. The body is taken not to turn: a push at z_F then tips as much as z_F / z_c times one at the centre of
    mass. While it leans into a turn a skier stands on the edges of one side.
    """
    if direction not in ("left", "right"):
        return None
    side = 1.0 if direction == "left" else -1.0
    normal = plan.surface_normal[place]
    position, rotation = forward_kinematics(skeleton, plan.pose[place : place + 1])
    index = skeleton.body(body)
    pushed = position[0, index] + rotation[0, index] @ skeleton.com[index]
    height = float((plan.com[place] - plan.position[place]) @ normal)
    lever = float((pushed - plan.position[place]) @ normal) / height
    if lever < LEAST_LEVER:
        return None
    speed, bend = float(plan.speed[place]), float(plan.curvature[place])
    most = min(CURVATURE_MAX * speed**2, ACCELERATION_MAX, TURN_RATE_MAX * speed)
    sideways = max(most - side * bend * speed**2, 0.0)
    lean = float(plan.inclination[place])
    outside = abs(lean) > np.deg2rad(3.0) and side * lean < 0.0  # then only the edges of the inside carry
    half_width = 0.5 * skeleton.ski_width
    reach = 0.5 * skeleton.stance_width + (-half_width if outside else half_width)
    mass = float(skeleton.mass.sum())
    return capture_bound(height, float(-(normal @ GRAVITY)), reach, sideways, duration, mass) / lever
