"""The one place where commands call planning, simulation, report and Blender, all imported when they are used."""

from __future__ import annotations

import contextlib
import importlib.util
import logging
import sys
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import apart, atomic, interrupts
from .errors import (
    BlenderMissingError,
    Cancelled,
    MissingLibraryError,
    OutputError,
    SimulationDiverged,
    SkiAddonError,
    SkierFell,
    one_line,
)
from .spec import RunSpec
from .talk import Talk, json_text

if TYPE_CHECKING:
    from .crowd import CrowdSpec
    from .robustness import PushTable
    from .simulation import Recording
    from .simulation.checkpoint import Checkpoints
    from .tasks.rendering import Film, RenderSettings
    from .turning.motion import TurningMotion

Progress = Callable[[float, str], Any]


def check_blender(needed_for: str) -> None:
    """Raise `BlenderMissingError` unless `bpy` can be found (it is not imported)."""
    if "bpy" not in sys.modules and importlib.util.find_spec("bpy") is None:
        raise BlenderMissingError(needed_for)


def check_matplotlib(needed_for: str = "the report") -> None:
    """Raise `MissingLibraryError` unless matplotlib can be found."""
    if not _has_matplotlib():
        raise MissingLibraryError("matplotlib", needed_for)


def plan_summary(spec: RunSpec) -> dict[str, Any]:
    """Plan a run and return the planned numbers (SI units, degrees in keys ending in `_deg`)."""
    import numpy as np

    from .pipeline import make_plan

    plan = make_plan(spec).plan
    degrees = np.degrees
    return {
        "name": spec.name,
        "spec_hash": spec.content_hash(),
        "length_m": float(plan.arc_length[-1] - plan.arc_length[0]),
        "duration_s": float(plan.time[-1] - plan.time[0]),
        "speed_min": float(plan.speed.min()),
        "speed_max": float(plan.speed.max()),
        "speed_end": float(plan.speed[-1]),
        "inclination_max_deg": float(degrees(abs(plan.inclination).max())),
        "edge_angle_max_deg": float(degrees(abs(plan.edge_angle).max())),
        "load_min_bw": float(plan.load.min()),
        "load_max_bw": float(plan.load.max()),
    }


def plan_seconds(spec: RunSpec) -> float:
    """Plan a run and return how long it lasts [s]."""
    from .pipeline import make_plan

    time = make_plan(spec).plan.time
    return float(time[-1] - time[0])


def plan_lines(summary: Mapping[str, Any]) -> list[str]:
    """Return the lines of a plan's summary for a screen."""
    forms = (
        "  {length_m:.0f} m in {duration_s:.1f} s",
        "  speed {speed_min:.1f} to {speed_max:.1f} m/s, {speed_end:.1f} m/s at the end",
        "  leans up to {inclination_max_deg:.0f} degrees, edges up to {edge_angle_max_deg:.0f} degrees",
        "  {load_min_bw:.2f} to {load_max_bw:.2f} body weights on the snow",
    )
    return [form.format(**summary) for form in forms]


def simulate_run(
    spec: RunSpec, progress: Progress, checkpoints: Checkpoints | None = None
) -> tuple[Recording, dict[str, Any]]:
    """Plan and simulate a run; returns its recording and summary, also if the skier fell.

    With `checkpoints` an interrupt ends it after the present step, and the recording is "cancelled".
    """
    from .measures import measure_motion
    from .pipeline import make_plan, run_simulation
    from .simulation import summarise

    progress(0.0, "planning")
    planned = make_plan(spec)
    if checkpoints is None:
        recording, step_seconds = run_simulation(planned, progress)
    else:
        with interrupts.held() as interrupted:
            recording, step_seconds = run_simulation(
                planned, lambda *now: progress(*now) is not False and not interrupted(), checkpoints
            )
    summary = summarise(recording, step_seconds)
    return recording, {**summary, "motion": measure_motion(recording, planned.model.skeleton, planned.terrain)}


def run_robustness(
    spec: RunSpec, table: PushTable, jobs: int, folder: Path, talk: Talk, *, grow: bool
) -> tuple[dict[str, Any], list[str]]:
    """Run a table of pushes and write its files into `folder`; returns its summary and its lines for a screen."""
    from . import robustness
    from .robustness.summary import table_lines

    with talk.progress() as progress:
        outcomes = robustness.run_table(spec, table, jobs, progress, grow=grow)
    picture = _has_matplotlib()
    if not picture:
        talk.say("no robustness.png: matplotlib is not installed (pip install matplotlib)")
    _quieten_matplotlib()
    with _failures_in(folder):
        summary = robustness.write_results(folder, spec, table, outcomes, picture=picture)
    return summary, table_lines(table, outcomes)


def run_crowd(crowd: CrowdSpec, folder: Path, jobs: int, talk: Talk) -> tuple[dict[str, Any], list[str]]:
    """Simulate a crowd into `folder`; returns its summary and its lines for a screen."""
    from .crowd.running import run_crowd as run
    from .crowd.summary import summary_lines

    with talk.progress() as progress:
        summary = run(crowd, folder, jobs, progress)
    return summary, summary_lines(summary)


def load_recording(path: Path) -> Recording:
    """Read a recording; raises `RecordingError` or `MissingInputError`."""
    from .simulation import Recording

    return Recording.load(path)


def recorded_spec(recording: Recording) -> RunSpec:
    """Return the run document that a recording was made from."""
    return RunSpec.from_text(recording.header["spec"], "the run document in the recording")


def raise_unless_finished(recording: Recording) -> None:
    """Raise what happened to the skier, if the run was not skied to its end."""
    status, detail = recording.header["status"], recording.header.get("status_detail") or {}
    if status == "finished":
        return
    if status == "cancelled":
        raise Cancelled("interrupted: the recording up to there was kept")
    kind = SimulationDiverged if status == "diverged" else SkierFell
    where, when = detail.get("where"), detail.get("time")
    where = float(recording.arc_length[-1]) if where is None else where
    raise kind(
        detail.get("what", "the run ended early"),
        where,
        float(recording.time[-1]) if when is None else when,
        detail.get("why", "no reason was recorded"),
    )


def write_run(
    folder: Path, spec: RunSpec, recording: Recording, summary: Mapping[str, Any], *, report: bool, talk: Talk
) -> list[str]:
    """Write spec.toml, recording.npz, summary.json and (if asked and matplotlib is there) report.png, all or none.

    A report.png of an earlier run goes if there is no new one: it would show another recording. Returns their names.
    """
    with atomic.staging_folder(folder) as stage:
        with _failures_in(folder):
            (stage / "spec.toml").write_text(spec.to_toml(), encoding="utf-8")
            (stage / "summary.json").write_text(json_text(summary), encoding="utf-8")
            recording.save(stage / "recording.npz")
            if report:
                _report_if_possible(recording, stage / "report.png", talk)
        if not (stage / "report.png").exists():
            (folder / "report.png").unlink(missing_ok=True)
        names = sorted(path.name for path in stage.iterdir())
        atomic.move_all(stage, folder)
    return names


@contextlib.contextmanager
def _failures_in(folder: Path) -> Iterator[None]:
    """Name the folder that cannot be written, not the hidden one within it that the files are collected in."""
    try:
        yield
    except OutputError as error:
        raise OutputError(folder, error.reason) from error
    except OSError as error:
        raise OutputError(folder, error.strerror or str(error)) from error


def _report_if_possible(recording: Recording, target: Path, talk: Talk) -> None:
    if can_draw(talk):
        draw_report(recording, target)


def can_draw(talk: Talk) -> bool:
    """Return whether a report can be drawn; if not, say so."""
    if not _has_matplotlib():
        talk.say("no report.png: matplotlib is not installed (pip install matplotlib)")
    return _has_matplotlib()


def draw_report(recording: Recording, target: Path) -> None:
    """Draw the plots of a recording into a picture."""
    _quieten_matplotlib()
    from .report import save_report

    save_report(recording, target)


def bake(recording: Recording, spec: RunSpec, target: Path) -> None:
    """Bake a recording into a .blend file."""
    with apart.silenced():
        from .blender.headless import bake_file

        bake_file(recording, spec, target)


def bake_into(recording: Recording, blend: Path, armature: str | None, target: Path) -> None:
    """Bake a recording into the file `blend` and save it as `target`; see `blender.headless.bake_into`."""
    with apart.silenced():
        from .blender import headless

        headless.bake_into(recording, blend, armature, target)


def render_strobe(recording: Recording, spec: RunSpec, target: Path, *, stop: bool = False) -> None:
    """Render one picture of the slope with the skier at several instants (`stop`: the last); raises `RenderError`."""
    with apart.silenced():
        from .blender.strobe import render_strobe as render

        render(recording, spec, target, stop=stop)


def open_frames(blend: Path, settings: RenderSettings) -> Film:
    """Open a .blend file to render frames of it; raises `MissingInputError` or `RenderError`."""
    with apart.silenced():
        from .blender.frames import FrameRenderer

        return FrameRenderer(blend, settings)


def preview(spec: RunSpec, target: Path) -> SkiAddonError | None:
    """Write the instant figure of a run: a .blend, or (by the target's suffix) one picture; in a process of its own.

    What is wrong with the run is found out here, before Blender is started. Returns what ends the motion before the
    course does, or None.
    """
    from .turning.preview import preview_course

    preview = preview_course(spec)
    _write_preview(spec, preview.motion, target)
    return preview.problem


def _write_preview(spec: RunSpec, motion: TurningMotion, target: Path) -> None:
    if target.suffix == ".blend" or apart.inside_blender() or apart.is_apart():
        draw_preview(spec, motion, target)
        return
    with atomic.staging_folder(target.parent) as stage:
        document = stage / "spec.toml"
        document.write_text(spec.to_toml(), encoding="utf-8")
        output = stage / "picture" / target.name
        output.parent.mkdir()
        apart.run_apart(["preview", str(document.resolve()), "--output", str(output.resolve())])
        atomic.move_all(output.parent, target.parent)


def draw_preview(spec: RunSpec, motion: TurningMotion, target: Path) -> None:
    """Write the figure of `spec` in `motion` into a .blend or a picture."""
    with apart.silenced():
        from .blender.figures import preview_file, preview_picture

        (preview_file if target.suffix == ".blend" else preview_picture)(spec, motion, target)


def is_crowd(folder: Path) -> bool:
    """Return whether `folder` is that of a crowd."""
    from .crowd.skied import is_crowd_folder

    return is_crowd_folder(folder)


def show_crowd(name: str, folder: Path, target: Path) -> None:
    """Run `bake` or `render` of the crowd in `folder` in a process of its own, and write `target` whole."""
    if apart.inside_blender() or apart.is_apart():
        with apart.silenced():
            from .blender.crowd_files import bake_crowd_file, render_crowd

            (bake_crowd_file if name == "bake" else render_crowd)(folder, target)
        return
    with atomic.staging_folder(target.parent) as stage:
        apart.run_apart([name, str(folder.resolve()), "--output", str((stage / target.name).resolve())])
        atomic.move_all(stage, target.parent)


def run_blender_command(name: str, recording_path: Path, target: Path, **options: bool) -> None:
    """Run `bake` or `render` of a recording in a process of its own, and write `target` whole.

    Inside Blender, and in that process itself, it is done here. `options` are switches of the command (`stop`).
    """
    if apart.inside_blender() or apart.is_apart():
        recording = load_recording(recording_path)
        run: Callable[..., None] = {"bake": bake, "render": render_strobe}[name]
        run(recording, recorded_spec(recording), target, **{option: on for option, on in options.items() if on})
        return
    with atomic.staging_folder(target.parent) as stage:
        output = str((stage / target.name).resolve())
        switches = [f"--{option}" for option, on in options.items() if on]
        apart.run_apart([name, str(recording_path.resolve()), "--output", output, *switches])
        atomic.move_all(stage, target.parent)


def complain(message: str) -> None:
    """Say one failure on stderr and go on."""
    sys.stderr.write(f"ski_addon: {one_line(message)}\n")


def _quieten_matplotlib() -> None:
    logging.getLogger("matplotlib").setLevel(logging.ERROR)  # its notes on font caches are not for our users


def _has_matplotlib() -> bool:
    return importlib.util.find_spec("matplotlib") is not None
