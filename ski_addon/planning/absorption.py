"""Bump skiing: legs stretch in hollows and bend over crests, so that the body goes nearly straight [SG19 sec. 4.6].

The paper changes the height of the centre of mass by beta_bump times that of the bump under the skis [SG19 Eq. 19],
with beta_bump given by hand. Here the bumps are what the ground has over its own smooth course, whatever its kind, and
the share that is absorbed is as large as the legs allow.
"""

from __future__ import annotations

import numpy as np

from ..body import Skeleton
from ..body.skeleton import SIDES
from ..course import Track
from ..spec import RunSpec
from .line import PLACES_PER_METRE, Line, smooth_normals, smoothed_along
from .pendulum import Legs
from .pose import PlannedPoses
from .stance import Stance

SINK_LENGTH, SINK_FACTOR = 1.2, 1.3
"""Standard deviation [m] of the way over which a skier sinks; and how much for each metre that a leg is too short."""
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


def legs_for(spec: RunSpec, track: Track, heights: np.ndarray, line: Line, stance: Stance, sink: Sink) -> Legs:
    """Return what the legs do along `line`: how they absorb bumps of `heights` (n,) [m] on the track, and how far they
    may stretch to keep a load.
    """
    wanted = -spec.technique.absorption * _smoothly(line.arc_length, track.arc_length, heights)
    high, low = float(np.max(wanted, initial=0.0)), float(np.min(wanted, initial=0.0))
    share = min(1.0, (stance.extension + stance.retraction) / max(high - low, 1e-9))
    lower = max(share * high - stance.extension, 0.0)  # stand deeper, so that hollows can be reached
    return Legs(
        length=stance.height,
        extension=stance.extension,
        retraction=stance.retraction,
        least_load=spec.technique.load_min,
        rise=share * wanted - lower - sink.at(line.arc_length),
    )


def bump_heights(track: Track) -> np.ndarray:
    """Return how high (n,) [m] the snow under the track is over the ground's smooth course.

    Heights are along its normal, so that a plane has none, however the track winds on it.
    """
    over = track.position - smoothed_along(track, track.position)
    return np.sum(over * smooth_normals(track), axis=1)


def _smoothly(at: np.ndarray, places: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Interpolate by cubic splines: linear pieces would show in the load, which is a second derivative."""
    from scipy.interpolate import CubicSpline

    return np.asarray(CubicSpline(places, values)(np.clip(at, places[0], places[-1])))
