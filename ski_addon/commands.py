"""What each command of the command line does: read, call the library, write whole files, say how it went."""

from __future__ import annotations

import argparse
import dataclasses
import functools
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import apart, atomic, environment, results
from .errors import MissingInputError, SkiAddonError, SpecError
from .spec import PART_KINDS, RunSpec, estimate, find_document
from .talk import Talk, json_text, summary_lines

if TYPE_CHECKING:
    from .simulation import Recording

DEMO_PRESET = "giant_slalom"
TABLE_OPTIONS = ("forces", "bodies", "directions", "speeds", "moments", "duration")
"""Options of `robustness` that make its table."""
CROWD_OPTIONS = {
    "count": "crowd.count",
    "seed": "crowd.seed",
    "interval": "crowd.start_interval",
    "apart": "crowd.apart",
}
"""Options of `crowd` that are keys of its document."""


def run_command(arguments: argparse.Namespace) -> int:
    """`run`: plan, simulate, report. Returns the exit code."""
    return _simulate_into(_read_spec(arguments.spec, arguments), arguments, report=True)


def simulate_command(arguments: argparse.Namespace) -> int:
    """`simulate`: as `run`, without the picture."""
    return _simulate_into(_read_spec(arguments.spec, arguments), arguments, report=False)


def plan_command(arguments: argparse.Namespace) -> int:
    """`plan`: say whether and how the track can be skied."""
    spec, talk = _read_spec(arguments.spec, arguments), _talk(arguments)
    target = _target(arguments.output, "plan.json") if arguments.output else None
    if target is None:
        summary = results.plan_summary(spec)
    else:
        with atomic.output_folder(target.parent):
            summary = results.plan_summary(spec)
            atomic.write_text(target, json_text(summary))
    talk.say(f"{spec.name}: can be skied")
    for line in results.plan_lines(summary):
        talk.say(line)
    talk.give(summary)
    return 0


def bake_command(arguments: argparse.Namespace) -> int:
    """`bake`: recording (or a run, simulated first), or a crowd -> .blend."""
    from .tasks.baking import Source, bake_into

    talk = _talk(arguments)
    if results.is_crowd(Path(arguments.source)):
        if arguments.changes or arguments.parts:
            raise SpecError("--set", problem="cannot change a crowd that was skied", hint="simulate it again with it")
        return _show_crowd("bake", arguments, "crowd.blend")
    path = _recording_path(arguments.source)
    target = _target(arguments.output or (path.parent if path else Path(".")), "skier.blend")
    results.check_blender("baking")
    with atomic.output_folder(target.parent):
        if path:
            recording = results.load_recording(path)
            source = Source(_recorded_spec(recording, arguments), lambda: recording, path)
        else:
            spec = _read_spec(arguments.source, arguments)
            _check_size(spec, arguments, talk)
            source = Source(spec, lambda: _finished(spec, talk))
        bake_into(source, target, talk, redo=arguments.redo)
    talk.give({"blend": str(target), "spec_hash": source.spec.content_hash()})
    return 0


def report_command(arguments: argparse.Namespace) -> int:
    """`report`: recording -> picture of its plots."""
    from .tasks.simulating import report_of

    results.check_matplotlib()
    talk = _talk(arguments)
    path, target = _picture_paths(arguments, "report.png")
    with atomic.output_folder(target.parent):
        report_of(path, target, talk, redo=arguments.redo)
    talk.give({"picture": str(target)})
    return 0


def render_command(arguments: argparse.Namespace) -> int:
    """`render`: .blend -> its frames; recording or crowd -> one picture of it."""
    from .tasks.rendering import FRAME_OPTIONS

    results.check_blender("rendering")
    if Path(arguments.source).suffix == ".blend":
        return _render_frames(arguments)
    given = [name for name in FRAME_OPTIONS if getattr(arguments, name) not in (None, False)]
    if given:
        option = "--" + given[0].replace("_", "-")
        raise SpecError(option, problem="is for the frames of a .blend file", hint="bake the recording first")
    if results.is_crowd(Path(arguments.source)):
        return _show_crowd("render", arguments, "crowd.png")
    path, target = _picture_paths(arguments, "strobe.png")
    with atomic.output_folder(target.parent):
        results.run_blender_command("render", path, target, stop=arguments.stop)
    talk = _talk(arguments)
    talk.say(f"wrote {target}")
    talk.give({"picture": str(target)})
    return 0


def _render_frames(arguments: argparse.Namespace) -> int:
    """Render the frames of a .blend file into a folder."""
    from .tasks.rendering import read_settings, render_into

    talk, blend = _talk(arguments), Path(arguments.source)
    if arguments.stop:
        raise SpecError("--stop", problem="is for recordings", hint="choose frames with --frames")
    settings = read_settings(arguments)
    with atomic.output_folder(arguments.output or blend.parent / "frames") as folder:
        done = render_into(blend, folder, settings, talk, redo=arguments.redo)
    talk.give(done)
    return 0


def sweep_command(arguments: argparse.Namespace) -> int:
    """`sweep`: simulate a run for every combination of some values."""
    from .sweep import read_variations, run_sweep, sweep_lines
    from .workers import read_jobs

    talk, spec = _talk(arguments), _read_spec(arguments.spec, arguments)
    combinations = read_variations(spec, arguments.vary)
    for combination in combinations:
        _check_size(combination.spec, arguments)
    jobs = min(read_jobs(arguments.jobs), len(combinations))
    talk.say(f"{spec.name}: {len(combinations)} runs in {jobs} processes")
    with atomic.output_folder(arguments.output) as folder:
        summary = run_sweep(combinations, folder, jobs, talk, report=arguments.report, redo=arguments.redo)
    for line in sweep_lines(summary):
        talk.say(line)
    talk.say(f"results in {folder}")
    talk.give(summary)
    return 0


def preview_command(arguments: argparse.Namespace) -> int:
    """`preview`: run -> .blend or picture of the instant figure, without physics."""
    talk = _talk(arguments)
    target = Path(arguments.output)
    if target.suffix not in (".blend", ".png") or target.is_dir():
        target = target / "preview.blend"
    results.check_blender("the preview")
    spec = _read_spec(arguments.spec, arguments)
    with atomic.output_folder(target.parent):
        problem = results.preview(spec, target)
    talk.say(f"wrote {target}")
    made = {target.suffix[1:].replace("png", "picture"): str(target), "spec_hash": spec.content_hash()}
    if problem is None or apart.is_apart():  # the process that asked for a picture knows of the problem
        talk.give(made)
        return 0
    results.complain(f"{problem}; the motion up to there is in {target}")
    talk.give({**made, "error": str(problem)})
    return problem.exit_code


def validate_command(arguments: argparse.Namespace) -> int:
    """`validate`: check run documents; one line for each. Returns the exit code of the first bad one."""
    talk, found, exit_code = _talk(arguments), [], 0
    for name in arguments.specs:
        try:
            spec = _read_spec(name, arguments)
        except SkiAddonError as error:
            results.complain(str(error))
            exit_code = exit_code or error.exit_code
            found.append({"spec": name, "valid": False, "error": str(error)})
        else:
            talk.say(f"{name}: {spec.name}, {estimate(spec).described}")
            found.append({"spec": name, "valid": True, "spec_hash": spec.content_hash()})
    talk.give(found)
    return exit_code


def robustness_command(arguments: argparse.Namespace) -> int:
    """`robustness`: push the skier of a run in many ways, and say what became of him."""
    from .robustness.cases import read_table
    from .workers import read_jobs

    talk, spec = _talk(arguments), _read_spec(arguments.spec, arguments)
    table = read_table(**{name: getattr(arguments, name) for name in TABLE_OPTIONS})
    jobs = min(read_jobs(arguments.jobs), len(table.cases))
    talk.say(f"{spec.name}: {len(table.cases)} pushed runs in {jobs} processes")
    with atomic.output_folder(arguments.output) as folder:
        summary, lines = results.run_robustness(spec, table, jobs, folder, talk, grow=arguments.bisect)
    for line in lines:
        talk.say(line)
    talk.say(f"results in {folder}")
    talk.give(summary)
    return 0


def crowd_command(arguments: argparse.Namespace) -> int:
    """`crowd`: simulate many skiers who differ and stay apart."""
    from .crowd import find_crowd, read_crowd
    from .crowd.expected import describe
    from .crowd.folder import check_folder, check_space
    from .crowd.running import raise_shortfall
    from .workers import read_jobs

    talk, changes = _talk(arguments), _changes(arguments)
    given = ((key, getattr(arguments, name)) for name, key in CROWD_OPTIONS.items())
    changes |= {key: value for key, value in given if value is not None}
    parts = [find_document(part, PART_KINDS) for part in arguments.parts]
    source = find_crowd(arguments.spec)
    crowd = read_crowd(source, parts, changes)
    jobs = min(read_jobs(arguments.jobs), crowd.crowd.count)
    for run in crowd.runs:
        _check_size(run.spec, arguments)
    talk.say(f"{crowd.name}: {describe(crowd, jobs)}")
    with atomic.output_folder(arguments.output) as folder:
        if not arguments.force:
            check_folder(crowd, folder, source)
            check_space(crowd, folder)
        summary, lines = results.run_crowd(crowd, folder, jobs, talk)
    for line in lines:
        talk.say(line)
    talk.say(f"results in {folder}")
    talk.give(summary)
    raise_shortfall(summary)
    return 0


def submit_command(arguments: argparse.Namespace) -> int:
    """`submit`: run or crowd -> bundle for a render farm, and if asked run it here."""
    from .crowd import find_crowd
    from .farm import local_run
    from .farm.subjects import crowd_subject, run_subject
    from .farm.submitting import SubmitOptions, make_job, write_job

    talk = _talk(arguments)
    if arguments.crowd:
        parts = [find_document(part, PART_KINDS) for part in arguments.parts]
        subject = crowd_subject(find_crowd(arguments.spec), parts, _changes(arguments))
    else:
        subject = run_subject(_read_spec(arguments.spec, arguments))
    given = {info.name: getattr(arguments, info.name) for info in dataclasses.fields(SubmitOptions)}
    if arguments.run:
        local_run.check_can_run(arguments.engine)
    with talk.progress() as progress:
        check = functools.partial(_check_size, arguments=arguments)
        job = make_job(subject, SubmitOptions(**given), check, results.plan_seconds, progress)
    folder = Path(arguments.output)
    fresh = write_job(job, folder, arguments.engine)
    talk.say(f"{'wrote' if fresh else 'unchanged:'} {folder}, {job.described}")
    if arguments.run:
        local_run.run_bundle(folder, job, talk.log)
        talk.say(f"results in {folder / 'output'}")
    talk.give({"bundle": str(folder), "engine": arguments.engine, "runs": job.run_count, "tasks": job.task_count})
    return 0


def gallery_command(arguments: argparse.Namespace) -> int:
    """`gallery`: draw the figures of the 1993 paper."""
    from .gallery import find_pictures, save_picture

    talk, pictures, written = _talk(arguments), find_pictures(arguments.pictures), []
    results.check_matplotlib("the gallery")
    with atomic.output_folder(arguments.output) as folder:
        for name, picture in pictures.items():
            save_picture(picture, folder / f"{name}.png")
            talk.say(f"{name}.png: {picture.title}")
            written.append(str(folder / f"{name}.png"))
    talk.give({"pictures": written})
    return 0


def demo_command(arguments: argparse.Namespace) -> int:
    """`demo`: the giant-slalom preset, simulated, baked and pictured."""
    results.check_blender("the demo")
    spec, talk = RunSpec.from_toml(find_document(DEMO_PRESET)), _talk(arguments)
    from .tasks.simulating import simulate_into

    talk.say(f"{spec.name}: {estimate(spec).described}")
    with atomic.output_folder(arguments.output) as folder:
        simulated = simulate_into(spec, folder, talk, report=True, redo=arguments.redo)
        simulated.raise_unless_finished()
        talk.say("baking skier.blend")
        results.run_blender_command("bake", folder / "recording.npz", folder / "skier.blend")
        talk.say("rendering strobe.png, about a minute")
        results.run_blender_command("render", folder / "recording.npz", folder / "strobe.png")
    _tell(talk, spec, simulated.summary, folder)
    return 0


def _show_crowd(name: str, arguments: argparse.Namespace, file_name: str) -> int:
    """Bake or render the crowd in a folder."""
    results.check_blender("baking" if name == "bake" else "rendering")
    folder = Path(arguments.source)
    target = _target(arguments.output or folder, file_name)
    with atomic.output_folder(target.parent):
        results.show_crowd(name, folder, target)
    talk = _talk(arguments)
    talk.say(f"wrote {target}")
    talk.give({target.suffix[1:].replace("png", "picture"): str(target)})
    return 0


def _picture_paths(arguments: argparse.Namespace, name: str) -> tuple[Path, Path]:
    """Return the recording a command was given, and the picture to write."""
    path = _recording_path(arguments.source)
    if path is None:
        raise MissingInputError(arguments.source, "it is not a recording (recording.npz, or the folder it is in)")
    return path, _target(arguments.output or path.parent, name)


def _simulate_into(spec: RunSpec, arguments: argparse.Namespace, *, report: bool) -> int:
    from .tasks.simulating import simulate_into

    talk = _talk(arguments)
    _check_size(spec, arguments, talk)
    with atomic.output_folder(arguments.output) as folder:
        simulated = simulate_into(spec, folder, talk, report=report, redo=arguments.redo)
    _tell(talk, spec, simulated.summary, folder)
    simulated.raise_unless_finished()
    return 0


def _finished(spec: RunSpec, talk: Talk) -> Recording:
    """Simulate a run in memory, to its end."""
    with talk.progress() as progress:
        recording = results.simulate_run(spec, progress)[0]
    results.raise_unless_finished(recording)
    return recording


def _tell(talk: Talk, spec: RunSpec, summary: dict[str, Any], folder: Path) -> None:
    talk.say(f"{spec.name}: {summary.get('status')}, results in {folder}")
    for line in summary_lines(summary):
        talk.say(line)
    talk.give(summary)


def _talk(arguments: argparse.Namespace) -> Talk:
    log = arguments.log or os.environ.get(environment.LOG, "")
    if log:
        atomic.check_appendable(log)
    openjd = arguments.openjd or environment.is_on(environment.OPENJD)
    return Talk(json=arguments.json, quiet=arguments.quiet, openjd=openjd, log_file=log)


def _read_spec(name: str, arguments: argparse.Namespace) -> RunSpec:
    """Read a run document or preset, lay the parts over it, then the single keys."""
    spec = RunSpec.from_toml(find_document(name))
    for part in arguments.parts:
        spec = spec.with_part(find_document(part, PART_KINDS))
    return spec.with_overrides(_changes(arguments))


def _recorded_spec(recording: Recording, arguments: argparse.Namespace) -> RunSpec:
    """Return the spec in a recording with other bake settings; what was simulated cannot be changed any more.

    But its file of heights may lie elsewhere than where it was simulated.
    """
    for key in _changes(arguments):
        if not key.startswith("bake.") and key != "slope.grid_file":
            raise SpecError(key, problem="cannot be changed in a recording", hint="simulate again, or set bake. keys")
    if arguments.parts:
        raise SpecError("--part", problem="cannot be laid over a recording", hint="simulate again with it")
    return results.recorded_spec(recording).with_overrides(_changes(arguments))


def _changes(arguments: argparse.Namespace) -> dict[str, str]:
    changes = {}
    for written in arguments.changes:
        key, equals, value = written.partition("=")
        if not equals:
            raise SpecError(f"--set {written}", problem="has no value", hint="write --set key=value")
        changes[key.strip()] = value
    return changes


def _check_size(spec: RunSpec, arguments: argparse.Namespace, talk: Talk | None = None) -> None:
    expected = estimate(spec)
    if expected.too_large and not arguments.force:
        hint = "shorten the course, or add --force to start it all the same"
        raise SpecError("course", problem=f"would take {expected.described}, more than 8 GB or an hour", hint=hint)
    if talk is not None:
        talk.say(f"{spec.name}: {expected.described}")


def _recording_path(source: str) -> Path | None:
    """Return the recording a command was given (a folder stands for the one in it), or None if it is a run."""
    path = Path(source)
    if path.is_dir():
        return path / "recording.npz"
    return path if path.suffix == ".npz" else None


def _target(output: str | Path, name: str) -> Path:
    """Return the file to write: `output` itself if it has the suffix of `name`, else `name` in the folder `output`."""
    path = Path(output)
    return path if path.suffix == Path(name).suffix and not path.is_dir() else path / name
