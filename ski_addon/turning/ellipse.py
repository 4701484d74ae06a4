"""Phase control: how to lean so that a swing comes onto the ellipse that is asked for, from any state [VP93 sec. 5.1].

The phase diagram has the lean rate along x and the lean along y; a swing goes round it counter-clockwise there, and
its phase is the angle from the x axis: 0 upright on the way to the left, 90 degrees at the greatest lean to the left.
A state lies on exactly one ellipse that shares the lean axis with the target, and on one that shares the rate axis.
Going out (quadrants 1 and 3) the first is followed, to the target's greatest lean; coming back (2 and 4) the second, to
the target's rate when upright. So the target is met within a quarter of a turn if no bound is in the way.

The printed text leaves two axes singular and has a sign wrong; see `wanted_acceleration`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .numbers import ARRAYS, Numbers


@dataclass(frozen=True)
class ControlBounds:
    """What the paper leaves open [reading j].

    `acceleration` [rad/s^2] of the lean outside the box around the target's ellipse (alpha_max); within `origin`, a
    share of the ellipse, the body is sent off to the side it moves to (or is to turn to) with `kick` times the target's
    own greatest acceleration; controlling ellipses are between `slowest` and `quickest` times as quick as the target.
    Both families of ellipses go on outside the box: those of going out to larger rates, those of coming back to larger
    leans. They are followed to `reach` times the box. Where no ellipse leads, alpha_max takes over within `margin`, a
    share of the box, so that it does not switch on and off along the border. `rounding` is added to both distances of a
    controlling ellipse, shares of the unit circle: both are 0 on an axis of the diagram, where their ratio is 1 on the
    target itself.
    """

    acceleration: float = 6.0
    origin: float = 0.25
    kick: float = 1.0
    slowest: float = 0.5
    quickest: float = 2.0
    reach: float = 1.5
    margin: float = 0.05
    rounding: float = 0.01


def wanted_acceleration(
    lean: Any,
    lean_rate: Any,
    frequency: Any,
    sharpness: Any,
    bounds: ControlBounds,
    side: Any = 1.0,
    numbers: Numbers = ARRAYS,
) -> Any:
    """Return the lean's acceleration [rad/s^2] towards the ellipse of `frequency` [rad/s] and `sharpness` [rad].

    `side` (+1 left, -1 right) is where a body at rest is sent. Mended against the text:

    - [reading d] the cosine and sine in the controlling ellipses are those of the phase on themselves,
      sqrt(1 - (lean / sharpness)^2) and sqrt(1 - (rate / (frequency sharpness))^2);
    - [reading e] the lean axis belongs to quadrants 2 and 4 and the rate axis to 1 and 3, and no controlling ellipse is
      much quicker or slower than the target: as printed a body at rest with a lean would stay there for ever;
    - [reading f] a body that leans too far is pulled back whatever it does; the printed rule, which brakes the rate,
      is for rates that are too large: as printed it would push a body that is coming back away again.
    """
    choose, most = numbers.choose, numbers.most
    x, y = lean_rate / (frequency * sharpness), lean / sharpness
    x_square, y_square = x * x, y * y
    inside_x, inside_y = most(1.0 - x_square, 0.0), most(1.0 - y_square, 0.0)
    outward = (x * y >= 0.0) & (x != 0.0)
    square = choose(
        outward,
        (x_square + bounds.rounding) / (inside_y + bounds.rounding),
        (inside_x + bounds.rounding) / (y_square + bounds.rounding),
    )
    square = numbers.held(square, bounds.slowest * bounds.slowest, bounds.quickest * bounds.quickest)
    own, edge = frequency * frequency, 2.0 * bounds.margin + bounds.margin * bounds.margin
    out = -own * square * lean
    beyond = bounds.reach * bounds.reach
    first, last = choose(outward, beyond, 1.0), choose(outward, 1.0, beyond)  # where ellipses cease to lead
    for place, over in ((x, x_square - first), (y, y_square - last)):
        brake = choose(place > 0.0, -bounds.acceleration, bounds.acceleration)
        out = out + numbers.held(over / edge, 0.0, 1.0) * (brake - out)
    faint = 0.1 * bounds.origin
    going = choose(x > faint, 1.0, choose(x < -faint, -1.0, side))
    still = x_square + y_square < bounds.origin * bounds.origin
    return choose(still, going * bounds.kick * own * sharpness, out)


def as_printed(
    lean: np.ndarray, lean_rate: np.ndarray, frequency: float, sharpness: float, bounds: ControlBounds
) -> np.ndarray:
    """Return alpha [rad/s^2] as the paper's text has it, to compare [readings e, f].

    Its singular axes are not capped, and it has one rule for the outside.
    """
    x, y = lean_rate / (frequency * sharpness), lean / sharpness
    outward = x * y > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = np.where(outward, np.sqrt(np.maximum(1.0 - y * y, 0.0)), 1.0)
        own = np.where(outward, lean_rate / (sharpness * cosine), 0.0)
        sine = np.sqrt(np.maximum(1.0 - x * x, 0.0))
        back = frequency * sine * sharpness / lean
        out = -np.square(np.where(outward | (x == 0.0), own, back)) * lean
    outside = (np.abs(x) > 1.0) | (np.abs(y) > 1.0)
    return np.where(outside, np.where(x < 0.0, 1.0, -1.0) * bounds.acceleration, out)
