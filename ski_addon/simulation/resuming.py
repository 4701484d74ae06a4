"""Going on with a run from a moment of its recording, on the same plan or on one that leads on differently from there.

Every step's state is recorded, so the skier is put back into it. What the controller remembers besides (its last
solution, the line it steered along) begins anew: the motion goes on smoothly, but not byte for byte as it would have.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..errors import SpecError
from .recording import Recording

if TYPE_CHECKING:
    from .simulation import Simulation

NEAREST = 0.3
"""The new track must pass the place where a run goes on by this far at most [m], and lead on within so many radians."""
LEAST_TIME = 0.05
"""A run goes on from this long after its start at least [s]: before, it can as well be started."""


def resume(simulation: Simulation, recording: Recording, time: float) -> None:
    """Let `simulation`, which has not begun, go on from `recording` at `time` [s]; what was before is kept.

    Raises `SpecError` if the skier or the time step is another one, there is no such moment, or the simulation's track
    does not pass the skier's place.
    """
    _check_same(simulation, recording)
    end = float(recording.time[-1]) if len(recording.time) else 0.0
    if not LEAST_TIME <= time <= end + simulation.time_step:
        hint = "choose a moment of the recording, or simulate from the start"
        raise SpecError("resume time", time, f"{LEAST_TIME:g}..{end:.2f} s", hint)
    index = min(int(np.searchsorted(recording.time, time)), len(recording.time) - 1)
    simulation.restore(recording, index, _progress(simulation, recording, index))


def _check_same(simulation: Simulation, recording: Recording) -> None:
    header = recording.header
    if header["model_hash"] != simulation.model.model_hash:
        hint = "take back the change of person or gear, or simulate from the start"
        raise SpecError("skier", problem="is another one than in the recording", hint=hint)
    if float(header["time_step"]) != simulation.time_step:
        hint = f"set it to {header['time_step']:g} s again, or simulate from the start"
        raise SpecError("simulation.time_step", simulation.time_step, hint=hint, problem="is not that of the recording")


def _progress(simulation: Simulation, recording: Recording, index: int) -> float:
    """Return how far into the simulation's plan [s] the skier is at a step of the recording."""
    if recording.header["spec_hash"] == simulation.spec.content_hash():
        return float(recording.progress[index])
    plan, columns = simulation.plan, simulation.reference.columns
    moments = np.linspace(0.0, plan.duration, max(int(plan.duration / 0.005), 2))
    values = np.array([simulation.reference.at(moment)[0] for moment in moments])
    place, along = values[:, columns["track_position"]], values[:, columns["tangent"]]
    gap = np.linalg.norm(place - recording.track_position[index], axis=1)
    nearest = int(np.argmin(gap))
    turned = float(np.arccos(np.clip(along[nearest] @ recording.track_tangent[index], -1.0, 1.0)))
    if gap[nearest] > NEAREST or turned > NEAREST:
        first = _parting(place, recording, index)
        problem = f"leads {gap[nearest]:.1f} m beside the skier at {recording.time[index]:.1f} s"
        hint = f"the two part at {first:.1f} s: go on from there or before, or simulate from the start"
        raise SpecError("the changed course", problem=problem, hint=hint)
    return float(moments[nearest])


def _parting(place: np.ndarray, recording: Recording, index: int) -> float:
    """Return the time [s] until which the recorded way and `place` (n, 3) are one."""
    steps = np.arange(0, index, 50)
    gap = [np.linalg.norm(place - recording.track_position[step], axis=1).min() for step in steps]
    apart = np.flatnonzero(np.array(gap) > 0.1 * NEAREST)
    return float(recording.time[steps[max(int(apart[0]) - 1, 0)]]) if len(apart) else float(recording.time[index])
