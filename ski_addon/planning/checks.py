"""What cannot be skied is refused by place and reason, and with a speed that would work there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..course import Track
from ..errors import PlanInfeasible, SpecError
from ..spec import RunSpec
from .line import Line
from .pendulum import Pendulum, speed_for_lean
from .pose import PlannedPoses
from .ride import Ride
from .stance import Stance

if TYPE_CHECKING:
    from ..body import SkierModel


RELIEF_KEYS = {"bumps": "bump_height", "moguls": "mogul_height"}
"""Key of the height of a bumpy `slope.kind`."""
NAMED_SHARE = {"bumps": 0.5, "moguls": 1.0}
"""Share of bumps that legs take up at a height that is named as one that works; moguls are too short for less."""


def _place(line: Line, index: int) -> str:
    kind = "the transition after turn" if line.phase[index] == 0 else "turn"
    return f"{kind} {line.turn[index]} ({line.arc_length[index]:.1f} m, {line.time[index]:.1f} s)"


def check_ground(spec: RunSpec, stance: Stance) -> None:
    """Raise `SpecError` for bumps or moguls that nobody can stand over [SG19 sec. 7.2, with its 3 m high bumps].

    Legs need not take up all of a bump, so only sides that are too steep are refused; the height that would work is one
    of which they can take up a good share.
    """
    from ..terrain import check_bumps

    reach = stance.extension + stance.retraction
    try:
        check_bumps(spec.slope, reach, absorption=0.0)
    except SpecError:
        check_bumps(spec.slope, reach, absorption=NAMED_SHARE[spec.slope.kind])
        raise


def check_arrival(track: Track, ride: Ride) -> None:
    """Raise `PlanInfeasible` if friction stops the skier on the way."""
    if ride.stopped_at is None:
        return
    index = int(np.searchsorted(track.arc_length, ride.stopped_at, side="right")) - 1
    place = f"turn {track.turn[index]} ({ride.stopped_at:.1f} m, {ride.time[-1]:.1f} s)"
    hint = "friction stops the skier there: make the slope steeper, lower snow.friction, start faster or turn less"
    raise PlanInfeasible(place, None, hint)


def check_lean(spec: RunSpec, line: Line, pendulum: Pendulum, height: float) -> None:
    """Raise `PlanInfeasible` where more lean is needed than the skier allows; `height` [m] is the upright stance's."""
    most = np.deg2rad(spec.technique.inclination_max_deg)
    lean = np.abs(pendulum.inclination)
    worst = int(np.argmax(lean))
    if lean[worst] <= most:
        return
    same_turn = line.turn == line.turn[worst]
    allowed = speed_for_lean(
        most * np.sign(pendulum.y[worst]), line.curvature, line.gravity_left, line.gravity_into, height
    )
    works = line.speed[worst] * float(np.min((allowed / np.maximum(line.speed, 1e-6))[same_turn]))
    needed = np.ceil(10 * np.rad2deg(lean[worst])) / 10
    reason = (
        f"at {line.speed[worst]:.1f} m/s it needs {needed:.1f} degrees of lean, more than "
        f"technique.inclination_max_deg = {spec.technique.inclination_max_deg:g} (use a larger radius, a gentler slope "
        "or a lower start speed)"
    )
    raise PlanInfeasible(_place(line, worst), works if np.isfinite(works) else None, reason)


def check_load(spec: RunSpec, line: Line, pendulum: Pendulum) -> None:
    """Raise `PlanInfeasible` where the snow would have to hold the skier down."""
    load = pendulum.normal / line.gravity_into
    worst = int(np.argmin(load))
    if load[worst] < spec.technique.load_min - 0.01:
        reason = (
            f"only {load[worst]:.2f} of the skier's weight would stay on the snow, less than technique.load_min = "
            f"{spec.technique.load_min:g} (use longer transitions, a larger radius or a lower speed)"
        )
        raise PlanInfeasible(_place(line, worst), None, reason)


def check_reach(line: Line, poses: PlannedPoses) -> None:
    """Raise `PlanInfeasible` where a leg is too short or too long."""
    missing = np.max(np.abs(poses.reach_error), axis=1)
    worst = int(np.argmax(missing))
    if missing[worst] > 1e-6:
        reason = (
            f"a leg would have to be {1000 * missing[worst]:.0f} mm longer or shorter than it can be "
            "(change technique.knee_bend_deg or skier.stance_width, or lean less)"
        )
        raise PlanInfeasible(_place(line, worst), None, reason)


def check_ranges(spec: RunSpec, line: Line, poses: PlannedPoses, model: SkierModel) -> None:
    """Raise `PlanInfeasible` where a hinge would leave its range."""
    angles = poses.qpos[:, model.actuated_qpos]
    beyond = np.maximum(model.joint_lower - angles, angles - model.joint_upper)
    worst, hinge = np.unravel_index(int(np.argmax(beyond)), beyond.shape)
    if beyond[worst, hinge] > 0.0:
        name = model.skeleton.joint_names[model.skeleton.actuated[hinge]]
        lower = f"lower slope.{RELIEF_KEYS[spec.slope.kind]}, " if spec.slope.kind in RELIEF_KEYS else ""
        reason = (
            f"{name} would bend {np.rad2deg(beyond[worst, hinge]):.1f} degrees past its range ({lower}bring "
            "technique.angulation nearer to 0, change technique.knee_bend_deg or lean less)"
        )
        raise PlanInfeasible(_place(line, int(worst)), None, reason)
