"""Checkpoints of a run in progress: a killed simulation goes on where it was, and ends with the same bytes.

A checkpoint holds what was logged and everything that the next step depends on (`Simulation.STATE`), and what it was
made from. One that was made from anything else, or is damaged, is left aside and the run begins anew.
"""

from __future__ import annotations

import hashlib
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import archive, atomic, environment
from ..errors import OutputError
from ..state import State, StateError, put_state, take_state

if TYPE_CHECKING:
    from .simulation import Simulation

FORMAT, FORMAT_VERSION = "ski-addon-checkpoint", 1
SECONDS = 10.0
"""Wall time between two checkpoints [s]."""
MOST_SHARE = 0.05
"""Most of the time that writing checkpoints may take."""
TABLES = ("log.reals", "log.counts", "step_seconds")
"""Arrays of a checkpoint that grow with the run."""


class Checkpoints:
    """The checkpoint of one run in the file `path`: written every so often, read once, removed at the end.

    Nothing of it changes the simulation: when it is written depends on the wall clock, what happens next does not.
    """

    def __init__(
        self, path: str | Path, seconds: float | None = None, tell: Callable[[str], None] = lambda _line: None
    ) -> None:
        """Write to `path` every `seconds` [s of wall time] (10, or what the environment says).

        `tell(line)` is called with what a user wants to know: where the run goes on, or why it cannot.
        """
        self.path = Path(path)
        self._tell = tell
        self._seconds = _seconds() if seconds is None else seconds
        self._due = time.monotonic() + self._seconds

    def offer(self, simulation: Simulation) -> None:
        """Save `simulation` if the time has come."""
        if time.monotonic() >= self._due:
            self.save(simulation)

    def save(self, simulation: Simulation) -> bool:
        """Write the checkpoint, whole or not at all, and return which; a run goes on without one."""
        begin = time.monotonic()
        try:
            with atomic.atomic_path(self.path) as temporary:
                _write(temporary, simulation)
        except OutputError as error:
            self._tell(f"no checkpoint: {error}")
            return False
        finally:
            now = time.monotonic()
            self._due = now + max(self._seconds, (now - begin) / MOST_SHARE)
        return True

    def load(self, simulation: Simulation) -> bool:
        """Put `simulation`, which has not begun, where it was saved, and return whether that was done.

        Where there is no checkpoint, or it cannot be used, the simulation is left at its start.
        """
        if not self.path.is_file():
            return False
        try:
            _restore(simulation, *archive.read(self.path, FORMAT, FORMAT_VERSION))
        except (KeyError, TypeError, ValueError) as problem:  # of damage, and of a state that fits nothing
            why = str(problem) if isinstance(problem, archive.ArchiveError | StateError) else "it holds no such run"
            self._tell(f"begun anew, for {self.path} cannot be used: {why}")
            return False
        self._tell(f"going on from {simulation.step_done * simulation.time_step:.2f} s, where {self.path} was saved")
        return True

    def remove(self) -> None:
        """Remove the checkpoint: the run is over."""
        self.path.unlink(missing_ok=True)


def made_from(simulation: Simulation) -> dict[str, Any]:
    """Return what decides every byte of a recording: the request, the plan, the model and the versions."""
    from .versions import library_versions

    return {
        "spec_hash": simulation.spec.content_hash(),
        "model_hash": simulation.model.model_hash,
        "plan_hash": hashlib.sha256(simulation.reference.table().tobytes()).hexdigest(),
        "versions": library_versions(),
    }


def _write(path: Path, simulation: Simulation) -> None:
    state = take_state(simulation)
    numbers = {name: value for name, value in state.items() if not isinstance(value, np.ndarray)}
    arrays = {f"state.{name}": value for name, value in state.items() if isinstance(value, np.ndarray)}
    reals, counts = simulation.log.recorder.table()
    tables = dict(zip(TABLES, (reals, counts, np.array(simulation.step_seconds)), strict=True))
    header = {"made_from": made_from(simulation), "numbers": numbers}
    archive.write(path, {"format": FORMAT, "format_version": FORMAT_VERSION, **header}, {**arrays, **tables})


def _restore(simulation: Simulation, header: dict[str, Any], arrays: dict[str, np.ndarray]) -> None:
    present, saved = made_from(simulation), header["made_from"]
    odd = [name for name in present if saved.get(name) != present[name]]
    if odd:
        raise StateError(f"it was made from another {odd[0].replace('_hash', '')}")
    state: State = dict(header["numbers"])
    state |= {name.removeprefix("state."): value for name, value in arrays.items() if name.startswith("state.")}
    reals, counts, seconds = (arrays[name] for name in TABLES)
    if not len(reals) == len(counts) == len(seconds) == state["step_done"]:
        raise StateError("its steps are incomplete")
    before = take_state(simulation)
    put_state(simulation, state)
    try:
        simulation.log.recorder.set_table(reals, counts)
    except ValueError:
        put_state(simulation, before)
        raise
    simulation.step_seconds = seconds.tolist()


def _seconds() -> float:
    try:
        return max(float(os.environ.get(environment.CHECKPOINT_SECONDS, SECONDS)), 0.0)
    except ValueError:
        return SECONDS
