"""Speed and lean, found together: lean depends on speed, and a leaning skier's skis run faster than the body."""

from __future__ import annotations

import numpy as np

from ..course import Track, speed_to_hold
from ..gravity import GRAVITY
from ..snow import Snow
from ..spec import RunSpec
from .absorption import Sink, legs_for
from .checks import check_arrival
from .comparison import RIGID_LEAN
from .line import Line, TrackSpline
from .mixing import Mixing
from .pendulum import Legs, Pendulum, balanced_pendulum, mirrored, rigid_pendulum, upright
from .ride import Body, Rider, SpeedControl
from .stance import Stance

SETTLED = 1e-6
"""Change of the speed [m/s] from ride to ride at which speed and lean belong together."""
NEAR = 0.2
"""Change of the speed [m/s] below which rides are mixed: before, skids come and go, and earlier rides say little."""
MOST_RIDES = 25


class SpeedAndLean:
    """Rides of a track by a skier who leans: each ride gives a lean, and each lean a ride."""

    def __init__(self, spec: RunSpec, track: Track, stance: Stance) -> None:
        """Begin with a skier who does not lean."""
        self._spec, self._track, self._stance = spec, track, stance
        self._snow, self._spline = Snow.of(spec.snow, spec.skier, spec.technique.tuck), TrackSpline(track)
        self._rider = Rider(track, self._snow, speed_control(spec, track))
        normal = self._on_track(track.arc_length, -(track.surface_normal @ GRAVITY))
        self._forces = np.stack((normal, np.zeros_like(normal)))

    def found(self, sink: Sink) -> tuple[Line, Pendulum]:
        """Return the ride and the lean of a skier who stands as deep as `sink` says, from those found last.

        Raises `PlanInfeasible` where friction stops the skier.
        """
        mixing, before = Mixing(), None
        for _ in range(MOST_RIDES):
            line, pendulum = self._ridden(sink)
            if not self._spec.technique.inclination:
                break
            change = np.inf if before is None else _difference(before, line)
            if change < SETTLED:
                break
            answer = [self._on_track(line.arc_length, force) for force in (pendulum.normal, pendulum.swing)]
            step = np.stack(answer) - self._forces
            if change < NEAR:
                step = mixing.step(step.reshape(-1, 1)).reshape(step.shape)
            before, self._forces = line, self._forces + step
        return line, pendulum

    def _ridden(self, sink: Sink) -> tuple[Line, Pendulum]:
        """Return the ride with the forces so far, and the lean that it needs."""
        ride = self._rider.ride(Body(self._forces[0], self._forces[1], self._rider.places))
        check_arrival(self._track, ride)
        line = self._spline.line(ride, self._snow)
        if not self._spec.technique.inclination:
            return line, upright(line, self._stance.height)
        return line, _pendulum(self._spec, line, legs_for(self._spec, line, self._stance, sink))

    def _on_track(self, arc_length: np.ndarray, values: np.ndarray) -> np.ndarray:
        return np.interp(self._rider.places, arc_length, values)


def speed_control(spec: RunSpec, track: Track) -> SpeedControl:
    """Return what the run document says about the skier's speed."""
    technique, side = spec.technique, float(track.curvature[np.argmax(track.arc_length >= track.stop_from) - 1])
    return SpeedControl(
        most=speed_to_hold(spec),
        skid=np.deg2rad(technique.skid_max_deg),
        deceleration=technique.stop_deceleration,
        stop_side=1 if side >= 0 else -1,
    )


def _pendulum(spec: RunSpec, line: Line, legs: Legs) -> Pendulum:
    if spec.technique.equations in RIGID_LEAN:
        return rigid_pendulum(line, legs)
    pendulum = balanced_pendulum(line, legs)
    return mirrored(pendulum) if spec.technique.equations == "printed_sign" else pendulum


def _difference(before: Line, after: Line) -> float:
    """Return how much the speed [m/s] of two rides of one track differs at most."""
    return float(np.max(np.abs(np.interp(after.arc_length, before.arc_length, before.speed) - after.speed)))
