"""How far a turn turns, and how to change it so that the body comes out in a wanted direction [VP93 sec. 5.2].

A body that swings on an ellipse of sharpness a and frequency w changes its direction in half a swing by

    D(a, w) = (g / w A(a) + w L B(a)) / V        A(a) = int tan(a sin t) dt,  B(a) = int a sin t / cos(a sin t) dt

over t from 0 to pi, with L = (I + m l^2) / (m l): the support's speed times its curvature is the push on the leg over
V cos(lean), whatever the curvature. So the paper's table of D over frequency and sharpness is two columns of one
variable, and the speed scales it. For small leans A = B = 2 a, which gives Eqs. 11 and 12.
"""

from __future__ import annotations

import functools

import numpy as np

from ..gravity import STANDARD_GRAVITY
from .body import TurningBody

Array = np.ndarray

SHARPEST = np.deg2rad(80.0)
"""Last entry of the table [rad]."""
_ENTRIES = 1601


@functools.cache
def _table() -> tuple[Array, Array, Array]:
    """Return sharpness (n,) [rad], evenly from 0, and the two integrals of the module over half a swing there."""
    sharpness = np.linspace(0.0, SHARPEST, _ENTRIES)
    node, weight = np.polynomial.legendre.leggauss(48)
    sine = np.sin(0.25 * np.pi * (node + 1.0))
    lean = sharpness[:, None] * sine
    scale = 0.5 * np.pi * weight  # twice a quarter of the swing
    table = sharpness, np.tan(lean) @ scale, (lean / np.cos(lean)) @ scale
    for column in table:
        column.setflags(write=False)
    return table


def heading_change(
    body: TurningBody,
    sharpness: Array | float,
    frequency: Array | float,
    speed: Array | float,
    gravity_normal: Array | float = STANDARD_GRAVITY,
) -> Array:
    """Return by how much [rad] half a swing of `sharpness` [rad] and `frequency` [rad/s] changes the direction.

    [VP93 Eq. 6], from the table; `speed` [m/s] is that of the centre of mass.
    """
    grid, tangent, sway = _table()
    length = body.leg_length + body.inertia / body.leg_length
    pull = np.interp(sharpness, grid, tangent) * gravity_normal / frequency
    return (pull + np.interp(sharpness, grid, sway) * frequency * length) / speed


def small_lean_modifier(
    change: Array | float,
    sharpness: Array | float,
    frequency: Array | float,
    speed: Array | float,
    side: Array | float = 1.0,
    gravity_normal: Array | float = STANDARD_GRAVITY,
) -> Array:
    """Return beta for a turn to `side` (+1 left, -1 right) that changes the heading by `change` [rad], positive left.

    [VP93 Eqs. 11 and 12], good for leans of a few degrees. A change beyond what a straight "turn" gives has no beta
    [reading g]; it is 0 there.
    """
    square = 1.0 + side * change * speed * frequency / (2.0 * gravity_normal * sharpness)
    return np.sqrt(np.maximum(square, 0.0))


def turn_modifier(
    body: TurningBody,
    turn: Array,
    sharpness: Array,
    frequency: Array,
    speed: Array,
    rate: Array | None = None,
    drift: Array | float = 0.0,
    gravity_normal: Array | float = STANDARD_GRAVITY,
    limits: tuple[float, Array | float] = (0.3, 2.0),
) -> tuple[Array, Array]:
    """Return beta (n,), with which the coming half swing turns by `turn` (n,) [rad], positive to its own side.

    [VP93 Eq. 8] solved by Newton's method on the table. The half swing that beta makes of the target has sharpness
    beta a and frequency w / beta; a body that comes upright with another lean rate than the target's, `rate` (n,)
    [rad/s], takes the first quarter on a controlling ellipse, which is counted. `drift` (n,) [rad/s] is how fast
    something else, as gravity across the path, turns it to the same side meanwhile. Beta is held within `limits`
    [reading g]: the rest of the change, which comes second (n,) [rad], is left to later turns.
    """
    upright = frequency * sharpness if rate is None else np.abs(rate)
    low, high = limits
    wide = np.minimum(high, SHARPEST / sharpness)
    beta = np.clip(np.ones_like(sharpness), low, wide)
    for _ in range(8):
        found, slope = _turned(body, beta, sharpness, frequency, upright, speed, drift, gravity_normal)
        step = (turn - found) / slope
        beta = np.clip(beta + step, low, wide)
        if np.max(np.abs(step), initial=0.0) < 1e-6:
            break
    found, _ = _turned(body, beta, sharpness, frequency, upright, speed, drift, gravity_normal)
    return beta, turn - found


def half_swing(beta: Array, sharpness: Array, frequency: Array, rate: Array) -> Array:
    """Return how long [s] the half swing lasts that `turn_modifier` speaks of."""
    return 0.5 * np.pi * beta * (sharpness / rate + 1.0 / frequency)


def _turned(
    body: TurningBody,
    beta: Array,
    sharpness: Array,
    frequency: Array,
    rate: Array,
    speed: Array,
    drift: Array | float,
    gravity_normal: Array | float,
) -> tuple[Array, Array]:
    """Return how far [rad] a half swing modified by `beta` turns, and the derivative of that with respect to beta.

    Both quarters have sharpness beta a; their frequencies go with 1 / beta.
    """
    grid, tangent, sway = _table()
    length = body.leg_length + body.inertia / body.leg_length
    place = beta * sharpness / grid[1]
    index = np.clip(place.astype(int), 0, len(grid) - 2)
    share = place - index
    pull_rise, sway_rise = tangent[index + 1] - tangent[index], sway[index + 1] - sway[index]
    pull, swing = tangent[index] + share * pull_rise, sway[index] + share * sway_rise
    slow, quick = 0.5 * (sharpness / rate + 1.0 / frequency), 0.5 * (rate / sharpness + frequency)
    by_pull, by_sway, rise = gravity_normal * slow / speed, length * quick / speed, sharpness / grid[1]
    found = by_pull * beta * pull + by_sway * swing / beta + np.pi * slow * drift * beta
    slope = by_pull * (pull + beta * pull_rise * rise) + by_sway * (sway_rise * rise - swing / beta) / beta
    return found, slope + np.pi * slow * drift
