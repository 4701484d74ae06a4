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
from .line import Line
from .pendulum import Legs
from .pose import PlannedPoses
from .stance import Stance

SMOOTH_LENGTH = 6.0
"""Standard deviation [m] of the window that smooths the ground: waves shorter than about three times this are bumps."""
SINK_LENGTH, SINK_FACTOR = 1.2, 1.3
"""Standard deviation [m] of the way over which a skier sinks; and how much for each metre that a leg is too short."""
LEAST_KNEE = np.deg2rad(18.0)
"""Straightest knee of a plan: a straight leg could not be controlled."""
TOLERANCE = 1e-3
"""Length [m] by which a leg may be straighter than that."""
_PLACES_PER_METRE = 10


class Sink:
    """How much lower than the stance a skier has to be along a track, so that both legs reach their skis.

    In a deep lean the outside leg has the longer way: skiers bend the inside leg and come down.
    """

    def __init__(self, track: Track) -> None:
        """Start with none."""
        count = max(int(np.ceil(track.length * _PLACES_PER_METRE)), 2)
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
        return np.interp(arc_length, self.arc_length, self.depth)


def missing_length(skeleton: Skeleton, poses: PlannedPoses) -> np.ndarray:
    """Return how much (n,) [m] the longer leg exceeds its length at `LEAST_KNEE`; 0 where both legs are bent more."""
    thigh, shank = skeleton.lengths["thigh"], skeleton.lengths["shank"]
    knees = poses.qpos[:, [skeleton.qpos_of(f"shank_y.{side}") for side in SIDES]]
    straightest = thigh**2 + shank**2 + 2.0 * thigh * shank * np.cos(LEAST_KNEE)
    length = np.sqrt(thigh**2 + shank**2 + 2.0 * thigh * shank * np.cos(knees)) + np.maximum(poses.reach_error, 0.0)
    return np.maximum(length - np.sqrt(straightest), 0.0).max(axis=1)


def legs_for(spec: RunSpec, track: Track, line: Line, stance: Stance, sink: Sink) -> Legs:
    """Return what the legs do along `line`: how they absorb bumps, and how far they may stretch to keep a load."""
    wanted = -spec.technique.absorption * np.interp(line.arc_length, *bump_heights(track))
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


def bump_heights(track: Track) -> tuple[np.ndarray, np.ndarray]:
    """Return places (m,) along the track and how high the snow there is over its smooth course (m,) [m].

    Heights are along the surface normal, so that a plane has none, however the track winds on it.
    """
    from scipy.ndimage import gaussian_filter1d

    count = max(int(np.ceil(track.length * _PLACES_PER_METRE)), 2)
    arc = np.linspace(0.0, track.length, count + 1)
    margin = int(np.ceil(4.0 * SMOOTH_LENGTH * count / track.length))
    columns = []
    for axis in range(3):
        path = np.interp(arc, track.arc_length, track.position[:, axis])
        padded = (
            np.pad(path, margin, mode="reflect", reflect_type="odd") if margin < count else _lengthened(path, margin)
        )
        smooth = gaussian_filter1d(padded, SMOOTH_LENGTH * count / track.length)
        columns.append(
            (path - smooth[margin:-margin]) * np.interp(arc, track.arc_length, track.surface_normal[:, axis])
        )
    return arc, np.sum(columns, axis=0)


def _lengthened(path: np.ndarray, margin: int) -> np.ndarray:
    """Return a short path continued straight at both ends by `margin` places."""
    steps = np.arange(1, margin + 1)
    return np.concatenate((path[0] - (path[1] - path[0]) * steps[::-1], path, path[-1] + (path[-1] - path[-2]) * steps))
