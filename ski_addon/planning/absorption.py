"""Bump skiing: legs stretch in hollows and bend over crests, so that the body goes nearly straight [SG19 sec. 4.6].

The paper changes the height of the centre of mass by beta_bump times that of the bump under the skis [SG19 Eq. 19],
with beta_bump given by hand. Here the legs' motion is the one that, within their reach, leaves the body the least
vertical acceleration on the ground the skis pass, of whatever kind it is.
"""

from __future__ import annotations

import numpy as np

from ..body import Skeleton
from ..body.skeleton import SIDES
from ..course import Track
from ..course.quadratic import solve_between
from ..gravity import GRAVITY
from ..spec import RunSpec
from .line import PLACES_PER_METRE, Line
from .pendulum import Legs
from .pose import PlannedPoses
from .stance import Stance

SINK_LENGTH, SINK_FACTOR = 1.2, 1.3
"""Standard deviation [m] of the way over which a skier sinks; and how much for each metre that a leg is too short."""
KNOT_TIME, JERK_TIME = 0.03, 0.03
"""Time [s] between the heights that are chosen; time over which the legs' accelerations are smooth."""
SLOWEST_ABSORBED = 1.2
"""Angular frequency [rad/s]: slower waves than this are ridden, not absorbed."""
EVEN_GROUND = 0.05
"""Vertical acceleration [m/s^2] of the skis below which the ground counts as even."""
LEAST_KNEE = np.deg2rad(18.0)
"""Straightest knee of a plan: a straight leg could not be controlled."""
TOLERANCE = 1e-3
"""Length [m] by which a leg may be straighter than that."""


class Sink:
    """How much lower than the stance a skier has to be along a track, so that both legs reach their skis.

    In a deep lean the outside leg has the longer way: skiers bend the inside leg and come down.
    """

    def __init__(self, track: Track) -> None:
        """Start with none."""
        count = max(int(np.ceil(track.length * PLACES_PER_METRE)), 2)
        self.arc_length = np.linspace(0.0, track.length, count + 1)
        self.depth = np.zeros(count + 1)
        self._per_metre = count / track.length

    def deepen(self, arc_length: np.ndarray, missing: np.ndarray) -> bool:
        """Go lower where legs lack `missing` (n,) [m] at `arc_length` (n,) [m]; tell whether they do anywhere."""
        from scipy.ndimage import gaussian_filter1d, maximum_filter1d

        if missing.max() <= TOLERANCE:
            return False
        places = np.interp(self.arc_length, arc_length, missing)
        width = SINK_LENGTH * self._per_metre
        spread = maximum_filter1d(places, 2 * int(np.ceil(3.0 * width)) + 1)
        self.depth = self.depth + SINK_FACTOR * gaussian_filter1d(spread, width)
        return True

    def at(self, arc_length: np.ndarray) -> np.ndarray:
        """Return how deep (n,) [m] to stand at `arc_length` (n,) [m]."""
        return _smoothly(arc_length, self.arc_length, self.depth)


def missing_length(skeleton: Skeleton, poses: PlannedPoses) -> np.ndarray:
    """Return how much (n,) [m] the longer leg exceeds its length at `LEAST_KNEE`; 0 where both legs are bent more."""
    thigh, shank = skeleton.lengths["thigh"], skeleton.lengths["shank"]
    knees = poses.qpos[:, [skeleton.qpos_of(f"shank_y.{side}") for side in SIDES]]
    straightest = thigh**2 + shank**2 + 2.0 * thigh * shank * np.cos(LEAST_KNEE)
    length = np.sqrt(thigh**2 + shank**2 + 2.0 * thigh * shank * np.cos(knees)) + np.maximum(poses.reach_error, 0.0)
    return np.maximum(length - np.sqrt(straightest), 0.0).max(axis=1)


def legs_for(spec: RunSpec, line: Line, stance: Stance, sink: Sink) -> Legs:
    """Return what the legs do along `line`: how they absorb bumps, and how far they may stretch to keep a load."""
    return Legs(
        length=stance.height,
        extension=stance.extension,
        retraction=stance.retraction,
        least_load=spec.technique.load_min,
        rise=absorbing_rise(line, stance, spec.technique.absorption) - sink.at(line.arc_length),
    )


def absorbing_rise(line: Line, stance: Stance, share: float) -> np.ndarray:
    """Return how much higher (n,) [m] than the stance a skier holds the body over the skis to absorb `share` of the
    bumps: of all motions within what the legs can do, the one that leaves the body the least vertical acceleration.
    """
    lifted = -line.pull[:, 2] + line.body_frame[..., 2] @ GRAVITY  # the skis' acceleration along the body's up axis
    count = max(int(np.ceil(float(line.time[-1]) / KNOT_TIME)), 6)
    time = np.linspace(0.0, float(line.time[-1]), count + 1)
    ground = share * np.interp(time, line.time, _blurred(lifted, 0.3 * KNOT_TIME / float(line.time[1])))
    if float(np.max(np.abs(ground))) < EVEN_GROUND:
        return np.zeros_like(line.time)
    rise = _least_lift(ground, float(time[1]), -stance.retraction, stance.extension)
    return _smoothly(line.time, time, rise)


def _least_lift(ground: np.ndarray, step: float, low: float, high: float) -> np.ndarray:
    """Return the heights (n,) [m], `step` [s] apart and within `low`..`high`, that answer the skis' acceleration
    `ground` (n,) [m/s^2] best: the least sum of squares of the body's acceleration, of jerks, and of slow standing
    high or low, which `SLOWEST_ABSORBED` gives up.
    """
    count = len(ground)
    cost, pull = np.zeros((4, count)), np.zeros(count)
    cost[-1] = (SLOWEST_ABSORBED * step) ** 4
    for pattern, weight in (((1.0, -2.0, 1.0), 1.0), ((-1.0, 3.0, -3.0, 1.0), (JERK_TIME / step) ** 2)):
        places = count - len(pattern) + 1
        for i, first in enumerate(pattern):
            for j, second in enumerate(pattern[i:]):
                cost[-1 - j, i + j : i + j + places] += weight * first * second
    for i, part in enumerate((1.0, -2.0, 1.0)):
        pull[i : i + count - 2] -= part * step**2 * ground[1:-1]
    return solve_between(cost, pull, low, high, 1e-9)


def _smoothly(at: np.ndarray, places: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Interpolate by cubic splines: linear pieces would show in the load, which is a second derivative."""
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(places, values)(np.clip(at, places[0], places[-1])))


def _blurred(values: np.ndarray, width: float) -> np.ndarray:
    from scipy.ndimage import gaussian_filter1d

    return np.asarray(gaussian_filter1d(values, width, mode="nearest"))
