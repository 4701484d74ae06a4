"""What scripts call, in plain Python and inside Blender: docs/api.md shows each by an example.

    import ski_addon
    recording = ski_addon.simulate(ski_addon.load_run("giant_slalom"))
    ski_addon.bake(recording, "skier.blend")

Everything raises a `SkiAddonError`, whose text is one line that says what to do.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .errors import MissingInputError, SpecError
from .spec import RunSpec, find_document

if TYPE_CHECKING:
    from .simulation import Recording

Progress = Callable[[float, str], "bool | None"]
"""Called with the fraction done and a line of text; returning False cancels."""


def load_run(name: str | Path, changes: Mapping[str, Any] | None = None) -> RunSpec:
    """Return the run document at a path, or the shipped preset of that name.

    `changes` replaces dotted keys: `{"course.turn_radius": 14, "skier.mass": 80}`. Raises `SpecError` for a wrong key
    or value, `MissingInputError` if there is no such document.
    """
    return RunSpec.from_toml(find_document(str(name))).with_overrides(changes or {})


def simulate(spec: RunSpec, progress: Progress | None = None) -> Recording:
    """Plan and simulate a run; return its recording.

    Raises `PlanInfeasible` for a track that cannot be skied, `SkierFell` (or `SimulationDiverged`) for a run that ends
    before its end, and `Cancelled` when `progress` says so. To look at a fall use `make_plan` and `run_simulation`.
    """
    from .pipeline import make_plan, run_simulation
    from .results import raise_unless_finished

    recording, _ = run_simulation(make_plan(spec), progress)
    raise_unless_finished(recording)
    return recording


def summarise(recording: Recording) -> dict[str, Any]:
    """Return the numbers of a run by the keys of `summary.json`, its motion measures under "motion"."""
    from .body import build_skeleton
    from .measures import measure_motion
    from .results import recorded_spec
    from .simulation import summarise as numbers
    from .terrain import build_terrain

    spec = recorded_spec(recording)
    measures = measure_motion(recording, build_skeleton(spec.skier), build_terrain(spec.slope))
    return {**numbers(recording), "motion": measures}


def bake(
    recording: Recording, blend: str | Path, armature: str | None = None, target: str | Path | None = None
) -> Path:
    """Bake `recording` into a .blend file and return its path.

    A `blend` that does not exist becomes a new film: skier, slope, light and a camera. In one that exists the motion is
    laid on the `armature` of that name, whose bone map is found by its bones' names, or on a new skier without a name;
    all else is left as it is, and it is saved to `target` (default: in place). The open file of Blender is closed.
    Raises `BlenderMissingError`, `MissingInputError`, `SpecError` for an armature that is not there or that no motion
    can be laid on, and `OutputError`.
    """
    from . import results

    results.check_blender("baking")
    made = Path(target or blend)
    if Path(blend).exists():
        results.bake_into(recording, Path(blend), armature, made)
    elif armature is not None:
        raise MissingInputError(blend)
    else:
        results.bake(recording, results.recorded_spec(recording), made)
    return made


def run_sweep(
    spec: RunSpec, values: Mapping[str, Sequence[Any]], folder: str | Path, jobs: int = 1
) -> list[dict[str, Any]]:
    """Simulate a run for every combination of the `values` of dotted keys; return a row for each.

    A row has the `values` of the keys as texts, `status` ("impossible" for a run that cannot be skied, with why in
    `detail`) and numbers of its summary. Every run has a folder of its own within `folder`; those that are finished are
    kept, so the same call goes on where it was stopped. `jobs` processes share the work: with more than one, call it
    below `if __name__ == "__main__"`. Raises `SpecError` for a wrong key or value, and `OutputError`.
    """
    from . import atomic
    from .sweep import combine, running
    from .talk import Talk

    _check_jobs(jobs)
    combinations = combine(spec, {key: [_text(value) for value in several] for key, several in values.items()})
    with atomic.output_folder(folder) as place:
        summary = running.run_sweep(combinations, place, jobs, Talk(quiet=True), report=False, redo=False)
    return list(summary["rows"])


def run_crowd(
    name: str | Path, folder: str | Path, changes: Mapping[str, Any] | None = None, jobs: int = 1
) -> dict[str, Any]:
    """Simulate a crowd document, a shipped crowd, or one run that many ski; return what is in `crowd.json`.

    `changes` replaces keys of the crowd ("crowd.count") and of its runs. Recordings are in `folder`, `member_001.npz`
    and so on; the same call goes on where it was stopped. `jobs` as in `run_sweep`. Raises as `load_run`,
    or `OutputError`.
    """
    from . import atomic
    from .crowd import find_crowd, read_crowd, running

    _check_jobs(jobs)
    crowd = read_crowd(find_crowd(str(name)), (), changes or {})
    with atomic.output_folder(folder) as place:
        return running.run_crowd(crowd, place, jobs if jobs > 1 else running.HERE, lambda fraction, text: None)


def _check_jobs(jobs: int) -> None:
    if jobs < 1:
        raise SpecError("jobs", jobs, "1 or more", "give how many processes share the work")


def _text(value: object) -> str:
    """Return a value as it is written after `--set`."""
    return str(value).lower() if isinstance(value, bool) else str(value)
